import httpx
import pytest

from app.pages.views import jobs
from tests.app import service
from tests.app.pages.reading import Page, read
from tests.documents import short_request


def test_jobs_are_listed_a_page_at_a_time(own_client: httpx.Client) -> None:
    names = [service.submit(own_client)["id"] for _ in range(3)]
    page = read(own_client, "/pages/jobs")
    assert [f"/pages/jobs/{name}" for name in reversed(names)] == [
        address for address in page.addresses if address.startswith("/pages/jobs/")
    ]
    assert own_client.get("/pages/jobs?cursor=forged").status_code == 400


def listed(page: Page) -> list[str]:
    return [address.rpartition("/")[2] for address in page.addresses if address.startswith("/pages/jobs/")]


def test_jobs_are_found_by_their_tags_asset_and_state(own_client: httpx.Client) -> None:
    def made(asset: str, tags: dict[str, str]) -> str:
        line = {**short_request()["line"], "asset_id": asset, "tags": tags}
        return str(service.submit(own_client, {**short_request(), "line": line})["id"])

    north = made("L1", {"region": "north", "crew": "7 & 8"})
    south = made("L2", {"region": "south"})
    own_client.delete(f"/v1/jobs/{south}")
    page = read(own_client, "/pages/jobs")
    assert "region: north" in page.text and "crew: 7 & 8" in page.text
    assert "/pages/jobs?tag=crew%3A7+%26+8" in page.addresses
    for query, expected in {
        "tag=region:north": [north],
        "tag=crew%3A7%20%26%208": [north],
        "tag=region": [south, north],
        "tag=north": [],
        "asset_id=L2": [south],
        "status=dismissed": [south],
        "status=dismissed&tag=region:north": [],
        "status=": [south, north],
    }.items():
        assert listed(read(own_client, f"/pages/jobs?{query}")) == expected, query
    assert "No job is like that" in read(own_client, "/pages/jobs?tag=north").text


def test_the_next_page_keeps_the_filters(own_client: httpx.Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jobs, "_ON_PAGE", 1)
    names = [service.submit(own_client)["id"] for _ in range(2)]
    service.submit(own_client, {**short_request(), "line": {**short_request()["line"], "tags": {}}})
    page = read(own_client, "/pages/jobs?tag=source:c11")
    (older,) = [address for address in page.addresses if "cursor=" in address]
    assert [listed(page), listed(read(own_client, older))] == [[names[1]], [names[0]]]
