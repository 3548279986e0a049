"""Pages of a service with keys: each owner's jobs and batches are there for that owner, and not there for others."""

import json
from collections.abc import Iterator
from uuid import UUID

import httpx
import pytest

from app.reference.source_lines import example
from app.runtime.settings import Settings
from app.security import keys
from app.security.caller import Scope
from app.storage.database import make_engine, session_factory
from tests.app import service
from tests.app.lines import SHORT
from tests.app.pages.reading import BROWSER, read, send
from tests.in_process import run_job

READ = (
    "{job}",
    "{job}/curves",
    "{job}/motion",
    "{job}/what-if",
    "{job}/report",
    "{job}/report.pdf",
    "{batch}",
    "{batch}/progress",
    "{batch}/results?format=csv",
    "{batch}/lines/1",
    "/pages/lines/new?job={id}",
)
SENT = ("{job}/what-if/curves", "{job}/what-if", "{job}/remedies", "{job}/again", "{job}/cancel", "{batch}/cancel")


@pytest.fixture(scope="module")
def shared_settings(tmp_path_factory: pytest.TempPathFactory) -> Settings:
    """Give settings of this file's own: its keys would close the service that other tests share."""
    return service.sqlite_settings(tmp_path_factory.mktemp("owners"), preview_seconds=60.0, max_body_bytes=20_000)


@pytest.fixture(scope="module")
def shared_client(shared_settings: Settings) -> Iterator[httpx.Client]:
    """Give a client of that service."""
    with service.running(shared_settings) as client:
        yield client


@pytest.fixture(scope="module")
def places(shared_client: httpx.Client, shared_settings: Settings) -> dict[str, str]:
    """Give the paths of a finished job and batch of the owner north, and keys of north and south."""
    engine = make_engine(shared_settings)
    with session_factory(engine).begin() as session:
        made = {owner: keys.create(session, owner, tuple(Scope), None, None)[1] for owner in ("north", "south")}
    engine.dispose()
    head = {"Authorization": f"Bearer {made['north']}"}
    document = {"line": example("c11-twin"), "analysis": SHORT}
    job = shared_client.post("/v1/jobs", json=document, headers=head).raise_for_status().json()["id"]
    lines = "\n".join(map(json.dumps, [{"analysis": SHORT}, example("c11-single")]))
    kind = {**head, "Content-Type": "application/x-ndjson"}
    batch = shared_client.post("/v1/batches", content=lines, headers=kind).raise_for_status().json()["id"]
    query = {"batch_id": batch}
    chunks = shared_client.get("/v1/jobs", params=query, headers=head).raise_for_status().json()["jobs"]
    for one in (job, *(chunk["id"] for chunk in chunks)):
        run_job(shared_settings, UUID(one))
    return {"id": job, "job": f"/pages/jobs/{job}", "batch": f"/pages/batches/{batch}", **made}


def signed_in(client: httpx.Client, key: str) -> None:
    client.cookies.clear()
    assert send(client, "/pages/sign-in", {"key": key}, "/pages/sign-in").status_code == 303


@pytest.mark.parametrize("path", READ)
def test_a_page_is_there_for_its_owner_alone(shared_client: httpx.Client, places: dict[str, str], path: str) -> None:
    address = path.format(**places)
    signed_in(shared_client, places["north"])
    assert shared_client.get(address, headers=BROWSER, timeout=60.0).status_code in {200, 303}
    signed_in(shared_client, places["south"])
    assert shared_client.get(address, headers=BROWSER).status_code == 404
    shared_client.cookies.clear()
    assert shared_client.get(address, headers=BROWSER).headers["location"].startswith("/pages/sign-in?back=")


@pytest.mark.parametrize("path", SENT)
def test_a_form_is_taken_from_its_owner_alone(shared_client: httpx.Client, places: dict[str, str], path: str) -> None:
    address = path.format(**places)
    signed_in(shared_client, places["south"])
    answer = send(shared_client, address, {"remove": "yes"})
    # A job that is not there needs no cancelling, as after a second click.
    assert answer.status_code == 404 or answer.headers["location"] == "/pages/jobs"
    signed_in(shared_client, places["north"])
    assert read(shared_client, address[: address.rindex("/")].removesuffix("/what-if")).status == 200
    if path.endswith("curves"):
        assert send(shared_client, address, {}).status_code == 200


def test_lists_hold_what_is_ones_own(shared_client: httpx.Client, places: dict[str, str]) -> None:
    for owner, seen in (("north", True), ("south", False)):
        signed_in(shared_client, places[owner])
        assert (places["job"] in read(shared_client, "/pages/jobs").addresses) is seen
        assert (places["batch"] in read(shared_client, "/pages/batches").addresses) is seen


def test_a_session_sends_a_file_and_its_batch_is_ones_own(shared_client: httpx.Client, places: dict[str, str]) -> None:
    signed_in(shared_client, places["south"])
    head = {"Content-Type": "application/x-ndjson", "X-Form-Mark": read(shared_client, "/pages/batches").fields["mark"]}
    lines = "\n".join(map(json.dumps, [{"analysis": SHORT}, *[example("c11-single")] * 40]))
    assert len(lines) > 20_000  # the limit of batches counts, not that of other bodies
    made = shared_client.post("/pages/batches/file", content=lines, headers=head).raise_for_status().json()["id"]
    assert read(shared_client, f"/pages/batches/{made}").status == 200
    signed_in(shared_client, places["north"])
    assert read(shared_client, f"/pages/batches/{made}").status == 404
    other = shared_client.post("/pages/batches/file", content=lines, headers=head)
    assert other.status_code == 403  # the mark is of the other owner's page
