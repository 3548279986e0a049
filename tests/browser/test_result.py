"""A result: from the first click to the verdict, the chart, and the downloads."""

import csv
import json
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree

import openpyxl
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


def is_csv(content: bytes) -> bool:
    head, *rows = csv.reader(content.decode("utf-8-sig").splitlines())
    return len(head) > 1 and bool(rows)


READS: dict[str, Callable[[bytes], object]] = {
    "csv": is_csv,
    "xlsx": lambda content: openpyxl.load_workbook(BytesIO(content)).active,
    "parquet": lambda content: content[:4] == content[-4:] == b"PAR1",
    "json": json.loads,
    "svg": lambda content: ElementTree.fromstring(content).tag == "{http://www.w3.org/2000/svg}svg",
    "png": lambda content: content.startswith(b"\x89PNG\r\n\x1a\n"),
    "pdf": lambda content: content.startswith(b"%PDF-") and b"%%EOF" in content[-32:],
}


@pytest.mark.parametrize("form", READS)
def test_every_download_is_a_file_of_its_kind(open_page: Open, finished_job: str, form: str) -> None:
    page = open_page(finished_job)
    first, *others = page.locator(f"#downloads ~ * a[download$='.{form}']").all()
    with page.expect_download(timeout=60_000) as waiting:
        first.click()
    assert waiting.value.suggested_filename.endswith(f".{form}")
    assert READS[form](Path(waiting.value.path()).read_bytes())
    for link in others:
        answer = page.request.get(link.evaluate("link => link.href"))
        assert answer.ok, answer.text()
        assert READS[form](answer.body()), link.get_attribute("href")


def test_the_request_is_given_as_curl_and_as_python(open_page: Open, finished_job: str, service: str) -> None:
    page = open_page(finished_job)
    texts = page.locator("#downloads ~ details pre").all_text_contents()
    curl, python, document = texts
    assert curl.startswith(f"curl -X POST {service}/v1/jobs ")
    assert json.loads(curl.partition("<<'END'\n")[2].removesuffix("\nEND")) == json.loads(document)
    compile(python, "request.py", "exec")
    assert json.loads(document)["line"]
