"""Totals for the metrics. They count exactly what was committed, and remain when the counted rows are deleted.

The transaction that does something also adds its counter row, so neither a killed process nor a late one can make a
total wrong. Workers only insert rows and never update them, because workers that share a row would wait for each other.
A sweep sums many rows into one.
"""

from collections import defaultdict
from enum import StrEnum

from sqlalchemy import delete, func, select
from sqlalchemy.orm import Session

from app.tables import CounterIncrement, FailureKind, JobStatus

_FOLDED_AT_ONCE = 1000
_WORTH_FOLDING = 200


class CounterName(StrEnum):
    """What is counted: finished jobs, finished chunks, lost leases, and attempts to send webhooks."""

    JOBS = "jobs"
    CHUNKS = "chunks"
    LEASES = "leases"
    WEBHOOKS = "webhooks"


def add(session: Session, name: CounterName, label: str, *, count: int = 1, seconds: float = 0.0) -> None:
    """Count something that this transaction does; use only a few different labels."""
    session.add(CounterIncrement(name=name.value, label=label, count=count, seconds=seconds))


def add_end(
    session: Session,
    status: JobStatus,
    failure: FailureKind | None = None,
    *,
    chunk: bool,
    count: int = 1,
    seconds: float = 0.0,
) -> None:
    """Count the ends of jobs or chunks by state and kind of failure, with their seconds of work."""
    label = f"{status.value}/{failure.value}" if failure else status.value
    add(session, CounterName.CHUNKS if chunk else CounterName.JOBS, label, count=count, seconds=seconds)


def totals(session: Session) -> dict[tuple[str, str], tuple[int, float]]:
    """Return count and seconds for each name and label."""
    sums = func.sum(CounterIncrement.count), func.sum(CounterIncrement.seconds)
    found = session.execute(
        select(CounterIncrement.name, CounterIncrement.label, *sums).group_by(
            CounterIncrement.name, CounterIncrement.label
        )
    )
    return {(name, label): (int(count), float(seconds)) for name, label, count, seconds in found}


def fold(session: Session) -> int:
    """Sum rows of the same name and label into one if there are many; return how many rows were read.

    Several processes may do this at once.
    """
    wanted = select(
        CounterIncrement.id,
        CounterIncrement.name,
        CounterIncrement.label,
        CounterIncrement.count,
        CounterIncrement.seconds,
    ).order_by(CounterIncrement.id)
    found = session.execute(wanted.limit(_FOLDED_AT_ONCE).with_for_update(skip_locked=True)).all()
    if len(found) < _WORTH_FOLDING:
        return 0
    sums: dict[tuple[str, str], list[float]] = defaultdict(lambda: [0, 0.0])
    for _, name, label, count, seconds in found:
        sums[name, label][0] += count
        sums[name, label][1] += seconds
    session.execute(delete(CounterIncrement).where(CounterIncrement.id.in_([row.id for row in found])))
    for (name, label), (total, spent) in sums.items():
        session.add(CounterIncrement(name=name, label=label, count=int(total), seconds=spent))
    return len(found)
