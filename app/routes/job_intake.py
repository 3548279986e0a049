"""Check requests that become jobs, store them, and answer with their status."""

from collections.abc import Callable
from dataclasses import asdict, replace
from functools import partial
from typing import TypeVar

from anyio import to_thread
from fastapi import Request, Response

from app import convert, schemas
from app.http.beside_loop import beside_loop_if_large, mark_large
from app.http.prefix import LinkedJSON
from app.http.problems import invalid_document
from app.jobs import idempotency, job_records
from app.jobs.idempotency import Key, KeyTaken
from app.jobs.job_records import Submission
from app.jobs.submissions import Keyed, Order
from app.jobs.webhooks import Subscription
from app.routes.dependencies import PREFIX, RETRY_SECONDS, vet_webhook
from app.routes.idempotent_posts import replayed_answer, stored_answer
from app.routes.job_status import job_address, job_document
from app.security.caller import Caller
from app.tables import Job, JobStatus

Made = TypeVar("Made")

JOBS = f"{PREFIX}/jobs"


async def accepted_job(request: Request, document: schemas.JobRequest, key: Key | None, *, may_reuse: bool) -> Response:
    """Check a request, store it as a job and send it; or answer as before, if its key was used.

    Raises
    ------
    ProblemError
        422 with every fault of the document.
    """
    order = partial(_order, request.state.caller, document, key, may_reuse=may_reuse)
    return await accepted_order(request, await checked(request, document, order))


async def accepted_order(request: Request, order: Order) -> Response:
    """Store an order as a job and send it; or answer as before, if its key was used."""
    try:
        return _accepted(await stored_job(request, order))
    except KeyTaken:
        keyed = order.keyed
        assert keyed is not None
        readers = request.app.state.readers
        return await to_thread.run_sync(replayed_answer, readers, keyed.key, lambda: keyed.fingerprint)


async def stored_job(request: Request, order: Order) -> Job:
    """Store an order as a job and send it.

    Raises
    ------
    KeyTaken
        If its key was used.
    """
    shared = request.app.state  # read directly, since a FastAPI dependency costs as much as checking the line
    job: Job = await shared.inbox.call(order)
    if job.status is JobStatus.ACCEPTED:
        shared.messages.submit(job.id)
    return job


def _order(caller: Caller, document: schemas.JobRequest, key: Key | None, *, may_reuse: bool) -> Order:
    line, kept = document.line, document.kept()
    submission = Submission(caller, kept, line.name, line.asset_id, line.tags)
    order = Order(submission, subscriptions_to_end(document.webhook_url), may_reuse)
    if key is None:
        return order
    fingerprint = idempotency.fingerprint(JOBS, job_records.canonical(kept), document.webhook_url or "")
    return keyed_order(order, key, fingerprint)


def subscriptions_to_end(url: str | None) -> tuple[Subscription, ...]:
    """Return who is told of the end of a job."""
    return () if url is None else (Subscription(url),)


def keyed_order(order: Order, key: Key | None, fingerprint: str) -> Order:
    """Return an order that is done once under its key, if there is one."""
    if key is None:
        return order
    return replace(order, keyed=Keyed(key, fingerprint, lambda job: stored_answer(_accepted(job))))


def _accepted(job: Job) -> LinkedJSON:
    headers = {"Location": job_address(job.id), "Retry-After": RETRY_SECONDS}
    return LinkedJSON(job_document(job), 202, headers)


async def estimate(request: Request, document: schemas.JobRequest) -> Response:
    """Check a request and answer with what it would cost as a job.

    Raises
    ------
    ProblemError
        422 with every fault of the document.
    """
    cost = await checked(request, document, partial(convert.estimate, document))
    return LinkedJSON({"valid": True, **asdict(cost)})


async def checked(request: Request, document: schemas.JobRequest, make: Callable[[], Made]) -> Made:
    """Check a request beyond its schema, and return what is made of it if it has no faults.

    Raises
    ------
    ProblemError
        422 with every fault of the document.
    """

    def made() -> Made:
        if faults := convert.request_faults(document):
            raise invalid_document(faults)
        return make()

    # Checking all points of a study, or remedies, takes time; a single line takes less than a switch to a thread.
    if document.study is not None or document.remedies is not None:
        mark_large(request)
    found = await beside_loop_if_large(request, made)
    if document.webhook_url is not None:
        await vet_webhook(request.app.state.settings, document.webhook_url)
    return found
