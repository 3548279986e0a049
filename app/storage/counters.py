"""Totals for the metrics: each counts exactly what was committed, and outlives the rows that it was counted on.

A tally is added in the transaction in which what it counts happens, so that neither a killed process nor a late one
can make it wrong. Rows are only added, never changed, since workers that share a row would wait for each other; a
sweep puts many rows of a kind together into one.
"""

from collections import defaultdict
from enum import StrEnum

from sqlalchemy import delete, func, select
from sqlalchemy.orm import Session

from app.tables import CounterIncrement, FailureKind, JobStatus

_FOLDED_AT_ONCE = 1000
_WORTH_FOLDING = 200


class CounterName(StrEnum):
    """What is counted: attempts that ended their job or chunk, leases that were lost, and attempts to tell somebody."""

    JOBS = "jobs"
    CHUNKS = "chunks"
    LEASES = "leases"
    WEBHOOKS = "webhooks"


def add(session: Session, name: CounterName, label: str, *, count: int = 1, seconds: float = 0.0) -> None:
    """Count something that this transaction does; there must be few labels."""
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
    """Count the ends of jobs or chunks: in which state, of what failure, and after how many seconds of work."""
    label = f"{status.value}/{failure.value}" if failure else status.value
    add(session, CounterName.CHUNKS if chunk else CounterName.JOBS, label, count=count, seconds=seconds)


def totals(session: Session) -> dict[tuple[str, str], tuple[int, float]]:
    """Return count and seconds by name and label."""
    sums = func.sum(CounterIncrement.count), func.sum(CounterIncrement.seconds)
    found = session.execute(
        select(CounterIncrement.name, CounterIncrement.label, *sums).group_by(
            CounterIncrement.name, CounterIncrement.label
        )
    )
    return {(name, label): (int(count), float(seconds)) for name, label, count, seconds in found}


def fold(session: Session) -> int:
    """Put rows of a kind together into one where there are many, and return how many were; any number may do so."""
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
