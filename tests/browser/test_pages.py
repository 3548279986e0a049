"""Every page in both themes and at several widths: readable, without faults of accessibility, within the policy."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page

PAGES = (
    "/",
    "/pages/jobs",
    "/pages/lines/new",
    "/pages/sign-in",
    "/pages/nothing",
    "finished job",
    "what if",
    "/pages/batches",
)
Open = Callable[..., Page]


def path_of(name: str, finished_job: str) -> str:
    return {"finished job": finished_job, "what if": f"{finished_job}/what-if"}.get(name, name)


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("name", [name for name in PAGES if name != "/pages/nothing"])
def test_axe_finds_nothing_serious(
    open_page: Open, finished_job: str, serious_faults: Callable[[Page], list[str]], name: str, scheme: str
) -> None:
    page = open_page(path_of(name, finished_job), scheme=scheme)
    page.wait_for_load_state("networkidle")
    for details in page.locator("details").all():
        details.evaluate("element => { element.open = true }")
    assert serious_faults(page) == []


@pytest.mark.parametrize("width", [360, 3840])
@pytest.mark.parametrize("name", [name for name in PAGES if name != "/pages/nothing"])
def test_nothing_reaches_beyond_the_window(open_page: Open, finished_job: str, name: str, width: int) -> None:
    page = open_page(path_of(name, finished_job), width=width)
    page.wait_for_load_state("networkidle")
    assert page.evaluate("document.documentElement.scrollWidth - window.innerWidth") <= 0


def test_every_control_has_a_name_and_is_reached_by_the_keyboard(open_page: Open) -> None:
    page = open_page("/")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.className") == "skip"
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "content"
