"""The whole embedded service, a browser, and pages that fail a test if the browser complains about them."""

import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, BrowserContext, ConsoleMessage, Page, expect, sync_playwright

from app.runtime.settings import Settings
from tests import embedded
from tests.servers import free_port

CHROMIUM = os.environ.get("CHROMIUM", "/usr/bin/chromium")
expect.set_options(timeout=30_000)  # the first line that is resolved loads the numerics; a busy machine takes its time
QUIET = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """Give the chromium of the system."""
    if shutil.which(CHROMIUM) is None:
        if "CI" in os.environ:
            pytest.fail(f"{CHROMIUM} is missing")
        pytest.skip(f"{CHROMIUM} is missing")
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=QUIET)
        yield started
        started.close()


@pytest.fixture(scope="session")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Give the address of a whole service without keys."""
    settings = Settings(data_dir=tmp_path_factory.mktemp("browser"))
    with embedded.serving(settings, free_port()) as (_, client):
        yield str(client.base_url).rstrip("/")


@pytest.fixture
def open_page(browser: Browser, service: str) -> Iterator[Callable[..., Page]]:
    """Give a function that opens a page of the service; at the end nothing may have gone wrong in any of them."""
    contexts: list[BrowserContext] = []
    complaints: list[str] = []

    def complain(message: ConsoleMessage) -> None:
        if message.type in {"error", "warning"}:
            complaints.append(f"{message.type}: {message.text}")

    def opened(path: str, width: int = 1280, scheme: str = "light", *, scripts: bool = True) -> Page:
        context = browser.new_context(
            base_url=service,
            java_script_enabled=scripts,
            viewport={"width": width, "height": 900},
            color_scheme="dark" if scheme == "dark" else "light",
        )
        contexts.append(context)
        page = context.new_page()
        page.on("console", complain)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.goto(path)
        return page

    yield opened
    for context in contexts:
        context.close()
    assert complaints == []


@pytest.fixture(scope="session")
def finished_job(browser: Browser, service: str) -> str:
    """Give the path of the page of a finished job with everything that a page can show."""
    context = browser.new_context(base_url=service)
    page = context.new_page()
    page.goto("/")
    page.locator("form[action$='/pages/examples/drake'] button").click()
    page.wait_for_selector(".verdict", timeout=180_000)
    path = page.url.removeprefix(service)
    context.close()
    return path


AXE = (Path(__file__).parent / "axe" / "axe.min.js").read_text(encoding="utf-8")


@pytest.fixture
def serious_faults() -> Callable[[Page], list[str]]:
    """Give a function that lists the serious and critical findings of axe on a page."""

    def found(page: Page) -> list[str]:
        page.evaluate(AXE)
        violations = page.evaluate("async () => (await axe.run()).violations")
        return [
            f"{violation['id']}: {violation['help']}: {node['html'][:150]}"
            for violation in violations
            if violation["impact"] in {"serious", "critical"}
            for node in violation["nodes"]
        ]

    return found
