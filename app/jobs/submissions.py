"""Jobs as they are asked for over HTTP: many at once in one transaction, each under its key, if it has one."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime

from sqlalchemy.orm import Session

from app.convert import ENGINE_VERSION
from app.jobs import idempotency, job_records, reuse, webhooks
from app.jobs.idempotency import Answer, Kept, Key, KeyTaken
from app.jobs.job_records import Draft, Submission
from app.jobs.reuse import Source
from app.storage.database import database_time


@dataclass(frozen=True, slots=True)
class Keyed:
    """The key of a request, and what makes its fingerprint and, of its job, the answer that is kept."""

    key: Key
    fingerprint: Callable[[], str]
    answer: Callable[[Draft], Answer]


@dataclass(frozen=True, slots=True)
class Order:
    """A job that is asked for: whom to tell of its end, whether stored results will do, and under which key."""

    submission: Submission
    webhook_url: str | None = None
    may_reuse: bool = True
    keyed: Keyed | None = None


@dataclass(frozen=True, slots=True)
class _Drafted:
    order: Order
    job: Draft
    source: Source | None


def accept(session: Session, orders: Sequence[Order]) -> list[Draft | KeyTaken]:
    """Make the jobs of orders: those of the same input as stored results end with these, the others wait for a worker.

    An order whose key is in use gets that in the place of a job, and nothing is made for it. However many orders there
    are, the statements are as few as for one, but for those that are answered from what is stored or have a webhook.

    Raises
    ------
    ValueError
        If a document holds NaN or an infinity.
    sqlalchemy.exc.SQLAlchemyError
        If the database refuses a row, or fails.
    """
    drafted = _drafts(session, orders)
    free = _take_keys(session, drafted)
    made = [item for item in drafted if _may_be_made(item, free)]
    job_records.insert(session, [(item.order.submission.caller, item.job) for item in made])
    for item in made:
        if item.source is not None:
            reuse.copy(session, item.job.id, item.source)
        if item.order.webhook_url is not None:
            owner = item.order.submission.caller.owner
            webhooks.register(session, owner, item.order.webhook_url, job_id=item.job.id)
    return [item.job if _may_be_made(item, free) else KeyTaken() for item in drafted]


def _drafts(session: Session, orders: Sequence[Order]) -> list[_Drafted]:
    now = database_time(session)
    asked = [(order.submission.caller.owner, order.submission.document) for order in orders if order.may_reuse]
    sources = iter(reuse.find(session, asked, ENGINE_VERSION))
    return [_drafted(order, now, next(sources, None) if order.may_reuse else None) for order in orders]


def _drafted(order: Order, now: datetime, source: Source | None) -> _Drafted:
    job = job_records.draft(order.submission, now)
    return _Drafted(order, job if source is None else reuse.adopt(job, source, ENGINE_VERSION), source)


def _take_keys(session: Session, drafted: Sequence[_Drafted]) -> set[object]:
    """Keep the answers of those that have a key, and return the holders of the keys that were free."""
    kept = [
        Kept(keyed.key, keyed.fingerprint(), keyed.answer(item.job))
        for item in drafted
        if (keyed := item.order.keyed) is not None
    ]
    return set(idempotency.keep(session, kept)) if kept else set()


def _may_be_made(item: _Drafted, free: set[object]) -> bool:
    return item.order.keyed is None or item.order.keyed.key.holder in free
