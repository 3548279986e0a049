"""Quotas of an owner: how many jobs and chunks wait, and how many bytes requests and results take.

What a job's results are expected to take counts from its post on. What was accepted is run and kept, even if it takes
more. How many jobs of an owner run is bounded where workers choose them (`app.jobs.turns`).
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import reduce
from threading import Lock

from sqlalchemy import case, func, select
from sqlalchemy.orm import Session

from app.jobs.turns import WAITS
from app.runtime.settings import Settings
from app.storage.database import serialize
from app.tables import Batch, Job, JobStatus

_REMEMBERED_SECONDS = 5.0
_LITTLE = 1000  # what asks for less than this part of a quota is little
_NEAR = 10  # less than this part of a quota left is near its end


class Bounded(StrEnum):
    """What a quota bounds."""

    WAITING = "waiting"
    BYTES = "bytes"


@dataclass(frozen=True, slots=True)
class Amount:
    """Waiting jobs and bytes, of an owner or of what an owner asks for."""

    waiting: int = 0
    stored: int = 0

    def plus(self, other: "Amount") -> "Amount":
        """Return both together."""
        return Amount(self.waiting + other.waiting, self.stored + other.stored)


def amount(jobs: Sequence[Job]) -> Amount:
    """Return what jobs take that are to be stored; one that has ended with stored results does not wait."""
    waiting = sum(job.status is JobStatus.ACCEPTED for job in jobs)
    return Amount(waiting, sum(job.request_bytes + job.result_bytes for job in jobs))


@dataclass(frozen=True, slots=True)
class Standing:
    """What an owner has: running and waiting jobs, bytes, and the part of these that open jobs are expected to take."""

    running: int
    waiting: int
    stored: int
    expected: int


class OverQuota(Exception):
    """Raised, or returned for one of several, when an owner asks for more than a quota leaves."""

    def __init__(self, bounded: Bounded, used: int, asked: int, most: int) -> None:
        """Take what is bounded, how much of it the owner has and asks for, and the most."""
        super().__init__(f"{used} and {asked} more are over {most}")
        self.bounded, self.used, self.asked, self.most = bounded, used, asked, most


@dataclass(frozen=True, slots=True)
class _Seen:
    """What an owner had when it was last read, with what this process has accepted since."""

    used: Amount
    until: float


@dataclass(slots=True, eq=False)
class Quotas:
    """The quotas of every owner, with what this process remembers of owners far from them; zero is no bound."""

    most: Amount = field(default_factory=Amount)
    _seen: dict[str, _Seen] = field(default_factory=dict)
    _changes: Lock = field(default_factory=Lock)

    @classmethod
    def of(cls, settings: Settings) -> "Quotas":
        """Return the quotas of the settings."""
        return cls(Amount(settings.waiting_jobs_per_owner, settings.stored_bytes_per_owner))

    def require(self, session: Session, owner: str, asked: Amount) -> None:
        """Check that an owner may have so much more, which this transaction then stores.

        Raises
        ------
        OverQuota
            If the owner may not.
        """
        (over,) = self.refusals(session, owner, [asked])
        if over is not None:
            raise over

    def refusals(self, session: Session, owner: str, asked: Sequence[Amount]) -> list[OverQuota | None]:
        """Return for each of several wishes of an owner why it is over a quota, None if this transaction may store it.

        Near the end of a quota, and for large wishes, what the owner has is read, while other transactions that ask for
        the same owner wait: the quota holds exactly. Little ones far from it are added to what was read up to five
        seconds ago, and so may miss what other processes accepted since.
        """
        total = reduce(Amount.plus, asked, Amount())
        if self._surely_has_room(owner, total):
            return [None] * len(asked)
        serialize(session, f"quotas of {owner}")
        used, found = _used(session, owner), []
        for wish in asked:
            found.append(self._over(used, wish))
            used = used.plus(wish) if found[-1] is None else used
        self._remember(owner, _Seen(used, time.monotonic() + _REMEMBERED_SECONDS))
        return found

    def _surely_has_room(self, owner: str, asked: Amount) -> bool:
        if self.most == Amount():
            return True
        with self._changes:
            seen = self._seen.get(owner)
            if seen is None or time.monotonic() > seen.until:
                return False
            used = seen.used.plus(asked)
            sides = ((self.most.waiting, asked.waiting, used.waiting), (self.most.stored, asked.stored, used.stored))
            if any(most and (_LITTLE * wish > most or used > most - most // _NEAR) for most, wish, used in sides):
                return False
            self._seen[owner] = replace(seen, used=used)
        return True

    def _remember(self, owner: str, seen: _Seen) -> None:
        now = time.monotonic()
        with self._changes:
            self._seen = {name: old for name, old in self._seen.items() if old.until > now} | {owner: seen}

    def _over(self, used: Amount, asked: Amount) -> OverQuota | None:
        if self.most.waiting and asked.waiting and used.waiting + asked.waiting > self.most.waiting:
            return OverQuota(Bounded.WAITING, used.waiting, asked.waiting, self.most.waiting)
        if self.most.stored and used.stored + asked.stored > self.most.stored:
            return OverQuota(Bounded.BYTES, used.stored, asked.stored, self.most.stored)
        return None


NONE = Quotas()
"""No quotas."""


def standing(session: Session, owner: str) -> Standing:
    """Return what an owner has."""
    used = _used(session, owner)
    running = Job.owner == owner, Job.status == JobStatus.RUNNING
    waiting = Job.owner == owner, WAITS
    count, expected = func.count(), func.coalesce(func.sum(Job.result_bytes), 0)
    here, there = (session.execute(select(count, expected).where(*state)).one() for state in (running, waiting))
    return Standing(here[0], there[0], used.stored, int(here[1] + there[1]))


def standings(session: Session) -> dict[str, Standing]:
    """Return what every owner has who has anything, by the owner's name; this reads all jobs."""
    runs, waits = (case((Job.status == status, 1), else_=0) for status in (JobStatus.RUNNING, JobStatus.ACCEPTED))
    sizes = Job.request_bytes + Job.result_bytes, (runs + waits) * Job.result_bytes
    jobs = select(Job.owner, *map(func.sum, (runs, waits, *sizes))).group_by(Job.owner)
    found = {row[0]: Standing(*map(int, row[1:])) for row in session.execute(jobs)}
    for owner, size in session.execute(select(Batch.owner, func.sum(Batch.request_bytes)).group_by(Batch.owner)):
        had = found.get(owner, Standing(0, 0, 0, 0))
        found[owner] = replace(had, stored=had.stored + int(size))
    return dict(sorted(found.items()))


def _used(session: Session, owner: str) -> Amount:
    """Return what an owner has, from the stored rows."""
    waiting = select(func.count()).select_from(Job).where(WAITS, Job.owner == owner)
    jobs = select(func.coalesce(func.sum(Job.request_bytes + Job.result_bytes), 0)).where(Job.owner == owner)
    batches = select(func.coalesce(func.sum(Batch.request_bytes), 0)).where(Batch.owner == owner)
    found = session.execute(select(waiting.scalar_subquery(), jobs.scalar_subquery(), batches.scalar_subquery())).one()
    return Amount(int(found[0]), int(found[1] + found[2]))
