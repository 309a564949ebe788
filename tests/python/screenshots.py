"""The top of each study's page as a WebP of at most 150 kB.

    screenshots.py RESULTS PICTURES STUDY...

What differs from run to run is far below. A picture that shows the same is not written again.
"""

import base64
import sys
from pathlib import Path

from page import CHROMIUM, SWITCHES
from playwright.sync_api import sync_playwright

WIDTH, HEIGHT, LARGEST = 1000, 1300, 150_000

# By the browser: the only encoder that is there.
ENCODE = """async ({ png, quality }) => {
  const image = new Image();
  image.src = "data:image/png;base64," + png;
  await image.decode();
  const canvas = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height });
  canvas.getContext("2d").drawImage(image, 0, 0);
  return canvas.toDataURL("image/webp", quality).split(",")[1];
}"""


def main(results, pictures, studies):
    Path(pictures).mkdir(exist_ok=True)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=[*SWITCHES, "--hide-scrollbars"])
        for study in (Path(study).stem for study in studies):
            # Twice as fine as it is shown would be three times as large.
            page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT}, color_scheme="light")
            page.goto((Path(results) / study / "report.html").resolve().as_uri())
            png = base64.b64encode(page.screenshot()).decode()
            for quality in (0.8, 0.65, 0.5, 0.35):
                bytes = base64.b64decode(page.evaluate(ENCODE, {"png": png, "quality": quality}))
                if len(bytes) <= LARGEST:
                    break
            file = Path(pictures) / f"{study}.webp"
            is_new = not file.exists() or file.read_bytes() != bytes
            if is_new:
                file.write_bytes(bytes)
            print(f"{file}: {len(bytes) / 1000:.0f} kB, {'written' if is_new else 'as it was'}")
            page.close()
        browser.close()


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], sys.argv[3:])
