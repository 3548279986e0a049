from datetime import UTC, datetime, timedelta
from itertools import pairwise
from pathlib import Path
from typing import Any
from uuid import UUID

import httpx
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import leases
from app.reference.source_lines import example
from app.runtime.settings import Settings
from app.storage.database import make_engine, session_factory
from tests.app import service
from tests.documents import short_request


def labelled(**changes: Any) -> dict[str, Any]:
    return {**short_request(), "line": {**example("c11-twin"), **changes}}


def running_job(sessions: sessionmaker[Session], job: dict[str, Any]) -> None:
    with sessions.begin() as session:
        assert leases.claim(session, UUID(job["id"]), "test", 30.0)


def test_a_posted_job_is_accepted_with_its_address(client: httpx.Client) -> None:
    answer = client.post("/v1/jobs", json=labelled(asset_id="L1", tags={"region": "north", "kv": "400"}))
    assert answer.status_code == 202
    status = answer.json()
    assert answer.headers["location"] == f"/v1/jobs/{status['id']}"
    assert int(answer.headers["retry-after"]) >= 1
    assert (status["status"], status["progress"], status["attempt"]) == ("accepted", 0.0, 0)
    assert (status["name"], status["asset_id"]) == ("C11 twin, 126 m", "L1")
    assert status["tags"] == {"region": "north", "kv": "400"}
    assert client.get(answer.headers["location"]).json() == status


def test_a_job_runs_to_its_end(client: httpx.Client, settings: Settings) -> None:
    status = client.get(service.finished(client, settings)).json()
    assert (status["status"], status["progress"], status["attempt"]) == ("successful", 1.0, 1)
    assert status["created_at"] <= status["started_at"] <= status["finished_at"]
    taken = datetime.fromisoformat(status["finished_at"]) - datetime.fromisoformat(status["started_at"])
    assert status["duration_seconds"] == taken.total_seconds()
    assert status["failure"] is None
    links = {link["rel"]: link["href"] for link in status["links"]}
    assert set(links) >= {"self", "results", "frequencies", "critical-wind-speeds", "limit-cycles", "amplitude-plot"}
    assert {client.get(href).status_code for href in links.values()} == {200}


def test_a_request_may_be_checked_without_a_job(client: httpx.Client) -> None:
    for address in ("/v1/jobs?validate_only=true", "/v1/jobs/estimate"):
        answer = client.post(address, json=short_request())
        estimate = answer.json()
        assert (answer.status_code, estimate["valid"], estimate["points"]) == (200, True, 1)
        assert 0.0 < estimate["seconds"] < 1.0
        wrong = client.post(address, json=labelled(span={}))
        assert (wrong.status_code, wrong.json()["errors"][0]["code"]) == (422, "missing")
    assert client.get("/v1/jobs").json()["jobs"] == []


def test_only_a_job_that_has_not_ended_asks_to_look_again(client: httpx.Client, settings: Settings) -> None:
    waiting = service.submit(client)
    assert "retry-after" in client.get(f"/v1/jobs/{waiting['id']}").headers
    assert "retry-after" not in client.get(service.finished(client, settings)).headers


def test_pages_hold_every_job_once_newest_first(client: httpx.Client) -> None:
    made = [service.submit(client)["id"] for _ in range(7)]
    seen: list[str] = []
    address: str | None = "/v1/jobs?limit=3"
    sizes = []
    while address:
        page = client.get(address).json()
        seen += [job["id"] for job in page["jobs"]]
        sizes.append(len(page["jobs"]))
        address = page["next"]
    assert seen == made[::-1]
    assert sizes == [3, 3, 1]


def test_jobs_made_meanwhile_do_not_move_a_page(client: httpx.Client) -> None:
    made = [service.submit(client)["id"] for _ in range(4)]
    first = client.get("/v1/jobs?limit=2").json()
    service.submit(client)
    second = client.get(first["next"]).json()
    assert [job["id"] for job in first["jobs"] + second["jobs"]] == made[::-1]


def test_filters_are_kept_on_the_next_page(client: httpx.Client) -> None:
    wanted = [service.submit(client, labelled(tags={"region": "north", "kv": "400"}))["id"] for _ in range(3)]
    service.submit(client, labelled(tags={"region": "north"}))
    service.submit(client, labelled(tags={"region": "south", "kv": "400"}))
    first = client.get("/v1/jobs?tag=region:north&tag=kv:400&limit=2").json()
    second = client.get(first["next"]).json()
    assert [job["id"] for job in first["jobs"] + second["jobs"]] == wanted[::-1]
    assert second["next"] is None


def test_a_tag_may_hold_colons_in_its_value(client: httpx.Client) -> None:
    job = service.submit(client, labelled(tags={"site": "a:b&c=d"}))
    found = client.get("/v1/jobs", params={"tag": "site:a:b&c=d"}).json()["jobs"]
    assert [item["id"] for item in found] == [job["id"]]


