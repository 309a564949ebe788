"""Pages as a reader meets them: in Chromium, from the disk, without a network.

    page.py PAGE... [--quick PAGE] [--many PAGE]

Of every page: no error on the console, nothing asked of a network, axe-core finds nothing with all details open, the key
column is legible at every width, nothing but scrolling regions is wider than the window, proofs are printed. Of the page
after `--quick` also what a keyboard and a mouse can do, of the one after `--many` what is read of 41 series. Prints one line; ends with 1 and all that is wrong.
"""

import csv
import io
import json
import math
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import sync_playwright

CHROMIUM = "/usr/bin/chromium"
SWITCHES = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
]
WIDTHS = [390, 768, 1024, 1280, 1920]

# A key that wraps to letters is far higher than one line; one that is cut off has more to scroll than it shows.
KEYS = """() => [...document.querySelectorAll('.wide tbody th[scope=row]')].filter(key => key.offsetParent).flatMap(key => {
  const text = key.querySelector('.k');
  if (!text) return [`${key.textContent}: no key`];
  const line = parseFloat(getComputedStyle(text).fontSize) * 1.6;
  const words = Math.max(1, ...text.textContent.split(/\\s+/).map(word => word.length));
  const lines = Math.round(text.getBoundingClientRect().height / line), wide = text.getBoundingClientRect().width;
  const letters = text.textContent.length;
  const faults = [];
  if (lines > 1 && letters / lines < Math.min(words, 8)) faults.push(`${text.textContent}: ${lines} lines, ${wide} px`);
  if (text.scrollWidth > text.clientWidth + 1 && text.clientWidth) faults.push(`${text.textContent}: cut off`);
  return faults;
})"""

# The first column stays in sight when the region is scrolled to its end.
STICKY = """() => [...document.querySelectorAll('.wide')].filter(region => region.offsetParent).flatMap(region => {
  const cell = region.querySelector('tbody tr > :first-child');
  if (!cell || region.scrollWidth <= region.clientWidth) return [];
  region.scrollLeft = region.scrollWidth;
  const off = cell.getBoundingClientRect().left - region.getBoundingClientRect().left;
  region.scrollLeft = 0;
  const padding = parseFloat(getComputedStyle(region).paddingLeft);
  return off >= -1 && off <= padding + 1 ? [] : [`${region.getAttribute('aria-label')}: first column at ${off} px`];
})"""

REGIONS = """() => [...document.querySelectorAll('.wide')].filter(region =>
  region.tabIndex !== 0 || region.getAttribute('role') !== 'region' || !region.getAttribute('aria-label')).length"""

# Nothing of a figure is cut without a way to see it, and what stands at its axes can be read.
FIGURES = """() => [...document.querySelectorAll('figure svg[data-plot]')].flatMap(svg => {
  const region = svg.parentElement, faults = [], name = svg.getAttribute('aria-label');
  const reached = region.tabIndex === 0 && region.getAttribute('role') && region.getAttribute('aria-label');
  const cut = svg.getBoundingClientRect().width > region.clientWidth + 1;
  if (cut && !(reached && getComputedStyle(region).overflowX === 'auto')) faults.push(`${name}: cut, and no key shows the rest`);
  const scale = svg.getBoundingClientRect().width / svg.viewBox.baseVal.width;
  const letters = svg.querySelector('.tick:not(.name)'), size = letters ? scale * parseFloat(getComputedStyle(letters).fontSize) : 8;
  if (size < 8) faults.push(`${name}: letters of ${size} px`);
  return faults;
})"""

# All gears of a data sheet are in sight, and what is not in sight elsewhere is hinted at.
SHEETS = """() => [...document.querySelectorAll('.wide')].filter(region => region.offsetParent && region.scrollWidth > region.clientWidth + 1)
  .map(region => [region.getAttribute('aria-label'), region.closest('.sheet') ? 'cut' : getComputedStyle(region).backgroundImage])
  .filter(([_, how]) => !how.includes('gradient')).map(([name, how]) => `${name}: ${how}`)"""

