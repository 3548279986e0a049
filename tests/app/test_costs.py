"""What a request and a line cost in statements and messages: counts, which no clock and no machine changes."""

import importlib
import json
import subprocess
import sys
from functools import partial
from pathlib import Path
from typing import Any
from unittest import mock
from uuid import UUID

import pytest
from sqlalchemy.orm import Session, sessionmaker

from app import convert
from app.batches import batch_records, line_results
from app.batches.intake import Incoming, Receipt, receive
from app.coalescing.grouped_calls import committed_together
from app.convert import PointResult
from app.jobs import job_records, leases, submissions
from app.jobs.job_records import Submission
from app.jobs.owner_quotas import Quotas
from app.jobs.submissions import Order
from app.reference.source_lines import example
from app.runtime.settings import Settings
from app.schemas import JobRequest
from app.security.caller import LOCAL, Owned
from app.tables import Job
from engine import clearance, spec
from tests.app.lines import SHORT, changed
from tests.documents import create_job, point_result, short_request
from tests.statements import counted

LINES = 400


def test_posts_that_come_together_are_as_few_statements_as_one(
    settings: Settings, sessions: sessionmaker[Session]
) -> None:
    """A server is asked for the time and for stored results; jobs, tags, events and audit take a statement each."""
    on_server = settings.database_url.startswith("postgresql")
    accept = partial(submissions.accept, allowed=Quotas.of(settings))
    with sessions.begin() as session:  # of an owner far from the quotas the process knows this for seconds
        accept(session, [Order(Submission(LOCAL, with_tension(28e3)))])
    for posts in (1, 40):
        documents = [with_tension(29e3 + number) for number in range(posts)]
        orders = [Order(Submission(LOCAL, document, tags={"a": "b", "c": "d"})) for document in documents]
        with counted() as statements:
            made = committed_together(sessions, accept, orders)
        assert len({job.id for job in made if isinstance(job, Job)}) == posts
        looks = [text for text in statements if not text.startswith("INSERT")]
        written = [text.split()[2] for text in statements if text.startswith("INSERT")]
        assert len(looks) == (2 if on_server else posts)
        assert sorted(written) == ["audit_events", "job_events", "job_tags", "jobs"]


def with_tension(tension: float) -> dict[str, Any]:
    """Return a request with the defaults in it, as it is kept."""
    line = changed("span.horizontal_tension_n", tension, short_request()["line"])
    return JobRequest.model_validate({**short_request(), "line": line}).kept()


def test_looks_at_jobs_are_two_statements_however_many_come_together(sessions: sessionmaker[Session]) -> None:
    with sessions.begin() as session:
        made = [create_job(session, LOCAL, short_request(), tags={"n": str(n)}).id for n in range(40)]
    for ids in (made[:1], made):
        with counted() as statements:
            found = job_records.look_up(sessions, [Owned(LOCAL.owner, job_id) for job_id in ids])
        assert [job and job.id for job in found] == ids
        assert len(statements) == 2
        assert not any("document" in text for text in statements)


def test_a_batch_is_a_few_statements_and_a_message_for_hundreds_of_lines(
    settings: Settings, sessions: sessionmaker[Session]
) -> None:
    with counted() as statements:
        receipt = received(settings, sessions)
    assert len(receipt.chunk_ids) == 2  # 256 lines at most
    assert len(statements) <= 11
    with counted() as statements:
        for chunk_id in receipt.chunk_ids:
            work_off(sessions, chunk_id)
    assert len(statements) <= 10 * len(receipt.chunk_ids)
    with sessions() as session, counted() as statements:
        assert len(list(line_results.documents(session, receipt.batch_id))) == LINES
    assert len(statements) <= 1 + LINES // 100


def test_lines_side_by_side_are_checked_once_here_and_their_orbits_followed_together(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    importlib.import_module("engine.analysis")  # it asks once more for each line, by the name that it has bound
    checks, paths = mock.Mock(wraps=spec.check_compatible), mock.Mock(wraps=clearance.subconductor_paths)
    monkeypatch.setattr(spec, "check_compatible", checks)
    monkeypatch.setattr(clearance, "subconductor_paths", paths)
    lines = [convert.NumberedLine(number, example("c11-twin")) for number in range(3)]
    points = [item for item in convert.run_stack(SHORT, lines) if isinstance(item, PointResult)]
    assert [point.failure for point in points] == [None] * len(lines)
    assert checks.call_count == 2 * len(lines)  # apart from the physics, and with it
    assert paths.call_count <= 1


def received(settings: Settings, sessions: sessionmaker[Session]) -> Receipt:
    lines = ({**example("c11-twin"), "reference": f"r{n}"} for n in range(LINES))
    return receive(sessions, settings, LOCAL, Incoming(SHORT, lines), atomic=False)


def work_off(sessions: sessionmaker[Session], chunk_id: UUID) -> None:
    """Claim a chunk, read its lines and store a result for each."""
    with sessions.begin() as session:
        held = leases.claim(session, chunk_id, "here", 60.0)
        assert held is not None and held.batch_id is not None
        _, lines = batch_records.lines_of_chunk(session, held.job_id, held.batch_id)
    points: list[PointResult] = [point_result(line.number) for line in lines]
    with sessions.begin() as session:
        assert leases.finish(session, held, points)


def test_analyse_loads_nothing_that_it_has_no_use_for(tmp_path: Path) -> None:
    line = tmp_path / "line.json"
    line.write_text(json.dumps(short_request()))
    script = f"""
import sys
sys.argv = ["galloping", "analyse", {str(line)!r}, "--output", {str(tmp_path / "result.json")!r}]
from app.cli import main
try:
    main()
finally:
    print(*sys.modules)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.split())
    assert "engine.analysis" in loaded
    servers = {"sqlalchemy", "celery", "fastapi", "uvicorn", "pydantic_settings", "psycopg", "httpx", "alembic"}
    assert not loaded & {*servers, "matplotlib", "rich.progress", "scipy.integrate"}
