"""The state of a batch by the states of its lines; `tests/app/batches/test_batch_records.py` counts them in SQL."""

import pytest

from app.jobs.batch_progress import Counts
from app.tables import JobStatus


@pytest.mark.parametrize(
    ("counts", "status"),
    [
        (Counts(accepted=3), JobStatus.ACCEPTED),
        (Counts(accepted=2, successful=1), JobStatus.RUNNING),
        (Counts(running=1, dismissed=2), JobStatus.RUNNING),
        (Counts(successful=1, failed=5), JobStatus.SUCCESSFUL),
        (Counts(successful=5, dismissed=1), JobStatus.DISMISSED),
        (Counts(failed=2), JobStatus.FAILED),
        (Counts(), JobStatus.FAILED),  # every line was rejected
    ],
)
def test_the_state_of_a_batch_follows_from_its_lines(counts: Counts, status: JobStatus) -> None:
    assert counts.status is status


def test_reused_lines_are_among_the_successful() -> None:
    assert Counts(accepted=1, running=2, successful=3, failed=4, dismissed=5, reused=3).lines == 15
