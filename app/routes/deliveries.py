"""Webhooks: the log of their deliveries, sending them again, and the secret that signs them."""

from typing import Any
from uuid import UUID

from fastapi import APIRouter
from fastapi.responses import JSONResponse, Response
from sqlalchemy.orm import Session

from app.answers.deliveries import DeliveryLog, WebhookSecret
from app.http.problems import ProblemKind
from app.http.strict_routes import KnownParametersRoute
from app.jobs import idempotency, webhooks
from app.routes import documentation
from app.routes.batch_status import batch_address, find_batch
from app.routes.dependencies import PREFIX, CallerOf, Readers, SettingsOf, Writers
from app.routes.idempotent_posts import KEY_PROBLEMS, KeyOf, PostOutcome, run_once
from app.routes.job_status import find_job, job_address
from app.schemas.fields import example_of
from app.tables import WebhookDelivery

router = APIRouter(prefix=PREFIX, tags=["webhooks"], route_class=KnownParametersRoute)

_LOG = documentation.body("The deliveries", ("application/json", example_of(DeliveryLog)))
_READ: dict[int | str, dict[str, Any]] = {200: _LOG, **documentation.problems(ProblemKind.NOT_FOUND)}
_SEND: dict[int | str, dict[str, Any]] = {
    202: {**_LOG, "headers": documentation.REPLAYED_HEADER},
    **documentation.problems(ProblemKind.NOT_FOUND, *KEY_PROBLEMS),
}


def _made(deliveries: list[WebhookDelivery], status: int) -> JSONResponse:
    return JSONResponse({"deliveries": [_document(delivery) for delivery in deliveries]}, status)


def _document(delivery: WebhookDelivery) -> dict[str, Any]:
    pending = delivery.next_attempt_at if delivery.state == "pending" else None
    return {
        "id": f"msg_{delivery.id.hex}",
        "event": delivery.event,
        "url": delivery.url,
        "state": delivery.state,
        "created_at": delivery.created_at.isoformat(),
        "next_attempt_at": pending.isoformat() if pending else None,
        "attempts": delivery.log,
    }


@router.get(
    "/jobs/{job_id}/deliveries", summary="Get the webhook log of a job", response_model=DeliveryLog, responses=_READ
)
def job_deliveries(job_id: UUID, caller: CallerOf, readers: Readers) -> JSONResponse:
    """Return the webhooks of a job with every attempt to send them."""
    with readers() as session:
        find_job(session, caller, job_id)
        return _made(webhooks.of(session, job_id=job_id), 200)


@router.get(
    "/batches/{batch_id}/deliveries",
    summary="Get the webhook log of a batch",
    response_model=DeliveryLog,
    responses=_READ,
)
def batch_deliveries(batch_id: UUID, caller: CallerOf, readers: Readers) -> JSONResponse:
    """Return the webhooks of a batch with every attempt to send them."""
    with readers() as session:
        find_batch(session, caller, batch_id)
        return _made(webhooks.of(session, batch_id=batch_id), 200)


@router.post(
    "/jobs/{job_id}/deliveries",
    summary="Send the webhooks of a job again",
    status_code=202,
    response_model=DeliveryLog,
    responses=_SEND,
)
def resend_job_webhooks(job_id: UUID, caller: CallerOf, key: KeyOf, writers: Writers) -> Response:
    """Send the webhooks of a finished job again, with unchanged ids."""

    def make(session: Session) -> PostOutcome:
        find_job(session, caller, job_id)
        deliveries = webhooks.of(session, job_id=job_id)
        webhooks.send_again(session, deliveries)
        return PostOutcome(_made(deliveries, 202))

    return run_once(writers, key, lambda: idempotency.fingerprint(job_address(job_id), "deliveries"), make).answer


@router.post(
    "/batches/{batch_id}/deliveries",
    summary="Send the webhooks of a batch again",
    status_code=202,
    response_model=DeliveryLog,
    responses=_SEND,
)
def resend_batch_webhooks(batch_id: UUID, caller: CallerOf, key: KeyOf, writers: Writers) -> Response:
    """Send the webhooks of a finished batch again, with unchanged ids."""

    def make(session: Session) -> PostOutcome:
        find_batch(session, caller, batch_id)
        deliveries = webhooks.of(session, batch_id=batch_id)
        webhooks.send_again(session, deliveries)
        return PostOutcome(_made(deliveries, 202))

    return run_once(writers, key, lambda: idempotency.fingerprint(batch_address(batch_id), "deliveries"), make).answer


@router.get(
    "/webhooks/secret",
    summary="Get the secret that signs webhooks",
    response_model=WebhookSecret,
    responses={200: documentation.body("The secret", ("application/json", example_of(WebhookSecret)))},
)
def webhook_secret(caller: CallerOf, settings: SettingsOf) -> JSONResponse:
    """Return the secret with which the owner's receivers verify signatures (Standard Webhooks)."""
    return JSONResponse({"secret": webhooks.secret(settings, caller.owner)})
