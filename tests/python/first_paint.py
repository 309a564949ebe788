"""Milliseconds from opening a page on the disk to its first paint in headless Chromium, one line for each of some times.

    first_paint.py PAGE TIMES
"""

import sys
from pathlib import Path

from page import CHROMIUM, SWITCHES
from playwright.sync_api import sync_playwright

PAINT = """() => new Promise(done => {
  const first = () => performance.getEntriesByName('first-contentful-paint')[0];
  const look = () => first() ? done(first().startTime) : setTimeout(look, 10);
  look();
})"""


def main(path, times):
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=SWITCHES)
        for _ in range(int(times)):
            context = browser.new_context(viewport={"width": 1280, "height": 900}, offline=True)
            page = context.new_page()
            page.goto(Path(path).resolve().as_uri())
            print(page.evaluate(PAINT))
            context.close()
        browser.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
