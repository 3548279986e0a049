"""Pictures of the pages in both themes: `python -m benchmarks.page_pictures` writes docs/pictures/.

It starts a whole service of its own, runs an example, and drives the chromium of the system (`CHROMIUM`) through
Playwright. A page is another entry of `PAGES`.
"""

import os
import tempfile
from io import BytesIO
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright

from app.runtime.settings import Settings
from tests import embedded
from tests.servers import free_port

PICTURES = Path(__file__).parents[1] / "docs" / "pictures"
CHROMIUM = os.environ.get("CHROMIUM", "/usr/bin/chromium")
THEMES = ("light", "dark")
WIDE, NARROW = (1280, 1000), (360, 780)
RESULT = "result"
PAGES = {
    "start": ("/", "main"),
    "line": ("/pages/lines/new", "#preview .drawing.span"),
    RESULT: ("", ".chart canvas"),
    "jobs": ("/pages/jobs", "table"),
    "sign-in": ("/pages/sign-in", "form"),
}
"""Addresses by the names of the pictures, each with what must be there before it is taken."""

_SETTLED_MS = 2000
_PATIENCE_MS = 180_000
_COLOURS = 256


def main() -> None:
    """Write all pictures."""
    PICTURES.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        settings = Settings(data_dir=Path(folder))
        with embedded.serving(settings, free_port()) as (_, client):
            browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
            service = str(client.base_url).rstrip("/")
            result = _result(browser, service)
            for name, (path, needed) in PAGES.items():
                for theme in THEMES:
                    address = service + (result if name == RESULT else path)
                    _save(_taken(browser, address, needed, (*WIDE, theme)), f"{name}-{theme}")
            _save(_taken(browser, service + result, PAGES[RESULT][1], (*NARROW, "light")), f"{RESULT}-narrow")
            browser.close()


def _result(browser: Browser, service: str) -> str:
    """Run an example, and return the path of its page."""
    page = _page(browser, (*WIDE, "light"))
    page.goto(service)
    page.locator("form[action$='/pages/examples/drake'] button").click()
    page.wait_for_selector(".verdict", timeout=_PATIENCE_MS)
    path = page.url.removeprefix(service)
    page.context.close()
    return path


def _taken(browser: Browser, address: str, needed: str, look: tuple[int, int, str]) -> bytes:
    page = _page(browser, look)
    page.goto(address)
    page.wait_for_selector(needed, timeout=_PATIENCE_MS)
    page.wait_for_timeout(_SETTLED_MS)
    picture = page.screenshot()
    page.context.close()
    return picture


def _page(browser: Browser, look: tuple[int, int, str]) -> Page:
    width, height, theme = look
    context = browser.new_context(
        viewport={"width": width, "height": height},
        color_scheme="dark" if theme == "dark" else "light",
        reduced_motion="reduce",
    )
    return context.new_page()


def _save(picture: bytes, name: str) -> None:
    """Write a picture with few colours: pages have not more, and the repository stays small."""
    image = Image.open(BytesIO(picture)).convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE)
    image.save(PICTURES / f"{name}.png", optimize=True)


if __name__ == "__main__":
    main()
