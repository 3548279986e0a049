"""A result: from the first click to the verdict, the chart, and the downloads."""

from collections.abc import Callable
from pathlib import Path

import httpx
import pytest
from playwright.sync_api import Page, expect

Open = Callable[..., Page]


def test_one_click_leads_to_a_verdict(open_page: Open) -> None:
    page = open_page("/")
    page.locator("form[action$='/pages/examples/c11-twin'] button").click()
    page.wait_for_selector(".verdict", timeout=180_000)
    expect(page.locator(".verdict .answer")).to_have_text("It gallops")
    sentence = page.locator(".verdict .lead").inner_text()
    assert "Gallops from 2." in sentence


def test_the_chart_can_be_read_and_zoomed(open_page: Open, finished_job: str) -> None:
    page = open_page(finished_job)
    page.wait_for_selector(".chart canvas")
    whole = page.evaluate(
        "(() => { const x = document.querySelector('.chart').chart.plot.scales.x; return [x.min, x.max] })()"
    )
    page.locator(".chart").scroll_into_view_if_needed()
    page.locator(".u-over").scroll_into_view_if_needed()
    box = page.locator(".u-over").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + 0.5 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 0.6 * box["width"], box["y"] + 0.5 * box["height"], steps=5)
    page.mouse.up()
    zoomed = page.evaluate(
        "(() => { const x = document.querySelector('.chart').chart.plot.scales.x; return [x.min, x.max] })()"
    )
    assert whole[0] < zoomed[0] < zoomed[1] < whole[1]
    assert zoomed[1] - zoomed[0] == pytest.approx(0.3 * (whole[1] - whole[0]), rel=0.05)
    page.get_by_role("button", name="Whole range").click()
    again = page.evaluate(
        "(() => { const x = document.querySelector('.chart').chart.plot.scales.x; return [x.min, x.max] })()"
    )
    assert again == pytest.approx(whole)


def test_the_chart_says_what_is_under_the_pointer(open_page: Open, finished_job: str) -> None:
    page = open_page(finished_job)
    page.wait_for_selector(".chart canvas")
    place = page.evaluate(
        "(() => { const { plot, data } = document.querySelector('.chart').chart; const piece = data.pieces[0];"
        " const last = [piece.wind.at(-1), piece.vertical.at(-1)];"
        " return [plot.valToPos(last[0], 'x'), plot.valToPos(last[1], 'y')] })()"
    )
    page.locator(".u-over").hover(position={"x": place[0], "y": place[1]})
    expect(page.locator(".reading")).to_contain_text("m/s")


@pytest.mark.parametrize("form", ["CSV", "XLSX", "Parquet", "JSON"])
def test_the_verdict_is_downloaded_in_every_form(open_page: Open, finished_job: str, form: str) -> None:
    page = open_page(finished_job)
    with page.expect_download() as waiting:
        page.locator("a[href*='/results/verdict?']", has_text=form).click()
    assert Path(waiting.value.path()).stat().st_size > 100


def test_pictures_are_downloaded(open_page: Open, finished_job: str, service: str) -> None:
    page = open_page(finished_job)
    for address in page.locator("a[href*='/plots/']").evaluate_all("links => links.map(link => link.href)"):
        assert httpx.get(address, timeout=60.0).status_code == 200
        assert address.startswith(service)
