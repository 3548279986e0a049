import httpx
import pytest

from app.pages import assets


def test_scripts_are_below_300_kilobytes_in_all() -> None:
    assert 100_000 < assets.script_bytes() < 300_000


@pytest.mark.parametrize("name", ["own/site.css", "own/site.js", "htmx/htmx.min.js", "uplot/uPlot.iife.min.js"])
def test_a_file_may_be_kept_under_the_address_that_names_its_content(shared_client: httpx.Client, name: str) -> None:
    address = assets.address(name)
    kept = shared_client.get(address)
    assert kept.status_code == 200
    assert kept.headers["cache-control"] == "public, max-age=31536000, immutable"
    assert shared_client.get(address.partition("?")[0]).headers["cache-control"] == "no-cache"


def test_addresses_in_styles_and_scripts_stay_in_the_service(shared_client: httpx.Client) -> None:
    for name in ("own/site.css", "own/site.js", "own/chart.js", "own/progress.js", "uplot/uPlot.min.css"):
        text = shared_client.get(assets.address(name)).text
        assert [part for part in text.split('"') if part.startswith("http") and "www.w3.org" not in part] == []
        assert "url(" not in text


def test_a_file_that_is_not_there_is_a_defect() -> None:
    with pytest.raises(OSError, match="no-such-file"):
        assets.address("own/no-such-file.js")