OPEN = """async () => {
  for (const details of document.querySelectorAll('details')) details.open = true;
  await new Promise(done => setTimeout(done, 300));
  for (const details of document.querySelectorAll('details')) details.open = true;
  await new Promise(done => setTimeout(done, 100));
}"""


class Faults:
    def __init__(self):
        self.found = []
        self.checks = 0

    def check(self, holds, what):
        self.checks += 1
        if not holds:
            self.found.append(what)


def opened(browser, path, faults, **context):
    context = browser.new_context(offline=True, accept_downloads=True, **context)
    page = context.new_page()
    page.on("console", lambda message: faults.check(message.type != "error", f"{path}: console: {message.text}"))
    page.on("pageerror", lambda error: faults.check(False, f"{path}: {error}"))
    asked = lambda request: faults.check(request.url.startswith(("file:", "blob:", "data:")), f"{path}: {request.url}")
    page.on("request", asked)
    page.goto(path.resolve().as_uri())
    return page


def everybody(browser, path, faults):
    page = opened(browser, path, faults, viewport={"width": 1280, "height": 900})
    page.evaluate(OPEN)
    # In the dark only colours differ.
    for scheme, rules in [("light", {}), ("dark", {"runOnly": ["color-contrast"]})]:
        page.emulate_media(color_scheme=scheme)
        for violation in Axe().run(page, options={"resultTypes": ["violations"], **rules}).response["violations"]:
            places = [node["target"] for node in violation["nodes"]][:3]
            summary = violation["nodes"][0]["failureSummary"]
            faults.check(False, f"{path}, {scheme}: axe: {violation['id']} ({len(violation['nodes'])}): {places} {summary}")
    page.emulate_media(color_scheme="light")
    faults.check(page.evaluate(REGIONS) == 0, f"{path}: a scrolling region cannot be reached by keyboard")
    faults.check(page.locator("th:not([scope])").count() == 0, f"{path}: a heading has no scope")
    for width in WIDTHS:
        page.set_viewport_size({"width": width, "height": 900})
        for fault in page.evaluate(KEYS) + page.evaluate(STICKY) + page.evaluate(FIGURES) + page.evaluate(SHEETS):
            faults.check(False, f"{path} at {width} px: {fault}")
        wider = page.evaluate("() => document.documentElement.scrollWidth - document.documentElement.clientWidth")
        faults.check(wider <= 0, f"{path} at {width} px: {wider} px wider than the window")
        blank = page.evaluate("""() => [...document.querySelectorAll('.figures')].flatMap(group => {
          const rows = new Map(), all = group.getBoundingClientRect();
          for (const svg of group.querySelectorAll('.canvas > svg')) {
            const box = svg.getBoundingClientRect(), top = Math.round(svg.closest('figure').getBoundingClientRect().top);
            rows.set(top, (rows.get(top) || 0) + box.width);
          }
          return [...rows.values()].slice(0, -1).map(wide => 1 - wide / all.width);
        })""")
        faults.check(all(share < 0.45 for share in blank), f"{path} at {width} px: blank beside a figure: {blank}")
    # Figures over two axes fill the page.
    page.set_viewport_size({"width": 1280, "height": 900})
    filled = page.evaluate("""() => [...document.querySelectorAll('figure:not(.narrow) .canvas > svg')].map(svg =>
      svg.getBoundingClientRect().width / document.querySelector('main').getBoundingClientRect().width)""")
    faults.check(all(share > 0.9 for share in filled), f"{path}: blank beside a figure: {filled}")
    page.reload()
    pdf = page.pdf()
    faults.check(pdf.startswith(b"%PDF") and len(pdf) > 10_000, f"{path}: it cannot be printed")
    page.emulate_media(media="print")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    closed = page.locator("details.proof:not([open])").count()
    faults.check(closed == 0, f"{path}: {closed} proofs are not printed")
    page.context.close()


