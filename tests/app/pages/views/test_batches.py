import json
from typing import Any

import httpx
import pytest

from app.reference.source_lines import example
from app.runtime.settings import Settings
from tests.app import service
from tests.app.lines import SHORT, changed
from tests.app.pages.reading import read, send

TWIN = example("c11-twin")
LINES = [
    {**changed("span.length_m", length, TWIN), "name": f"span of {length:g}", "tags": {"half": half}}
    for length, half in ((100.0, "west"), (140.0, "east"), (-5.0, "east"))
]
PLACES = [[[10.0, 60.0], [10.002, 60.0]], [[10.002, 60.0], [10.004, 60.001]], [[10.0, 60.0], [10.0, 60.1]]]
FILE = {
    "type": "FeatureCollection",
    "features": [
        {"type": "Feature", "geometry": {"type": "LineString", "coordinates": places}, "properties": line}
        for line, places in zip(LINES, PLACES, strict=True)
    ],
}


def posted(client: httpx.Client, **query: str) -> httpx.Response:
    head = {"Content-Type": "application/geo+json", "X-Form-Mark": read(client, "/").fields["mark"]}
    query = {"analysis": json.dumps(SHORT), **query}
    return client.post("/pages/batches/file", params=query, headers=head, content=json.dumps(FILE))


@pytest.fixture(scope="module")
def batch(shared_client: httpx.Client, shared_settings: Settings) -> str:
    """Give the path of the page of a finished batch."""
    answer: dict[str, Any] = posted(shared_client).raise_for_status().json()
    service.work_off(shared_client, shared_settings, f"/v1/batches/{answer['id']}")
    return f"/pages/batches/{answer['id']}"


def test_a_file_is_checked_before_it_is_sent(shared_client: httpx.Client) -> None:
    found = posted(shared_client, validate_only="true").json()
    assert (found["total"], found["rejected"]) == (3, 1)
    assert found["errors"][0]["number"] == 3
    body = json.dumps(FILE)
    head = {"Content-Type": "application/geo+json"}
    assert shared_client.post("/pages/batches/file", headers=head, content=body).status_code == 403


def test_a_batch_shows_its_lines_their_spread_and_their_places(shared_client: httpx.Client, batch: str) -> None:
    page = read(shared_client, batch)
    assert "3 of 3 lines are shown" in page.text
    assert (
        page.text.index("greater than or equal to 1") < page.text.index("span of 140") < page.text.index("span of 100")
    )
    assert "Vertical, peak to peak: bars over 2 lines" in page.text
    assert "Where the lines stand" in page.text
    assert f"{batch}/lines/1" in page.addresses
    assert f"{batch}/lines/3" not in [address for address in page.addresses if "/results" in address]
    for address in (address for address in page.addresses if "/results?format=" in address):
        assert shared_client.get(address).status_code == 200, address
    assert batch in read(shared_client, "/pages/batches").addresses


def test_lines_are_filtered_by_answer_and_name(shared_client: httpx.Client, batch: str) -> None:
    assert "1 of 1 lines are shown" in read(shared_client, f"{batch}?name=of+140").text
    assert "2 of 2 lines are shown" in read(shared_client, f"{batch}?gallops=yes").text
    assert "0 of 0 lines are shown" in read(shared_client, f"{batch}?gallops=undecided").text


def test_lines_are_filtered_by_a_tag_and_only_they_are_exported(shared_client: httpx.Client, batch: str) -> None:
    page = read(shared_client, f"{batch}?tag=half:west")
    assert "1 of 1 lines are shown" in page.text
    assert page.fields["tag"] == "half:west"
    assert "Rejected lines are kept without their tags" in page.text
    files = [address for address in page.addresses if address.startswith(f"{batch}/results?")]
    assert len(files) == 5
    for address in files:
        assert "tag=half%3Awest" in address
        assert shared_client.get(address).status_code == 200, address
    names = {line.split(",")[3] for line in shared_client.get(files[0]).text.splitlines()}
    assert names == {"name", "span of 100"}
    rest = shared_client.get(f"{batch}/results?format=ndjson&tag=half:east").text.splitlines()
    assert [json.loads(line)["number"] for line in rest] == [2]
    assert shared_client.get(f"{batch}/results?format=doc").status_code == 400


def test_a_line_leads_to_its_result(shared_client: httpx.Client, batch: str) -> None:
    answer = shared_client.get(f"{batch}/lines/2")
    assert answer.status_code == 303
    page = read(shared_client, answer.headers["location"])
    assert "span of 140" in page.text
    assert batch in page.addresses
    assert shared_client.get(f"{batch}/lines/3").status_code == 404
    assert shared_client.get(f"{batch}/lines/9").status_code == 404


def test_progress_ends_with_the_whole_page_and_a_batch_is_removed(shared_client: httpx.Client) -> None:
    waiting = f"/pages/batches/{posted(shared_client).json()['id']}"
    answer = shared_client.get(f"{waiting}/progress")
    assert "every 2s" in answer.text
    assert send(shared_client, f"{waiting}/cancel", {}).headers["location"] == waiting
    assert shared_client.get(f"{waiting}/progress").headers["HX-Refresh"] == "true"
    assert send(shared_client, f"{waiting}/cancel", {}).headers["location"] == waiting  # never removed by chance
    gone = send(shared_client, f"{waiting}/cancel", {"remove": "yes"})
    assert gone.headers["location"] == "/pages/batches"
    assert shared_client.get(waiting).status_code == 404


def test_a_batch_shows_its_name_and_its_tags_on_its_page_and_in_the_list(shared_client: httpx.Client) -> None:
    batch = posted(shared_client).json()["id"]
    labels = {"name": "Winter check", "tags": {"region": "north"}}
    shared_client.patch(f"/v1/batches/{batch}", json=labels).raise_for_status()
    shown = read(shared_client, f"/pages/batches/{batch}").text
    assert "Winter check Batch of" in shown
    assert "region north" in shown
    assert "Winter check region: north" in read(shared_client, "/pages/batches").text
