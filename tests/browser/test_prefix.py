"""Behind a proxy that serves the pages below a path: every page works, and nothing is asked for above that path."""

import json
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from playwright.sync_api import Browser, Page, Response, expect

from app.reference.source_lines import example
from app.runtime.settings import Settings
from tests import embedded
from tests.app.lines import SHORT
from tests.browser.stripping_proxy import below
from tests.servers import free_port

PREFIX = "/grid/galloping"
CLIMATE = {
    "line_azimuth_deg": 90.0,
    "sectors": [
        {"direction_deg": 0.0, "width_deg": 0.0, "share": 1.0, "weibull_shape": 2.0, "weibull_scale_m_per_s": 6.0}
    ],
    "icing": [{"kind": "glaze", "hours_a_year": 40.0}],
}


@pytest.fixture(scope="module")
def below_a_path(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Give the address of a service below a path."""
    settings, port = Settings(data_dir=tmp_path_factory.mktemp("prefix"), root_path=PREFIX), free_port()
    with embedded.serving(settings, port), below(PREFIX, port) as address:
        yield address


@pytest.fixture
def page(browser: Browser, below_a_path: str) -> Iterator[Page]:
    """Give a page; at the end every answer must have come from below the path, without a fault."""
    context = browser.new_context()
    bad: list[str] = []

    def look(answer: Response) -> None:
        if not answer.url.startswith(f"{below_a_path}/") or answer.status >= 400:
            bad.append(answer.url)

    opened = context.new_page()
    opened.on("response", look)
    yield opened
    context.close()
    assert bad == []


def test_an_example_its_what_if_its_report_and_its_remedies(page: Page, below_a_path: str) -> None:
    page.goto(f"{below_a_path}/")
    page.locator("form[action$='/pages/examples/c11-twin'] button").click()
    page.wait_for_selector(".verdict", timeout=180_000)
    result = page.url
    expect(page.locator(".chart canvas")).to_be_visible()
    page.get_by_role("link", name="What if").click()
    expect(page.locator(".chart canvas")).to_be_visible(timeout=60_000)
    page.goto(f"{result}/report")
    page.wait_for_function("[...document.images].every(image => image.complete && image.naturalWidth > 0)")
    assert page.locator("img").count() == 2
    page.goto(result)
    page.get_by_role("button", name="Which remedy helps?").click()
    expect(page.locator("h1")).to_be_visible()
    assert page.url != result


def test_a_batch_and_the_lines_that_a_filter_lets_through(page: Page, below_a_path: str, tmp_path: Path) -> None:
    lines = [{**example("c11-twin"), "name": f"span {half}", "tags": {"half": half}} for half in ("west", "east")]
    file = tmp_path / "lines.ndjson"
    file.write_text("\n".join(map(json.dumps, [{"analysis": SHORT}, *lines])), encoding="utf-8")
    page.goto(f"{below_a_path}/pages/batches")
    page.locator("#file").set_input_files(file)
    page.get_by_role("button", name="Check the file").click()
    expect(page.locator("#checked")).to_contain_text("2 of 2 lines can be computed.")
    page.get_by_role("button", name="Compute the lines").click()
    expect(page.locator("a[download='batch.csv']")).to_be_visible(timeout=60_000)
    page.get_by_label("Tag").fill("half:east")
    page.get_by_role("button", name="Show").click()
    expect(page.locator("table.lines a")).to_have_text(["span east"])
    with page.expect_download() as download:
        page.locator("a[download='batch-filtered.csv']").click()
    text = Path(download.value.path()).read_text(encoding="utf-8")
    assert "span east" in text
    assert "span west" not in text
    page.locator("table.lines a").click()
    expect(page.locator(".verdict")).to_be_visible()


def test_a_line_with_a_climate_draws_its_risk(page: Page, below_a_path: str) -> None:
    with httpx.Client() as client:
        document = {"line": {**example("c11-twin"), "climate": CLIMATE}, "analysis": SHORT}
        job = client.post(f"{below_a_path}/v1/jobs", json=document).raise_for_status().json()["id"]
    page.goto(f"{below_a_path}/pages/jobs/{job}")
    picture = page.get_by_role("img", name="Risk of the year")
    picture.scroll_into_view_if_needed(timeout=60_000)
    expect(picture).to_have_js_property("complete", True)
    assert picture.evaluate("image => image.naturalWidth") > 0
