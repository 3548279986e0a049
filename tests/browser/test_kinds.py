"""The pages of jobs of every kind: without faults of accessibility, within the window, and whole on paper."""

import time
from collections.abc import Callable, Iterator
from typing import Any

import httpx
import pytest
from playwright.sync_api import Page, expect

from app.pages.wording import words
from app.reference.source_lines import example
from app.runtime.settings import Settings
from tests import embedded
from tests.app.lines import SHORT
from tests.servers import free_port

SPACER = {"type": "interphase_spacer", "position_m": 62.94, "mass_kg": 30.0, "between": ["this", "top"]}
TIED = {**example("c11-twin"), "devices": [SPACER], "phases": [{"name": "top", "y_m": 7.0}]}
SECTOR = {"direction_deg": 0.0, "width_deg": 0.0, "share": 1.0, "weibull_shape": 2.0, "weibull_scale_m_per_s": 6.0}
CLIMATE = {"line_azimuth_deg": 90.0, "sectors": [SECTOR], "icing": [{"kind": "glaze", "hours_a_year": 40.0}]}
STUDY = {"axes": [{"parameter": "span.length_m", "values": [120.0, 140.0]}]}
KINDS: dict[str, dict[str, Any]] = {
    "risk": {"line": {**example("c11-twin"), "climate": CLIMATE}, "analysis": SHORT},
    "study": {"line": example("c11-twin"), "analysis": SHORT, "study": STUDY},
    "remedies": {"line": example("c11-twin"), "analysis": {**SHORT, "models": ["hybrid"]}, "remedies": {}},
    "tied": {"line": TIED, "analysis": {**SHORT, "models": ["finite_element"]}},
}
PAGES = ("risk", "study", "remedies", "cancelled", "failed", "report", "tied what-if")
Open = Callable[..., Page]


@pytest.fixture(scope="session")
def failed_job(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Give the address of a job that ran longer than its service lets a job run."""
    settings = Settings(data_dir=tmp_path_factory.mktemp("failing"), soft_time_limit_seconds=0.001)
    with embedded.serving(settings, free_port()) as (_, client):
        location = embedded.submit(client, KINDS["study"])
        embedded.wait_for(client, location, "failed")
        yield f"{client.base_url}".rstrip("/") + location.replace("/v1/", "/pages/")


@pytest.fixture(scope="session")
def paths(service: str, finished_job: str, failed_job: str) -> dict[str, str]:
    """Give the paths of the pages of jobs of every kind."""
    jobs = {}
    with httpx.Client(base_url=service, timeout=60.0) as client:
        for kind, document in KINDS.items():
            jobs[kind] = client.post("/v1/jobs", json=document).raise_for_status().json()["id"]
        client.delete(f"/v1/jobs/{jobs['tied']}").raise_for_status()
        ends = time.monotonic() + 120.0
        for kind in ("risk", "study", "remedies"):
            while client.get(f"/v1/jobs/{jobs[kind]}").json()["status"] in {"accepted", "running"}:
                assert time.monotonic() < ends, f"the job of {kind} does not end"
                time.sleep(0.2)
    own = {kind: f"/pages/jobs/{job}" for kind, job in jobs.items()}
    return {
        **own,
        "cancelled": own["tied"],
        "failed": failed_job,
        "tied what-if": f"{own['tied']}/what-if",
        "report": f"{finished_job}/report",
    }


def beyond(page: Page) -> int:
    return int(page.evaluate("document.documentElement.scrollWidth - window.innerWidth"))


@pytest.mark.parametrize("name", PAGES)
def test_axe_finds_nothing_serious_and_nothing_reaches_beyond_the_window(
    open_page: Open, paths: dict[str, str], serious_faults: Callable[[Page], list[str]], name: str
) -> None:
    for width, scheme in ((1280, "light"), (360, "dark"), (3840, "light")):
        page = open_page(paths[name], width=width, scheme=scheme)
        page.wait_for_load_state("networkidle")
        for details in page.locator("details").all():
            details.evaluate("element => { element.open = true }")
        assert beyond(page) <= 0, width
        assert width == 3840 or serious_faults(page) == []


def test_a_failed_job_says_why_and_what_to_try(open_page: Open, failed_job: str) -> None:
    page = open_page(failed_job)
    expect(page.get_by_text("ran longer than the limit of 0.001 s")).to_be_visible()
    hints = page.get_by_role("main").get_by_role("listitem")
    assert hints.all_inner_texts() == words().without_result.hints.time_limit


def test_the_remedies_are_drawn_and_told_row_by_row(open_page: Open, paths: dict[str, str]) -> None:
    page = open_page(paths["remedies"])
    part = page.get_by_role("region", name=words().remedies.title)
    part.locator("img").scroll_into_view_if_needed()
    expect(part.locator("img")).to_have_js_property("complete", value=True)
    assert part.locator("img").evaluate("image => image.naturalWidth") > 300
    assert part.locator("tbody tr").count() >= 5


def test_the_sliders_of_tied_phases_move_without_a_curve(open_page: Open, paths: dict[str, str]) -> None:
    page = open_page(paths["tied what-if"])
    slider = page.locator("#pendulum_mass")
    slider.focus()
    page.keyboard.press("ArrowRight")
    assert slider.get_attribute("aria-valuetext") == page.locator("#pendulum_mass-shown").inner_text() != "0 kg"
    expect(page.get_by_text("Only the finite element model computes them together")).to_be_visible()


def test_a_result_is_printed_without_controls_and_whole(open_page: Open, finished_job: str) -> None:
    page = open_page(finished_job, width=720)  # about the width of A4
    page.wait_for_selector(".motion .moving")
    page.emulate_media(media="print")
    for control in page.locator("main :is(button, select, input, textarea)").all():
        expect(control).to_be_hidden()
    cut = (
        "boxes => boxes.some(box => getComputedStyle(box).overflowX != 'visible' && box.scrollWidth > box.clientWidth)"
    )
    assert not page.locator("main .scroll").evaluate_all(cut)
