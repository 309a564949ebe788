// Follows the study: loads the page again when there is another one, and shows what is wrong with it over this one.
(() => {
  const box = document.createElement("pre");
  box.setAttribute("role", "alert");
  box.style.cssText =
    "position:fixed;inset:0 0 auto 0;z-index:99;margin:0;padding:1em;max-height:50vh;overflow:auto;white-space:pre-wrap;" +
    "font:14px/1.4 monospace;background:#7f1d1d;color:#fff";
  box.hidden = true;
  document.body.append(box);
  const tell = (message) => {
    box.textContent = message;
    box.hidden = message === "";
  };
  tell(shown.message);
  const ask = async () => {
    const asked = Date.now();
    try {
      const answer = await fetch("/changes?since=" + shown.version);
      const now = await answer.json();
      if (now.version !== shown.version) {
        shown.version = now.version;
        if (now.message === "") return location.reload();
        tell(now.message);
      } else if (Date.now() - asked < 1000) {
        // Too many pages wait for news.
        await new Promise((again) => setTimeout(again, 1000));
      }
    } catch {
      tell("gearstudy watch has ended; this page does not follow any longer");
      await new Promise((again) => setTimeout(again, 1000));
    }
    ask();
  };
  ask();
})();
