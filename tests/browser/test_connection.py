"""A lost connection is said, and recovers; a job that is gone says so."""

from collections.abc import Callable
from pathlib import Path

import httpx
from playwright.sync_api import Browser, Page, expect

from app.reference.source_lines import example
from app.runtime.settings import Settings
from tests import embedded, processes
from tests.servers import free_port

Open = Callable[..., Page]
SECONDS_LONG = {"loops": [1, 2, 3], "wind_speeds_m_per_s": {"start": 2.0, "stop": 16.0, "count": 60}}
LOST = "connection to the service is lost"


def started(page: Page, service: str) -> None:
    """Post a job that takes some seconds, and open its page."""
    document = {"line": example("c11-twin"), "analysis": SECONDS_LONG}
    anew = {"Cache-Control": "no-cache"}
    job = httpx.post(f"{service}/v1/jobs", json=document, headers=anew).raise_for_status().json()["id"]
    page.goto(f"{service}/pages/jobs/{job}")
    expect(page.locator("#progress")).to_be_visible()


def test_a_lost_connection_shows_and_recovers(browser: Browser, service: str) -> None:
    context = browser.new_context(base_url=service)
    page = context.new_page()
    page.goto("/pages/lines/new")
    expect(page.locator("#preview .drawing.span")).to_be_visible()
    notice = page.locator("#connection")
    expect(notice).to_be_hidden()
    context.set_offline(True)
    page.get_by_label("Length [m]").fill("310")
    expect(notice).to_contain_text("connection to the service is lost")
    context.set_offline(False)
    page.get_by_label("Length [m]").fill("320")
    expect(notice).to_be_hidden()
    expect(page.locator("#preview pre")).to_contain_text("320")
    context.close()


def test_a_job_goes_on_while_the_browser_has_no_connection(browser: Browser, service: str) -> None:
    context = browser.new_context()
    page = context.new_page()
    started(page, service)
    context.set_offline(True)
    expect(page.locator("#connection")).to_contain_text(LOST)
    context.set_offline(False)
    page.wait_for_selector(".verdict", timeout=120_000)
    expect(page.locator("#connection")).to_be_hidden()
    context.close()


def test_the_page_of_a_job_survives_the_death_of_the_service(browser: Browser, tmp_path: Path) -> None:
    settings, port = Settings(data_dir=tmp_path, lease_seconds=2.0, heartbeat_seconds=0.5), free_port()
    context = browser.new_context()
    page = context.new_page()
    with embedded.serving(settings, port) as (process, client):
        started(page, str(client.base_url))
        processes.kill_group(process)
        expect(page.locator("#connection")).to_contain_text(LOST)
    with embedded.serving(settings, port):
        page.wait_for_selector(".verdict", timeout=120_000)
        expect(page.locator("#connection")).to_be_hidden()
        context.close()


def test_a_removed_job_says_so(browser: Browser, service: str) -> None:
    context = browser.new_context(base_url=service)
    page = context.new_page()
    page.goto("/")
    page.locator("form[action$='/pages/examples/c11-single'] button").click()
    page.wait_for_selector(".verdict", timeout=180_000)
    path = page.url.removeprefix(service)
    page.get_by_role("button", name="Remove the job").click()
    page.wait_for_url("**/pages/jobs")
    answer = page.goto(path)
    assert answer is not None
    assert answer.status == 404
    expect(page.locator("main")).to_contain_text("A job that was removed has no page any more")
    assert httpx.get(service + path.replace("/pages/", "/v1/")).status_code == 404
    context.close()


def test_units_and_appearance_are_chosen_at_the_foot(open_page: Open, finished_job: str) -> None:
    page = open_page(finished_job)
    page.get_by_label("Units").select_option("feet")
    page.get_by_label("Appearance").select_option("dark")
    page.get_by_role("button", name="Apply").click()
    expect(page.locator("html")).to_have_attribute("data-theme", "dark")
    expect(page.locator(".facts").first).to_contain_text("mph")
    expect(page.locator(".facts").first).to_contain_text("ft")
