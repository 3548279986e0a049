"""Change the labels of a batch."""

from typing import Annotated
from uuid import UUID

from fastapi import APIRouter, Body, Response

from app.answers.batches import BatchDocument
from app.batches import batch_records
from app.http.prefix import LinkedJSON
from app.http.problems import ProblemKind
from app.http.strict_routes import StrictJsonRoute
from app.jobs import batch_progress
from app.routes import batch_documentation, documentation
from app.routes.batch_status import BATCHES, batch_document, find_batch
from app.routes.dependencies import CallerOf, Writers
from app.schemas.fields import with_marks
from app.schemas.labels import BatchLabels

router = APIRouter(prefix=BATCHES, tags=["batches"], route_class=StrictJsonRoute)

_LABELS = {"named": {"summary": "A name and a tag", "value": {"name": "Winter check", "tags": {"region": "north"}}}}


@router.patch(
    "/{batch_id}",
    summary="Change the labels of a batch",
    response_model=BatchDocument,
    responses={
        200: documentation.body("The batch with its labels", ("application/json", batch_documentation.FINISHED)),
        **documentation.problems(
            ProblemKind.NOT_FOUND, ProblemKind.UNSUPPORTED_MEDIA_TYPE, ProblemKind.INVALID_DOCUMENT
        ),
    },
)
def change_batch_labels(
    batch_id: UUID,
    labels: Annotated[BatchLabels, Body(openapi_examples=with_marks(_LABELS))],
    caller: CallerOf,
    writers: Writers,
) -> Response:
    """Change name and tags of a batch, which its documents show; its lines have labels of their own.

    What is absent stays; null removes a label.
    """
    with writers.begin() as session:
        batch = find_batch(session, caller, batch_id)
        name = labels.name if "name" in labels.model_fields_set else batch.name
        batch_records.relabel(session, caller, batch, name, labels.changed_tags(batch.tags or {}))
        document = batch_document(session, batch, batch_progress.counts(session, [batch_id])[batch_id])
    return LinkedJSON(document)
