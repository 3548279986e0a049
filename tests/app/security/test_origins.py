import json
from collections.abc import Iterator

import httpx
import pytest

from app.runtime.settings import Settings
from tests.app import service
from tests.app.pages.reading import BROWSER, read
from tests.documents import short_request

STRANGE = {
    "another site": {"Origin": "https://evil.example", "Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "no-cors"},
    "another port of this machine": {"Origin": "http://127.0.0.1:1", "Sec-Fetch-Site": "same-site"},
    "a browser without fetch metadata": {"Origin": "https://evil.example"},
    "a page without an origin": {"Origin": "null"},
    "a form that is submitted": {
        "Sec-Fetch-Site": "cross-site",
        "Sec-Fetch-Mode": "navigate",
        "Sec-Fetch-Dest": "document",
    },
}


@pytest.fixture(scope="module")
def client(shared_client: httpx.Client) -> httpx.Client:
    return shared_client


@pytest.mark.parametrize("name", STRANGE)
@pytest.mark.parametrize("media_type", ["text/plain", "application/json", "application/x-www-form-urlencoded"])
def test_a_page_of_another_site_changes_nothing_without_keys(client: httpx.Client, name: str, media_type: str) -> None:
    before = len(client.get("/v1/jobs").json()["jobs"])
    headers = {**STRANGE[name], "Content-Type": media_type}
    answer = client.post("/v1/jobs", content=json.dumps(short_request()).encode(), headers=headers)
    assert answer.status_code == 403
    assert "another site" in answer.json()["detail"]
    assert client.post("/v1/jobs/1/cancel", headers=STRANGE[name]).status_code == 403
    assert len(client.get("/v1/jobs").json()["jobs"]) == before


@pytest.mark.parametrize(
    "headers",
    [
        {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "no-cors", "Sec-Fetch-Dest": "image"},
        {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "iframe"},
        {"Sec-Fetch-Site": "same-site", "Sec-Fetch-Mode": "cors", "Sec-Fetch-Dest": "empty"},
        {"Origin": "https://evil.example"},
    ],
)
def test_a_page_of_another_site_reads_nothing_without_keys(client: httpx.Client, headers: dict[str, str]) -> None:
    assert client.get("/v1/jobs", headers=headers).status_code == 403


def test_programs_own_pages_and_persons_go_on_without_keys(client: httpx.Client) -> None:
    own = str(client.base_url).rstrip("/")
    for headers in (
        {},
        {"Sec-Fetch-Site": "none", "Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"},
        {"Sec-Fetch-Site": "same-origin", "Sec-Fetch-Mode": "cors"},
        {"Origin": own},
        {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"},  # a link
    ):
        assert client.get("/v1/jobs", headers=headers).status_code == 200, headers
    assert client.post("/v1/jobs", json=short_request(), headers={"Origin": own}).status_code == 202
    # A page whose policy is `no-referrer` sends its forms so.
    form = {"Origin": "null", "Sec-Fetch-Site": "same-origin"}
    assert client.post("/v1/jobs", json=short_request(), headers=form).status_code == 202


def test_origins_that_the_operator_names_are_admitted(own_settings: Settings) -> None:
    settings = own_settings.model_copy(update={"cors_origins": ("https://grid.example",)})
    with service.running(settings) as client:
        for origin, status in (("https://grid.example", 202), ("https://evil.example", 403)):
            headers = {"Origin": origin, "Sec-Fetch-Site": "cross-site"}
            assert client.post("/v1/jobs", json=short_request(), headers=headers).status_code == status


@pytest.fixture(scope="module")
def mark(client: httpx.Client) -> Iterator[str]:
    yield read(client, "/").fields["mark"]


def test_forms_are_taken_from_own_pages_only(client: httpx.Client, mark: str) -> None:
    for site, statuses in (("same-origin", {303}), ("cross-site", {403}), ("same-site", {403})):
        answer = client.post(
            "/pages/examples/c11-twin", data={"mark": mark}, headers={**BROWSER, "Sec-Fetch-Site": site}
        )
        assert answer.status_code in statuses, site
