"""Schemathesis over the whole OpenAPI document: no answer is a 5xx, and every answer is one that the document tells of.

Every case shows a good key, since without one the gate would be all that is tested. Half of the cases ask for a job and
a batch that there are, so that they reach what lies behind the 404.
"""

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import Any
from uuid import UUID

import httpx
import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from hypothesis.errors import Unsatisfiable
from schemathesis import Case, GenerationMode
from schemathesis.checks import CheckFunction, not_a_server_error
from schemathesis.core.result import Ok
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_headers_conformance,
    response_schema_conformance,
    status_code_conformance,
)
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.main import create_app
from app.runtime.settings import Settings
from app.security import keys
from app.security.caller import Scope
from app.storage.database import make_engine, session_factory
from app.tables import Job
from tests.app import service
from tests.documents import short_request
from tests.faults import figures
from tests.in_process import run_job

CASES_AN_OPERATION = 6
CHECKS: list[CheckFunction] = [
    not_a_server_error,
    status_code_conformance,
    content_type_conformance,
    response_headers_conformance,
    response_schema_conformance,
]


@dataclass(frozen=True)
class Served:
    """A running service, its document, and the ids of what it holds."""

    client: httpx.Client
    document: dict[str, Any]
    ids: dict[str, str]


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """Give a service on SQLite with a finished job and a finished batch."""
    own = service.sqlite_settings(tmp_path_factory.mktemp("schema"), longest_wait_seconds=0.1)
    with service.running(own) as client:
        client.headers["Authorization"] = f"Bearer {new_key(own)}"
        yield Served(client, create_app(own).openapi(), finished_ids(client, own))


@contextmanager
def writing(own: Settings) -> Iterator[Session]:
    engine = make_engine(own)
    with session_factory(engine).begin() as session:
        yield session
    engine.dispose()


def new_key(own: Settings) -> str:
    with writing(own) as session:
        return keys.create(session, "acme", tuple(Scope), None, None)[1]


def finished_ids(client: httpx.Client, own: Settings) -> dict[str, str]:
    job = service.finished(client, own).rpartition("/")[2]
    posted = {"lines": [short_request()["line"], {"span": 1}], "analysis": short_request()["analysis"]}
    batch = client.post("/v1/batches", json=posted).raise_for_status().json()["id"]
    with writing(own) as session:
        (chunk,) = session.scalars(select(Job.id).where(Job.batch_id == UUID(batch)))
    run_job(own, chunk)
    return {"job_id": job, "batch_id": batch}


@pytest.mark.timeout(600)
@pytest.mark.parametrize("mode", list(GenerationMode), ids=lambda mode: mode.value)
def test_every_answer_is_one_that_the_document_tells_of(served: Served, mode: GenerationMode) -> None:
    schema = schemathesis.openapi.from_dict(served.document)
    answers: Counter[str] = Counter()
    operations = 0
    for result in schema.get_all_operations():
        assert isinstance(result, Ok)
        operation = result.ok()
        operations += 1

        @settings(
            max_examples=CASES_AN_OPERATION,
            derandomize=True,
            database=None,
            phases=[Phase.explicit, Phase.generate],
            suppress_health_check=list(HealthCheck),
        )
        @given(case=operation.as_strategy(mode), known=st.booleans())
        def ask(case: Case[Any], known: bool) -> None:
            if known and case.method != "DELETE":
                case.path_parameters = {**(case.path_parameters or {}), **here(served, case)}
            answers[validated(served, case)] += 1

        with suppress(Unsatisfiable):  # nothing can be wrong with a request that has neither parameters nor body
            ask()
    told = {f"answers with {status}": number for status, number in sorted(answers.items())}
    figures.note(f"schemathesis, {mode.value}", {"operations": operations, "cases": answers.total(), **told})
    if mode is GenerationMode.POSITIVE:  # what does not fit may lack the key
        assert not {"401", "403", "429"} & answers.keys()
    assert operations >= 30


def here(served: Served, case: Case[Any]) -> dict[str, str]:
    return {name: value for name, value in served.ids.items() if name in (case.path_parameters or {})}


def validated(served: Served, case: Case[Any]) -> str:
    """Send a case, hold the answer against the document, and return its status."""
    shown = {"Authorization": served.client.headers["Authorization"]}
    answer = case.call(base_url=str(served.client.base_url), headers=shown, timeout=30)
    if answer.content == b"Invalid HTTP request received.":
        return "400 of the server, to what is no HTTP"
    # Schemathesis takes a stream of events apart as OpenAPI 3.2 has it; the document is 3.1, where it is a text.
    streamed = "text/event-stream" in answer.headers.get("content-type", [""])[0]
    case.validate_response(answer, checks=CHECKS[:-1] if streamed else CHECKS)
    return str(answer.status_code)
