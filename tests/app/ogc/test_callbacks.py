"""What a subscriber is sent, from the stored results."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from uuid import UUID, uuid4

import httpx
import pytest
from sqlalchemy.orm import Session

from app.ogc import callbacks, documents
from app.runtime.settings import Settings
from app.storage.database import make_engine, session_factory
from app.storage.pages import Removed
from app.tables import DeliveryEvent, Job
from tests.app import service


@contextmanager
def opened(settings: Settings) -> Iterator[Session]:
    engine = make_engine(settings)
    with session_factory(engine)() as session:
        yield session
    engine.dispose()


def test_small_results_are_sent_whole_and_large_ones_by_their_address(
    own_client: httpx.Client, own_settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    job = UUID(service.finished(own_client, own_settings).rpartition("/")[2])
    with opened(own_settings) as session:
        whole = callbacks.body(session, job, DeliveryEvent.SUCCEEDED, "/gal")
        monkeypatch.setattr(callbacks, "LARGEST", 1000)
        referred = callbacks.body(session, job, DeliveryEvent.SUCCEEDED, "/gal")
    assert whole is not None
    assert json.loads(whole) == own_client.get(f"/ogc/jobs/{job}/results").json()
    assert referred is not None
    assert json.loads(referred) == {"result": {"href": f"/gal/ogc/jobs/{job}/results", "type": "application/json"}}


def test_results_that_are_removed_while_they_are_read_are_not_sent(
    own_client: httpx.Client, own_settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    job = UUID(service.finished(own_client, own_settings).rpartition("/")[2])
    read = documents.results

    def removed_under_way(session: Session, found: Job, *, raw: bool) -> Iterator[str]:
        yield next(iter(read(session, found, raw=raw)))
        raise Removed

    monkeypatch.setattr(documents, "results", removed_under_way)
    with opened(own_settings) as session:
        assert callbacks.body(session, job, DeliveryEvent.SUCCEEDED, "") is None


def test_a_status_has_links_under_the_prefix_and_a_removed_job_has_none(
    own_client: httpx.Client, own_settings: Settings
) -> None:
    job = UUID(service.finished(own_client, own_settings).rpartition("/")[2])
    with opened(own_settings) as session:
        status = callbacks.body(session, job, DeliveryEvent.STARTED, "/gal")
        assert callbacks.body(session, uuid4(), DeliveryEvent.SUCCEEDED, "") is None
    assert status is not None
    found = json.loads(status)
    assert found["status"] == "successful"
    assert {link["href"].split("/")[1] for link in found["links"]} == {"gal"}
