"""Batches through real brokers and workers that are killed in the middle."""

import json
import time
from uuid import UUID

from sqlalchemy import func, select
from sqlalchemy.orm import Session, sessionmaker

from app.batches import batch_records, line_results
from app.batches.intake import Incoming, receive
from app.jobs import batch_progress, job_records
from app.jobs.job_records import JobFilters
from app.reference.source_lines import example
from app.runtime.settings import Settings
from app.security.caller import LOCAL
from app.tables import JobStatus, PointRow
from tests.app.lines import SHORT, changed
from tests.documents import add_job, look, short_request
from tests.in_process import send
from tests.processes import kill_group, running_worker
from tests.servers import wait_until

LINES = 300
ENDED = (JobStatus.SUCCESSFUL, JobStatus.FAILED, JobStatus.DISMISSED)


def submit(sessions: sessionmaker[Session], settings: Settings, *, most_chunk_lines: int = 32) -> UUID:
    lines = (
        {**changed("span.length_m", 100.0 + 0.1 * n, example("c11-twin")), "reference": f"r{n}"}
        for n in range(1, LINES + 1)
    )
    small = settings.model_copy(update={"most_chunk_lines": most_chunk_lines})
    receipt = receive(sessions, small, LOCAL, Incoming(SHORT, lines), atomic=False)
    assert send(settings, *receipt.chunk_ids, chunk=True)
    return receipt.batch_id


def counts(sessions: sessionmaker[Session], batch_id: UUID) -> batch_progress.Counts:
    with sessions() as session:
        return batch_progress.counts(session, [batch_id])[batch_id]


def test_killed_worker_loses_and_doubles_nothing(deployment: Settings, deployed: sessionmaker[Session]) -> None:
    with running_worker(deployment) as worker:
        batch_id = submit(deployed, deployment)
        wait_until(lambda: _in_the_middle(counts(deployed, batch_id)), 60.0, "the middle of the batch")
        kill_group(worker)
    found = counts(deployed, batch_id)
    assert found.accepted + found.running > 0
    with running_worker(deployment):
        wait_until(lambda: counts(deployed, batch_id).status in ENDED, 90.0, "the end of the batch")
    assert counts(deployed, batch_id).successful == LINES
    with deployed() as session:
        whole = list(map(json.loads, line_results.documents(session, batch_id)))
        stored = session.scalar(select(func.count()).select_from(PointRow))
        cycles = sum(1 for _ in line_results.rows(session, batch_id, "limit_cycles"))
        attempts = [
            job.attempt for job in job_records.page(session, LOCAL.owner, JobFilters(batch_id=batch_id), None, 100)
        ]
    assert [(line["number"], line["reference"]) for line in whole] == [(n, f"r{n}") for n in range(1, LINES + 1)]
    assert {line["status"] for line in whole} == {"successful"}
    assert (stored, cycles) == (LINES, sum(len(line["limit_cycles"]) for line in whole))
    assert max(attempts) == (2 if found.running else 1)  # the kill may have come between two chunks


def _in_the_middle(found: batch_progress.Counts) -> bool:
    return found.successful > 0 and found.running > 0


def test_running_batch_stops_when_cancelled(deployment: Settings, deployed: sessionmaker[Session]) -> None:
    with running_worker(deployment):
        batch_id = submit(deployed, deployment, most_chunk_lines=16)
        wait_until(lambda: counts(deployed, batch_id).successful > 0, 60.0, "the first lines")
        with deployed.begin() as session:
            batch_records.cancel(session, LOCAL, batch_id)
        wait_until(lambda: counts(deployed, batch_id).status in ENDED, 30.0, "the end of the batch")
    found = counts(deployed, batch_id)
    assert found.status is JobStatus.DISMISSED
    assert found.successful + found.dismissed == LINES and found.dismissed > 0


def test_a_single_job_is_not_stuck_behind_a_batch(deployment: Settings, deployed: sessionmaker[Session]) -> None:
    batch_id = submit(deployed, deployment, most_chunk_lines=2)
    single = add_job(deployed, short_request())
    assert send(deployment, single)
    with running_worker(deployment):
        begin = time.monotonic()
        wait_until(lambda: look(deployed, single).status is JobStatus.SUCCESSFUL, 60.0, "the single job")
        assert counts(deployed, batch_id).accepted > LINES // 2, time.monotonic() - begin
        with deployed.begin() as session:
            batch_records.cancel(session, LOCAL, batch_id)