def test_accents_are_found_in_either_form(client: httpx.Client) -> None:
    composed, decomposed = "Br\u00e5l\u00f8s", "Bra\u030al\u00f8s"
    job = service.submit(client, labelled(asset_id=decomposed, tags={"site": decomposed}))
    assert (job["asset_id"], job["tags"]) == (composed, {"site": composed})
    for text in (composed, decomposed):
        for query in ({"asset_id": text}, {"tag": f"site:{text}"}):
            assert [item["id"] for item in client.get("/v1/jobs", params=query).json()["jobs"]] == [job["id"]]


def test_jobs_are_found_by_asset_status_and_time(
    client: httpx.Client, settings: Settings, sessions: sessionmaker[Session]
) -> None:
    first = service.submit(client, labelled(asset_id="L1"))
    second = service.submit(client, labelled(asset_id="L2"))
    running_job(sessions, second)

    def found(**query: str) -> list[str]:
        return [job["id"] for job in client.get("/v1/jobs", params=query).json()["jobs"]]

    assert found(asset_id="L1") == [first["id"]]
    assert found(asset_id="L3") == []
    assert found(status="accepted") == [first["id"]]
    assert found(status="running") == [second["id"]]
    assert found(created_after=first["created_at"]) == [second["id"]]
    assert found(created_before=second["created_at"]) == [first["id"]]
    assert found(created_after=(datetime.now(UTC) + timedelta(hours=1)).isoformat()) == []


def test_a_cursor_of_another_service_is_refused(client: httpx.Client, tmp_path: Path) -> None:
    for _ in range(2):
        service.submit(client)
    address = client.get("/v1/jobs?limit=1").json()["next"]
    assert client.get(address).status_code == 200
    with service.running(service.sqlite_settings(tmp_path / "other")) as other:
        assert other.get(address).status_code == 400


def test_a_queued_job_is_cancelled_at_once(client: httpx.Client) -> None:
    job = service.submit(client)
    answer = client.delete(f"/v1/jobs/{job['id']}")
    assert answer.status_code == 200
    assert answer.json()["status"] == "dismissed"
    assert client.get(f"/v1/jobs/{job['id']}").json()["status"] == "dismissed"


def test_a_running_job_is_asked_to_stop(client: httpx.Client, sessions: sessionmaker[Session]) -> None:
    job = service.submit(client)
    running_job(sessions, job)
    answer = client.delete(f"/v1/jobs/{job['id']}")
    assert answer.status_code == 202
    assert (answer.json()["status"], answer.json()["cancel_requested"]) == ("running", True)
    assert "retry-after" in answer.headers


def test_an_ended_job_is_removed_with_its_results(client: httpx.Client, settings: Settings) -> None:
    address = service.finished(client, settings)
    answer = client.delete(address)
    assert (answer.status_code, answer.content) == (204, b"")
    assert client.get(address).status_code == 404
    assert client.get(f"{address}/results").status_code == 404
    assert client.delete(address).status_code == 404


def test_a_job_is_accepted_while_the_broker_is_away(settings: Settings) -> None:
    away = settings.model_copy(update={"broker_url": "redis://127.0.0.1:9/0", "broker_timeout_seconds": 0.3})
    with service.running(away) as client:
        job = service.submit(client)
        assert client.get(f"/v1/jobs/{job['id']}").json()["status"] == "accepted"


def test_what_is_kept_holds_the_defaults_that_were_used(client: httpx.Client, settings: Settings) -> None:
    job = service.submit(client, {"line": example("c11-twin")})
    engine = make_engine(settings)
    with session_factory(engine)() as session:
        held = leases.claim(session, UUID(job["id"]), "test", 30.0)
    engine.dispose()
    assert held is not None
    assert held.document["analysis"]["closure"] == "exact"
    assert held.document["line"]["wind"]["air_density_kg_per_m3"] == 1.2929
    assert "study" not in held.document


def test_newer_jobs_have_larger_ids(client: httpx.Client) -> None:
    made = [service.submit(client)["id"] for _ in range(3)]
    assert all(a < b for a, b in pairwise(made))


def test_cancelling_never_removes_and_removing_never_cancels(client: httpx.Client, settings: Settings) -> None:
    waiting, address = service.submit(client), service.finished(client, settings)
    assert client.delete(f"/v1/jobs/{waiting['id']}?if_ended=true").status_code == 409
    kept = client.post(f"{address}/cancel", headers={"Idempotency-Key": "once"})
    assert (kept.status_code, kept.json()["status"]) == (200, "successful")
    assert (
        client.post(f"{address}/cancel", headers={"Idempotency-Key": "once"}).headers["idempotency-replayed"] == "true"
    )
    assert client.get(f"{address}/results").status_code == 200
    cancelled = client.post(f"/v1/jobs/{waiting['id']}/cancel")
    assert (cancelled.status_code, cancelled.json()["status"]) == (200, "dismissed")
    assert client.delete(f"{address}?if_ended=true").status_code == 204
    assert client.post(f"{address}/cancel").status_code == 404
    running = service.submit(client)
    engine = make_engine(settings)
    running_job(session_factory(engine), running)
    engine.dispose()
    asked = client.post(f"/v1/jobs/{running['id']}/cancel")
    assert (asked.status_code, asked.json()["cancel_requested"]) == (202, True)
