"""Jobs as they are posted: all posts of a group in one transaction, each under its Idempotency-Key if it has one."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from sqlalchemy.orm import Session

from app.convert import ENGINE_VERSION
from app.jobs import idempotency, job_records, owner_quotas, reuse, webhooks
from app.jobs.idempotency import Answer, Kept, Key, KeyTaken
from app.jobs.job_records import Submission
from app.jobs.owner_quotas import OverQuota, Quotas
from app.jobs.webhooks import Subscription
from app.security import audit
from app.storage.database import database_time
from app.tables import Job


@dataclass(frozen=True, slots=True)
class Keyed:
    """The key of a post, the fingerprint of its request, and the function that makes the answer from the job."""

    key: Key
    fingerprint: str
    answer: Callable[[Job], Answer]


@dataclass(frozen=True, slots=True)
class Order:
    """A posted job: who is told of its events, whether stored results may be reused, and its key, if there is one."""

    submission: Submission
    subscriptions: tuple[Subscription, ...] = ()
    may_reuse: bool = True
    keyed: Keyed | None = None


def accept(
    session: Session, orders: Sequence[Order], allowed: Quotas = owner_quotas.NONE
) -> list[Job | KeyTaken | OverQuota]:
    """Store the jobs of orders; a job with stored results of the same input ends with these, others wait for a worker.

    If the key of an order is taken, its place holds `KeyTaken`, and `OverQuota` if its owner may not have the job;
    nothing is stored for it then. A group takes as few statements as one order, apart from results that are copied.

    Raises
    ------
    ValueError
        If a document holds NaN or an infinity.
    sqlalchemy.exc.SQLAlchemyError
        If the database refuses a row, or fails.
    """
    now = database_time(session)
    jobs = [job_records.make(order.submission, now) for order in orders]
    asked = [(order.submission.caller.owner, order.submission.document) for order in orders if order.may_reuse]
    found = iter(reuse.find(session, asked, ENGINE_VERSION))
    sources = [next(found, None) if order.may_reuse else None for order in orders]
    for job, source in zip(jobs, sources, strict=True):
        if source is not None:
            reuse.adopt(job, source, ENGINE_VERSION)
    taken = _taken(session, orders, jobs)
    refused = _refused(session, [job for job in jobs if job not in taken], allowed)
    _free_keys(session, orders, jobs, refused)
    new = [item for item in zip(orders, jobs, sources, strict=True) if item[1] not in taken and item[1] not in refused]
    job_records.insert(session, [job for _, job, _ in new])
    audit.record_submissions(session, [(order.submission.caller, job.id) for order, job, _ in new], now)
    for order, job, source in new:
        for wanted in order.subscriptions:
            webhooks.register(session, job.owner, wanted, job_id=job.id)
        if source is not None:
            reuse.copy(session, job.id, source)
    return [KeyTaken() if job in taken else refused.get(job, job) for job in jobs]


def _taken(session: Session, orders: Sequence[Order], jobs: Sequence[Job]) -> set[Job]:
    """Keep the answers of the orders that have a key, and return the jobs whose key was taken."""
    keyed = [(order.keyed, job) for order, job in zip(orders, jobs, strict=True) if order.keyed is not None]
    if not keyed:
        return set()
    free = idempotency.keep(session, [Kept(item.key, item.fingerprint, item.answer(job)) for item, job in keyed])
    return {job for item, job in keyed if item.key.holder not in free}


def _refused(session: Session, jobs: Sequence[Job], allowed: Quotas) -> dict[Job, OverQuota]:
    """Return the jobs that their owners may not have; owners in a fixed order, so that two groups never deadlock."""
    refused: dict[Job, OverQuota] = {}
    for owner in sorted({job.owner for job in jobs}):
        of_owner = [job for job in jobs if job.owner == owner]
        found = allowed.refusals(session, owner, [owner_quotas.amount([job]) for job in of_owner])
        refused |= {job: over for job, over in zip(of_owner, found, strict=True) if over is not None}
    return refused


def _free_keys(session: Session, orders: Sequence[Order], jobs: Sequence[Job], refused: Mapping[Job, object]) -> None:
    keyed = [order.keyed for order, job in zip(orders, jobs, strict=True) if job in refused and order.keyed is not None]
    if keyed:
        idempotency.forget(session, [item.key for item in keyed])
