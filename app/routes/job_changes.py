"""Change the labels of a job, and run it again."""

from typing import Annotated
from uuid import UUID

from anyio import to_thread
from fastapi import APIRouter, Body, Request, Response

from app.answers.jobs import JobDocument
from app.http.prefix import LinkedJSON
from app.http.problems import ProblemError, ProblemKind
from app.http.strict_routes import StrictJsonRoute
from app.jobs import idempotency, job_records, webhooks
from app.jobs.job_records import Submission
from app.jobs.submissions import Order
from app.jobs.webhooks import Subscription
from app.routes import documentation
from app.routes.dependencies import CallerOf, Writers
from app.routes.idempotent_posts import KEY_PROBLEMS, KeyOf
from app.routes.job_intake import JOBS, accepted_order, keyed_order
from app.routes.job_status import find_job, job_address, job_document
from app.routes.own_quotas import QUOTA_PROBLEMS
from app.schemas.fields import with_marks
from app.schemas.labels import JobLabels
from app.security.caller import Caller
from app.tables import ENDED, DeliveryEvent

router = APIRouter(prefix=JOBS, tags=["jobs"], route_class=StrictJsonRoute)

_LABELS = {"tagged": {"summary": "Another tag, and one less", "value": {"tags": {"region": "north", "season": None}}}}


@router.patch(
    "/{job_id}",
    summary="Change the labels of a job",
    response_model=JobDocument,
    responses={
        200: documentation.body("The job with its labels", ("application/json", documentation.FINISHED_JOB)),
        **documentation.problems(
            ProblemKind.NOT_FOUND, ProblemKind.UNSUPPORTED_MEDIA_TYPE, ProblemKind.INVALID_DOCUMENT
        ),
    },
)
def change_job_labels(
    job_id: UUID,
    labels: Annotated[JobLabels, Body(openapi_examples=with_marks(_LABELS))],
    caller: CallerOf,
    writers: Writers,
) -> Response:
    """Change name, asset and tags by which lists find a job; the line and the results keep what was submitted.

    What is absent stays; null removes a label.
    """
    names = {name: getattr(labels, name) for name in labels.model_fields_set - {"tags"}}
    with writers.begin() as session:
        job = find_job(session, caller, job_id)
        tags = labels.changed_tags({tag.key: tag.value for tag in job.tags})
        job_records.relabel(session, caller, job, tags, **names)
        session.flush()
        session.refresh(job)
        document = job_document(job)
    return LinkedJSON(document)


@router.post(
    "/{job_id}/retry",
    summary="Run a job again",
    status_code=202,
    response_model=JobDocument,
    responses={
        202: {
            **documentation.body(
                "Accepted; Location is the address of the new job", ("application/json", documentation.ACCEPTED_JOB)
            ),
            "headers": documentation.ACCEPTED_HEADERS,
        },
        **documentation.problems(*KEY_PROBLEMS, *QUOTA_PROBLEMS, ProblemKind.NOT_FOUND, ProblemKind.NOT_READY),
    },
)
async def retry_job(request: Request, job_id: UUID, key: KeyOf) -> Response:
    """Submit the document of an ended job as a new one, with its labels and its webhook; nothing stored is reused.

    The old job keeps its results. A chunk of a batch is resubmitted with its batch.
    """
    order = await to_thread.run_sync(_order_of, request, job_id)
    return await accepted_order(request, keyed_order(order, key, idempotency.fingerprint(job_address(job_id), "retry")))


def _order_of(request: Request, job_id: UUID) -> Order:
    caller: Caller = request.state.caller
    with request.app.state.readers() as session:
        job = find_job(session, caller, job_id)
        if job.batch_id is not None:
            raise ProblemError(ProblemKind.NOT_FOUND, f"{job_id} is a chunk of batch {job.batch_id}; resubmit that.")
        if job.status not in ENDED:
            raise ProblemError(ProblemKind.NOT_READY, "The job has not ended, so it does not run again.")
        tags = {tag.key: tag.value for tag in job.tags}
        told = tuple(Subscription(d.url, DeliveryEvent(d.event)) for d in webhooks.of(session, job_id=job_id))
        return Order(Submission(caller, job.document, job.name, job.asset_id, tags), told, may_reuse=False)
