"""Webhooks from the end of a job to a real receiver with TLS on loopback, on either database."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from uuid import UUID

import httpx
import pytest
from prometheus_client.parser import text_string_to_metric_families
from sqlalchemy.orm import Session, sessionmaker
from standardwebhooks import Webhook

from app.jobs import webhooks
from app.runtime.settings import Settings
from app.security import keys
from app.security.caller import Scope
from app.storage.database import make_engine, session_factory
from tests.app import service
from tests.app.lines import SHORT
from tests.documents import short_request
from tests.in_process import run_job
from tests.receivers import Receiver, receiver
from tests.servers import wait_until
from worker.courier import courier

MOST_TO_ONE_RECEIVER = 4


@pytest.fixture
def received(tmp_path: Path) -> Iterator[tuple[Receiver, Path]]:
    """Give a receiver and the file of its authority."""
    with receiver(tmp_path) as made:
        yield made


@pytest.fixture
def open_settings(settings: Settings, received: tuple[Receiver, Path]) -> Settings:
    """Give settings that let webhooks go to loopback, with short times."""
    times = {"webhook_retry_seconds": 0.05, "webhook_timeout_seconds": 10.0, "webhook_attempts": 3}
    return settings.model_copy(update={**times, "webhook_private_networks": True, "webhook_ca_file": received[1]})


@pytest.fixture
def client(open_settings: Settings) -> Iterator[httpx.Client]:
    """Give a client of a service whose webhooks may go to loopback."""
    with service.running(open_settings) as running:
        yield running


def ended(client: httpx.Client, settings: Settings, url: str) -> str:
    return service.finished(client, settings, {**short_request(), "webhook_url": url})


def delivery(client: httpx.Client, address: str) -> dict[str, Any]:
    (found,) = client.get(f"{address}/deliveries").json()["deliveries"]
    assert isinstance(found, dict)
    return found


def wait_for(client: httpx.Client, address: str, state: str) -> dict[str, Any]:
    wait_until(lambda: delivery(client, address)["state"] == state, what=f"a delivery that is {state}")
    return delivery(client, address)


def counted(client: httpx.Client) -> dict[str, float]:
    """Return what the metrics tell of webhooks."""
    text = client.get("/metrics", headers={"Accept": "text/plain"}).text
    samples = [sample for family in text_string_to_metric_families(text) for sample in family.samples]
    attempts = {sample.labels["outcome"]: sample.value for sample in samples if "webhook_attempts" in sample.name}
    named = {sample.name: sample.value for sample in samples}
    given_up, pending = named["galloping_webhooks_given_up_total"], named["galloping_webhooks_pending"]
    return {**attempts, "given_up": given_up, "pending": pending}


def test_the_end_of_a_job_is_told_signed_and_logged(
    client: httpx.Client,
    open_settings: Settings,
    sessions: sessionmaker[Session],
    received: tuple[Receiver, Path],
) -> None:
    got = received[0].got
    address = ended(client, open_settings, received[0].url)
    assert delivery(client, address)["state"] == "waiting"
    with sessions.begin() as session:
        webhooks.enlist(session)
    assert counted(client) == {"delivered": 0.0, "refused": 0.0, "no_answer": 0.0, "given_up": 0.0, "pending": 1.0}
    with courier(sessions, open_settings):
        told = wait_for(client, address, "delivered")
        assert [entry["status_code"] for entry in told["attempts"]] == [200]
        headers, body = got[0]
        secret = client.get("/v1/webhooks/secret").json()["secret"]
        message = Webhook(secret).verify(body, headers)
        assert message["type"] == "job.successful"
        assert message["data"]["href"] == address
        assert headers["webhook-id"] == told["id"]
        assert headers["host"] == received[0].url.split("/")[2]
        twice = [client.post(f"{address}/deliveries", headers={"Idempotency-Key": "again"}) for _ in range(2)]
        assert [answer.status_code for answer in twice] == [202, 202]
        assert twice[1].headers["idempotency-replayed"] == "true"
        wait_until(lambda: len(got) == 2, what="the second delivery")
        assert (got[1][0]["webhook-id"], got[1][1]) == (told["id"], body)
        wait_until(lambda: counted(client)["delivered"] == 2.0, what="two attempts in the metrics")
    assert counted(client) == {"delivered": 2.0, "refused": 0.0, "no_answer": 0.0, "given_up": 0.0, "pending": 0.0}


def test_a_receiver_at_fault_is_tried_again_until_it_is_given_up(
    client: httpx.Client,
    open_settings: Settings,
    sessions: sessionmaker[Session],
    received: tuple[Receiver, Path],
) -> None:
    received[0].status = 500
    address = ended(client, open_settings, received[0].url)
    with courier(sessions, open_settings):
        told = wait_for(client, address, "failed")
    assert [entry["status_code"] for entry in told["attempts"]] == [500, 500, 500]
    assert counted(client) == {"delivered": 0.0, "refused": 3.0, "no_answer": 0.0, "given_up": 1.0, "pending": 0.0}


def test_a_receiver_that_is_gone_is_not_tried_again(
    client: httpx.Client,
    open_settings: Settings,
    sessions: sessionmaker[Session],
    received: tuple[Receiver, Path],
) -> None:
    received[0].status = 410
    address = ended(client, open_settings, received[0].url)
    with courier(sessions, open_settings):
        told = wait_for(client, address, "failed")
    assert [entry["status_code"] for entry in told["attempts"]] == [410]
    assert counted(client)["given_up"] == 1.0


def test_a_redirect_is_not_followed(
    client: httpx.Client,
    open_settings: Settings,
    sessions: sessionmaker[Session],
    received: tuple[Receiver, Path],
    tmp_path: Path,
) -> None:
    (tmp_path / "other").mkdir()
    with receiver(tmp_path / "other") as (other, _):
        received[0].status, received[0].location = 307, other.url
        address = ended(client, open_settings, received[0].url)
        with courier(sessions, open_settings):
            told = wait_for(client, address, "failed")
    assert {entry["status_code"] for entry in told["attempts"]} == {307}
    assert (len(received[0].got), other.got) == (3, [])


def test_a_receiver_that_hangs_holds_up_no_other(
    client: httpx.Client,
    open_settings: Settings,
    sessions: sessionmaker[Session],
    received: tuple[Receiver, Path],
) -> None:
    received[0].go_on.clear()
    slow = [ended(client, open_settings, received[0].url) for _ in range(8)]
    port = int(received[0].url.split(":")[2].split("/")[0])
    quick = ended(client, open_settings, f"https://localhost:{port + 1 if port < 65535 else port - 1}/refuses")
    patient = open_settings.model_copy(update={"webhook_timeout_seconds": 120.0})
    with courier(sessions, patient):
        wait_until(lambda: len(received[0].got) == MOST_TO_ONE_RECEIVER, what="those that hang")
        wait_until(lambda: delivery(client, quick)["attempts"] != [], what="the other's attempt")
        assert [delivery(client, address)["attempts"] for address in slow] == [[]] * 8
        assert len(received[0].got) == MOST_TO_ONE_RECEIVER
        received[0].go_on.set()
        for address in slow:
            wait_for(client, address, "delivered")


def test_a_receiver_gets_the_next_as_soon_as_it_has_taken_one(
    client: httpx.Client,
    open_settings: Settings,
    sessions: sessionmaker[Session],
    received: tuple[Receiver, Path],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("worker.courier._POLL_SECONDS", 600.0)
    count = 3 * MOST_TO_ONE_RECEIVER
    ends = [ended(client, open_settings, received[0].url) for _ in range(count)]
    with courier(sessions, open_settings):
        for address in ends:
            wait_for(client, address, "delivered")
    assert len(received[0].got) == count


def test_a_receiver_that_hangs_has_not_answered(
    client: httpx.Client,
    open_settings: Settings,
    sessions: sessionmaker[Session],
    received: tuple[Receiver, Path],
) -> None:
    received[0].go_on.clear()
    hasty = open_settings.model_copy(update={"webhook_timeout_seconds": 0.5})
    address = ended(client, open_settings, received[0].url)
    with courier(sessions, hasty):
        told = wait_for(client, address, "failed")
    assert [entry["error"] for entry in told["attempts"]] == ["no answer within 0.5 s"] * 3
    assert counted(client)["no_answer"] == 3.0


def test_the_address_is_vetted_again_at_each_delivery(
    client: httpx.Client,
    open_settings: Settings,
    sessions: sessionmaker[Session],
    received: tuple[Receiver, Path],
) -> None:
    address = ended(client, open_settings, received[0].url)
    closed = open_settings.model_copy(update={"webhook_private_networks": False})
    with courier(sessions, closed):
        told = wait_for(client, address, "failed")
    assert ["webhooks are not sent" in entry["error"] for entry in told["attempts"]] == [True] * 3
    assert received[0].got == []


def test_the_end_of_a_batch_is_told(
    client: httpx.Client,
    open_settings: Settings,
    sessions: sessionmaker[Session],
    received: tuple[Receiver, Path],
) -> None:
    body = {"lines": [short_request()["line"]] * 2, "analysis": SHORT, "webhook_url": received[0].url}
    address = client.post("/v1/batches", json=body).headers["location"]
    with courier(sessions, open_settings):
        for job in client.get("/v1/jobs", params={"batch_id": address[-36:]}).json()["jobs"]:
            run_job(open_settings, UUID(job["id"]))
        wait_for(client, address, "delivered")
    message = json.loads(received[0].got[0][1])
    assert (message["type"], message["data"]["lines"]["successful"]) == ("batch.successful", 2)


def subscribed(client: httpx.Client, url: str) -> str:
    """Execute by the standard, with every address of a subscriber, and return the address of the job under it."""
    subscriber = {"successUri": url, "inProgressUri": url, "failedUri": url}
    asked = {"inputs": short_request(), "subscriber": subscriber}
    answer = client.post("/ogc/processes/galloping/execution", json=asked, headers={"Prefer": "respond-async"})
    assert answer.status_code == 201, answer.text
    return answer.headers["Location"]


def states(client: httpx.Client, job: str) -> dict[str, str]:
    log = client.get(f"/v1/jobs/{job.rpartition('/')[2]}/deliveries").json()["deliveries"]
    return {entry["event"]: entry["state"] for entry in log}


def test_a_subscriber_of_the_standard_is_sent_the_beginning_and_the_results(
    client: httpx.Client, open_settings: Settings, received: tuple[Receiver, Path], sessions: sessionmaker[Session]
) -> None:
    job = subscribed(client, received[0].url)
    assert set(states(client, job).values()) == {"waiting"}
    run_job(open_settings, UUID(job.rpartition("/")[2]))
    expected = {"started": "delivered", "succeeded": "delivered", "failed": "not_needed"}
    with courier(sessions, open_settings):
        wait_until(lambda: states(client, job) == expected, what="both messages")
        again = client.post(f"/v1/jobs/{job.rpartition('/')[2]}/deliveries", headers={"Idempotency-Key": "again"})
        assert again.status_code == 202
        wait_until(lambda: len(received[0].got) == 4, what="both messages once more")
    secret = client.get("/v1/webhooks/secret").json()["secret"]
    told = [Webhook(secret).verify(body, headers) for headers, body in received[0].got]
    results = [message for message in told if "result" in message]
    assert results == [client.get(f"{job}/results").json()] * 2
    assert [message["jobID"] for message in told if "result" not in message] == [job.rpartition("/")[2]] * 2
    retried = client.post(f"/v1/jobs/{job.rpartition('/')[2]}/retry", headers={"Idempotency-Key": "retry"}).json()
    assert set(states(client, retried["id"])) == set(expected)


def test_a_subscriber_of_the_standard_hears_of_a_job_that_gives_no_results(
    client: httpx.Client, open_settings: Settings, received: tuple[Receiver, Path], sessions: sessionmaker[Session]
) -> None:
    job = subscribed(client, received[0].url)
    client.post(f"/v1/jobs/{job.rpartition('/')[2]}/cancel").raise_for_status()
    expected = {"started": "not_needed", "succeeded": "not_needed", "failed": "delivered"}
    with courier(sessions, open_settings):
        wait_until(lambda: states(client, job) == expected, what="the message")
    ((_, body),) = received[0].got
    assert json.loads(body)["status"] == "dismissed"


def test_private_addresses_are_refused_at_the_post(tmp_path: Path) -> None:
    body = {"lines": [short_request()["line"]], "analysis": SHORT}
    with service.running(service.sqlite_settings(tmp_path)) as closed:
        answer = closed.post("/v1/jobs", json={**short_request(), "webhook_url": "https://127.0.0.1/hook"})
        assert (answer.status_code, answer.json()["errors"][0]["pointer"]) == (422, "/webhook_url")
        for url in ("http://example.com/", "https://169.254.169.254/latest", 5):
            refused = closed.post("/v1/batches", json={**body, "webhook_url": url})
            assert (refused.status_code, refused.json()["errors"][0]["pointer"]) == (422, "/webhook_url")


def test_each_owner_has_a_secret_of_their_own(tmp_path: Path) -> None:
    settings = service.sqlite_settings(tmp_path)
    with service.running(settings) as client:
        engine = make_engine(settings)
        with session_factory(engine).begin() as session:
            made = [keys.create(session, owner, tuple(Scope), None, None)[1] for owner in ("a", "a", "b")]
        engine.dispose()
        first, same, other = (
            client.get("/v1/webhooks/secret", headers={"Authorization": f"Bearer {key}"}).json()["secret"]
            for key in made
        )
    assert first == same
    assert first != other
