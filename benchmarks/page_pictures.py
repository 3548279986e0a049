"""Pictures of the pages in both themes: `python -m benchmarks.page_pictures` writes docs/pictures/.

It starts a whole service of its own, computes a job of each kind, and drives the chromium of the system (`CHROMIUM`)
through Playwright. A page is another entry of `PAGES`.
"""

import os
import sys
import tempfile
from io import BytesIO
from pathlib import Path

import httpx
from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright

from app.runtime.settings import Settings
from benchmarks import pictured_jobs
from tests import embedded
from tests.servers import free_port

PICTURES = Path(__file__).parents[1] / "docs" / "pictures"
CHROMIUM = os.environ.get("CHROMIUM", "/usr/bin/chromium")
THEMES = ("light", "dark")
WIDE, NARROW = (1280, 1000), (360, 780)
PAGES = {
    "start": ("/", "main", ""),
    "line": ("/pages/lines/new", "#preview .drawing.span", ""),
    "result": ("{result}", ".chart canvas", ""),
    "motion": ("{result}", ".motion .moving", "#motion"),
    "decides": ("{result}", ".tornado", "#decides"),
    "clearances": ("{result}", ".chart canvas", "#clearances"),
    "downloads": ("{result}", ".chart canvas", "#downloads"),
    "what-if": ("{result}/what-if", "#verdict .answer:not(:empty)", ""),
    "remedies": ("{remedies}", ".chart canvas", "#remedies"),
    "risk": ("{risk}", ".chart canvas", "#risk"),
    "study": ("{study}", ".chart canvas", "#study"),
    "report": ("{result}/report", "figure", ""),
    "batches": ("/pages/batches", "table", ""),
    "batch": ("{batch}", "table.lines", ""),
    "map": ("{batch}", ".map", "#spread"),
    "jobs": ("/pages/jobs", "table", ""),
    "cancelled": ("{cancelled}", "form", ""),
    "removed": ("/pages/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e", "main", ""),
    "sign-in": ("/pages/sign-in", "form", ""),
}
"""Addresses by the names of the pictures, each with what must be there, and the heading at which the picture begins."""

_UNDER_WAY = "under-way"
_ONE_THEME = ("report",)  # paper is white
_NARROW = ("line", "result", "batch")
_SETTLED_MS = 2000
_PATIENCE_MS = 180_000
_COLOURS = 256
_TALLEST = 1500  # what ends within this height is shown to its end, anything longer as much as the window shows


def main() -> None:
    """Write all pictures, or those whose names are given."""
    wanted = sys.argv[1:] or [*PAGES, _UNDER_WAY]
    PICTURES.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        settings = Settings(data_dir=Path(folder), preview_seconds=30.0)
        with embedded.serving(settings, free_port()) as (_, client):
            client.timeout = httpx.Timeout(_PATIENCE_MS / 1000.0)
            browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
            service, paths = str(client.base_url).rstrip("/"), pictured_jobs.paths(client)
            for name, (path, needed, heading) in PAGES.items():
                if name not in wanted:
                    continue
                address = service + path.format(**paths)
                looks = {f"{name}-{theme}": (*WIDE, theme) for theme in THEMES[: 1 if name in _ONE_THEME else 2]}
                looks |= {f"{name}-narrow": (*NARROW, "light")} if name in _NARROW else {}
                for picture, look in looks.items():
                    _save(_taken(browser, address, (needed, heading), look), picture)
            for theme in THEMES if _UNDER_WAY in wanted else ():
                address = service + pictured_jobs.under_way(client)
                _save(_taken(browser, address, ("#progress", ""), (*WIDE, theme)), f"{_UNDER_WAY}-{theme}")
            browser.close()


def _taken(browser: Browser, address: str, parts: tuple[str, str], look: tuple[int, int, str]) -> bytes:
    needed, heading = parts
    page = _page(browser, look)
    page.goto(address)
    page.wait_for_selector(needed, timeout=_PATIENCE_MS)
    if heading:
        page.locator(heading).evaluate("heading => heading.scrollIntoView({ block: 'start' })")
    page.wait_for_timeout(_SETTLED_MS)
    if heading:  # pictures that were loaded meanwhile have moved it
        page.locator(heading).evaluate("heading => heading.scrollIntoView({ block: 'start' })")
        page.wait_for_load_state("networkidle")
    top, left = page.evaluate("[window.scrollY, document.documentElement.scrollHeight - window.scrollY]")
    if left > _TALLEST:
        picture = page.screenshot()
    else:
        picture = page.screenshot(full_page=True, clip={"x": 0, "y": top, "width": look[0], "height": left})
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