def numbers(text):
    return [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?", text)]


def ticks(figure):
    return figure.locator("text.tick").all_text_contents()


def printed(pdf):
    """Size of the first page, number of pages, fonts that are in it."""
    sizes = [numbers(box.decode()) for box in re.findall(rb"/MediaBox *\[([^\]]*)\]", pdf)]
    pages = len(re.findall(rb"/Type */Page\b", pdf))
    return sizes[0][2:], pages, len(re.findall(rb"/FontFile[23]?\b", pdf))


def files(browser, folder, faults):
    """The file of each figure, printed by itself: one page of its own size."""
    for path in sorted(folder.glob("*.svg")):
        page = browser.new_page()
        page.goto(path.resolve().as_uri())
        root = ElementTree.parse(path).getroot()
        size, sheets, _ = printed(page.pdf(prefer_css_page_size=True))
        inches = [float(text[:-2]) / 25.4 if text.endswith("mm") else float(text) / 96 for text in map(root.get, ["width", "height"])]
        fits = all(-0.2 < points - 72 * inch < 1.1 for points, inch in zip(size, inches))
        faults.check(sheets == 1 and fits, f"{path}: {sheets} pages of {size} points for {inches} inches")
        page.close()


def downloaded(page, button):
    with page.expect_download() as download:
        button.focus()
        page.keyboard.press("Enter")
    return download.value.suggested_filename, Path(download.value.path()).read_text(encoding="utf-8")


def by_hand(browser, path, faults):
    """The page of studies/quick.yaml: three figures, the second with four designs."""
    page = opened(browser, path, faults, viewport={"width": 1280, "height": 900})
    figure = page.locator("#figure-transmission_error")
    svg, readout, canvas = (figure.locator(part) for part in ["svg[data-plot]", ".readout", ".canvas"])

    # Readout by keyboard: further to the right, further along.
    canvas.focus()
    page.keyboard.press("ArrowRight")
    first = readout.inner_text()
    for _ in range(40):
        page.keyboard.press("ArrowRight")
    later = readout.inner_text()
    faults.check(numbers(first)[0] < numbers(later)[0], f"readout does not move: {first!r}, {later!r}")
    faults.check(len(later.splitlines()) == 5, f"an abscissa and four designs are read: {later!r}")
    faults.check(figure.locator(".cross").count() == 1, "no crosshair")

    # Zoom by keyboard: ticks are new, and closer together; back again they are the old ones.
    cut = lambda: numbers(figure.locator("svg.data").get_attribute("viewBox"))
    uncut = cut()
    whole, curve = ticks(figure), figure.locator("path.series").first.get_attribute("d")
    page.keyboard.press("+")
    page.keyboard.press("+")
    close = ticks(figure)
    frame = json.loads(svg.get_attribute("data-plot"))["frame"]
    faults.check(cut() == frame, f"zoomed curves run over the axes: {cut()} for {frame}")
    faults.check(close != whole and len(close) >= 4, f"zoom leaves the axes: {close}")
    page.keyboard.press("ArrowRight")
    inside = numbers(readout.inner_text())[0]
    faults.check(abs(inside - numbers(later)[0]) < 2.5, f"it zooms elsewhere: {inside}")
    page.keyboard.press("0")
    faults.check(ticks(figure) == whole, f"not the whole again: {ticks(figure)} for {whole}")
    faults.check(cut() == uncut, f"a line on the edge is cut in half: {cut()}")
    restored = figure.locator("path.series").first.get_attribute("d")
    far = max(abs(a - b) for a, b in zip(numbers(curve), numbers(restored)))
    faults.check(far < 0.02, f"the line is {far} px elsewhere after a zoom and back")

    # So close that there is nothing more to see it goes no closer.
    for _ in range(40):
        page.keyboard.press("+")
    closest = ticks(figure)
    faults.check(len(closest) >= 4 and all(len(text) < 9 for text in closest), f"zoomed too far: {closest}")
    for _ in range(40):
        page.keyboard.press("-")
    faults.check(ticks(figure) != closest, f"it does not zoom out of {closest}")
    page.keyboard.press("0")

    # A box by mouse: what was inside fills the frame, and its axis says so.
    box = svg.bounding_box()
    at = lambda x, y: (box["x"] + x * box["width"], box["y"] + y * box["height"])
    page.mouse.move(*at(0.4, 0.3))
    page.mouse.down()
    page.mouse.move(*at(0.6, 0.6), steps=3)
    page.mouse.up()
    boxed = figure.locator("text.tick[text-anchor=middle]").all_text_contents()
    values = [float(text.replace("−", "-")) for text in boxed]
    faults.check(len(values) >= 2 and 2 < min(values) and max(values) < 6.5, f"box zoom: {boxed}")
    page.mouse.dblclick(*at(0.5, 0.5))
    faults.check(ticks(figure) == whole, "a double click does not show the whole")

    # By mouse: what is read is a point of the curve beside the pointer, marked where it lies.
    samples = [point for series in json.loads(svg.get_attribute("data-plot"))["series"] for point in series["points"]]
    for across in [0.203, 0.377, 0.641]:
        page.mouse.move(*at(across, 0.4))
        across, down = [numbers(figure.locator(".cross").get_attribute("d"))[index] for index in [0, 4]]
        marked = figure.locator("circle").evaluate_all("all => all.map(one => [+one.getAttribute('cx'), +one.getAttribute('cy')])")
        faults.check([across, down] in marked, f"the crosshair is at {across}, {down}, the points at {marked}")
        said = readout.inner_text().splitlines()
        place, value = numbers(said[0])[0], numbers(readout.locator(".near").inner_text())[0]
        near = min(math.dist(point, [place, value]) for point in samples)
        faults.check(near < 1e-3, f"{said} is no point of a curve, by {near}")

    # Where the figure is wider than the window, keys show the rest.
    page.set_viewport_size({"width": 390, "height": 900})
    canvas.focus()
    page.keyboard.press("End")
    scrolled = canvas.evaluate("region => [region.scrollLeft, region.scrollWidth - region.clientWidth]")
    faults.check(scrolled[0] > 0.9 * scrolled[1] > 0, f"the end is not in sight: {scrolled}")
    page.set_viewport_size({"width": 1280, "height": 900})

    # Toggling by keyboard and by mouse.
    button = figure.locator(".legend button", has_text="short")
    button.focus()
    page.keyboard.press("Space")
    shown = lambda: figure.locator("svg.data > g:not([style*=none])").count()
    faults.check(button.get_attribute("aria-pressed") == "false" and shown() == 3, f"{shown()} of 4 are left")
    canvas.focus()
    page.keyboard.press("ArrowRight")
    faults.check("short" not in readout.inner_text(), "what is hidden is read")
    button.click()
    faults.check(button.get_attribute("aria-pressed") == "true" and shown() == 4, "it does not come back")

    # Nothing is read where nothing is shown.
    page.mouse.move(*at(0.5, 0.4))
    faults.check("short" in readout.text_content(), "no readout")
    for button in figure.locator(".legend button").all():
        button.focus()
        page.keyboard.press("Space")
    page.mouse.move(*at(0.6, 0.4))
    canvas.focus()
    page.keyboard.press("ArrowRight")
    faults.check(readout.text_content() == "" and not readout.is_visible(), f"read of nothing: {readout.text_content()}")
    for button in figure.locator(".legend button").all():
        button.focus()
        page.keyboard.press("Space")

    # Export by keyboard: the values of the table, and a drawing by itself.
    name, text = downloaded(page, figure.locator("[data-do=csv]"))
    rows = list(csv.DictReader(io.StringIO(text)))
    designs = {row["series"] for row in rows}
    faults.check(name == "transmission_error.csv" and designs == {"unmodified", "short", "long", "optimum"}, f"{name}: {designs}")
    highest = max(float(row["Transmission error [µm]"]) for row in rows)
    faults.check(16 < highest < 19, f"CSV: {highest}")
    name, text = downloaded(page, figure.locator("[data-do=svg]"))
    root = ElementTree.fromstring(text)
    said = [element.text for element in root.iter("{http://www.w3.org/2000/svg}text")]
    faults.check(name.endswith(".svg") and "optimum" in said and "16" in said, f"SVG: {said}")
    faults.check("data-plot" not in text and "<style" in text, "the SVG needs the page")

    # A figure alone as PDF, by keyboard: one page as large as the drawing, whose letters are letters.
    page.evaluate("window.print = () => { window.asked = true; }")
    figure.locator("[data-do=pdf]").focus()
    page.keyboard.press("Enter")
    faults.check(page.evaluate("window.asked") is True, "PDF does not ask to print")
    size, sheets, fonts = printed(page.pdf(prefer_css_page_size=True))
    box = numbers(root.get("viewBox"))
    wanted = [math.ceil(0.75 * length) for length in box[2:]]
    faults.check(sheets == 1 and all(abs(a - b) < 1 for a, b in zip(size, wanted)), f"PDF: {sheets} pages of {size}, not {wanted}")
    faults.check(fonts > 0, "PDF: no font is embedded")
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    faults.check(page.locator(".alone").count() == 0, "what was printed stays in the page")

    # Tables: found by a word in a row, shown in full, given back.
    page.locator("#find").fill("tip_relief")
    page.wait_for_timeout(200)
    left = page.locator("details.table:not([hidden])").evaluate_all("all => all.map(one => one.dataset.table)")
    faults.check("designs.elements" in left and "stiffness.curve" not in left, f"found: {left}")
    table = page.locator("details.table[data-table='designs.elements']")
    table.locator("summary").first.focus()
    page.keyboard.press("Enter")
    page.wait_for_timeout(200)
    held = table.locator("table.data tbody tr").count()
    faults.check(0 < held < 12, f"{held} rows with the word")
    page.locator("#find").fill("")
    page.wait_for_timeout(200)
    faults.check(table.locator("table.data tbody tr").count() == 12, "not all rows are back")
    name, text = downloaded(page, table.get_by_role("button", name="CSV"))
    faults.check(name == "designs.elements.csv" and len(text.splitlines()) == 13, f"{name}: {len(text.splitlines())} lines")

    # A verdict's badge shows its rows alone.
    badge = page.locator("button[data-verdict=holds]")
    badge.focus()
    page.keyboard.press("Enter")
    faults.check(page.locator("tr[data-verdict=holds]:visible").count() == 1, "the badge hides its own rows")

    # What is linked is there.
    links = page.locator("a[href]:not([href^='#'])").evaluate_all("all => [...new Set(all.map(one => one.getAttribute('href')))]")
    lost = [link for link in links if not (path.parent / link).exists()]
    faults.check(len(links) > 10 and not lost, f"linked, but not there: {lost}")
    page.context.close()


def many(browser, path, faults):
    """A page whose first figure has 41 series: the nearest are read, and nothing hangs over."""
    for width in [1280, 390]:
        page = opened(browser, path, faults, viewport={"width": width, "height": 900})
        figure = page.locator("figure").first
        canvas, readout = figure.locator(".canvas"), figure.locator(".readout")
        canvas.focus()
        for _ in range(20):
            page.keyboard.press("ArrowRight")
        said = readout.inner_text().splitlines()
        told = len(said) - 2
        faults.check(3 <= told <= 10 and said[-1] == f"{41 - told} more", f"{path} at {width} px: {said}")
        inside = readout.evaluate("one => one.offsetTop >= 0 && one.offsetTop + one.offsetHeight <= one.parentElement.clientHeight")
        still = canvas.evaluate("one => one.scrollHeight <= one.clientHeight")
        faults.check(inside and still, f"{path} at {width} px: the readout hangs over")
        page.context.close()


def main(arguments):
    if not Path(CHROMIUM).exists():
        print("SKIPPED: no chromium")
        return 0
    faults = Faults()
    pages, driven, crowded = ([], [], [])
    group = pages
    for argument in arguments:
        if argument.startswith("--"):
            group = {"--quick": driven, "--many": crowded}[argument]
        else:
            group.append(argument)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=SWITCHES)
        for path in pages + driven:
            everybody(browser, Path(path), faults)
        for path in driven:
            by_hand(browser, Path(path), faults)
        for path in crowded:
            many(browser, Path(path), faults)
        for path in pages + driven:
            files(browser, Path(path).parent / "figures", faults)
        browser.close()
    # The same fault in a hundred rows is one.
    print("\n".join(faults.found[:40]) or f"{len(pages + driven)} pages, {faults.checks} checks")
    return 1 if faults.found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
