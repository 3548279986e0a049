"""A batch from its file to its lines: checked, submitted, followed, filtered, and opened line by line."""

import json
from collections.abc import Callable
from pathlib import Path

from playwright.sync_api import Page, expect

from app.reference.source_lines import example

Open = Callable[..., Page]


def test_a_file_is_checked_submitted_and_read(
    open_page: Open, serious_faults: Callable[[Page], list[str]], tmp_path: Path
) -> None:
    twin = example("c11-twin")
    features = [
        {
            "type": "Feature",
            "geometry": {"type": "LineString", "coordinates": [[10.0, 60.0], [10.002, 60.0]]},
            "properties": {**twin, "name": f"span of {length}", "span": {**twin["span"], "length_m": length}},
        }
        for length in (120, 140, -5)
    ]
    file = tmp_path / "lines.geojson"
    file.write_text(json.dumps({"type": "FeatureCollection", "features": features}), encoding="utf-8")
    page = open_page("/pages/batches", width=360)
    page.locator("#file").set_input_files(file)
    page.get_by_text("Analysis and defaults").click()
    page.locator("#analysis").fill('{"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [4]}')
    page.get_by_role("button", name="Check the file").click()
    expect(page.locator("#checked")).to_contain_text("2 of 3 lines can be computed.")
    expect(page.locator("#checked li")).to_contain_text("Line 3")
    page.get_by_role("button", name="Compute the lines").click()
    page.wait_for_selector(".map", timeout=60_000)
    expect(page.locator("table.lines a")).to_have_count(2, timeout=60_000)
    expect(page.locator(".histogram")).to_have_count(2, timeout=60_000)
    assert page.evaluate("document.documentElement.scrollWidth - window.innerWidth") <= 0
    assert serious_faults(page) == []
    page.get_by_role("link", name="span of 140", exact=True).click()
    expect(page.locator(".verdict .answer")).to_have_text("It gallops")
