"""Submit what a form says, by the same way as `POST /v1/jobs`."""

from collections.abc import Callable, Mapping
from typing import Any

from fastapi import Request
from pydantic import ValidationError

from app import convert, schemas
from app.http.beside_loop import beside_loop
from app.jobs.job_records import Submission
from app.jobs.submissions import Order
from app.owned import records
from app.pages.frame import caller_of
from app.schemas.faults import BadInput, faults_of
from app.tables import Job, JobStatus


async def submit(request: Request, say: Callable[[], Mapping[str, Any]], *, may_reuse: bool = True) -> Job:
    """Check a request document, store its job and tell the workers.

    say: returns the document; it is called in a thread, since it may read the database or a large form.

    Raises
    ------
    BadInput
        With every fault of the document.
    """

    def checked_submission() -> Submission:
        sound = checked(request, say())
        return Submission(caller_of(request), sound.kept(), sound.line.name, sound.line.asset_id, sound.line.tags)

    submission, shared = await beside_loop(request, checked_submission), request.app.state
    job: Job = await shared.inbox.call(Order(submission, may_reuse=may_reuse))
    if job.status is JobStatus.ACCEPTED:
        shared.messages.submit(job.id)
    return job


def checked(request: Request, document: Mapping[str, Any]) -> schemas.JobRequest:
    """Return a request document with its line resolved, if it has no faults.

    Raises
    ------
    BadInput
        With every fault of the document.
    """
    with request.app.state.readers() as session:
        own = records.own_rows(session, caller_of(request).owner)
    try:
        found = schemas.JobRequest.model_validate(convert.explicit_request(dict(document), own))
    except ValidationError as error:
        raise BadInput(faults_of(error.errors(include_url=False))) from error
    if faults := convert.request_faults(found):
        raise BadInput(faults)
    return found
