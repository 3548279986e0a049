"""Health checks, metrics, and the pages that explain problem types."""

import shutil
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from anyio import create_task_group, move_on_after, to_thread
from fastapi import APIRouter, Request, Response
from fastapi.responses import JSONResponse
from sqlalchemy import Engine
from sqlalchemy.exc import SQLAlchemyError

from app.answers.health import Health
from app.answers.problem_pages import ProblemPage
from app.http.problems import ProblemError, ProblemKind
from app.jobs.dispatch import BrokerUnavailable, open_queue
from app.operation import metrics
from app.operation.write_probe import WriteProbe
from app.routes import documentation
from app.routes.dependencies import Readers, SettingsOf
from app.runtime.settings import Settings
from app.runtime.signing import SecretUnavailable, signing_key
from app.storage.migration import schema_fault

router = APIRouter(tags=["service"])

_OK: dict[str, Any] = {"status": "ok", "checks": {"database": "ok", "migrations": "ok", "broker": "ok"}}
_DOWN: dict[str, Any] = {"status": "unavailable", "checks": {**_OK["checks"], "broker": "cannot be reached"}}
_PATIENCE_SECONDS = 3.0
_LEAST_BYTES = 4_000_000  # some commits of the write-ahead log


@router.get(
    "/health/live",
    summary="Check that the service is alive",
    response_model=Health,
    responses={200: documentation.body("The process answers", ("application/json", {"status": "ok", "checks": {}}))},
)
def check_live() -> JSONResponse:
    """Answer that the process is alive."""
    return JSONResponse({"status": "ok", "checks": {}})


@router.get(
    "/health/ready",
    summary="Check that the service is ready",
    response_model=Health,
    responses={
        200: documentation.body("The service is ready", ("application/json", _OK)),
        503: {**documentation.body("The service is not ready", ("application/json", _DOWN)), "model": Health},
    },
)
async def check_ready(request: Request, settings: SettingsOf) -> JSONResponse:
    """Check database (reachable, migrated, with room on its disk, takes changes), broker and signing secret.

    Answer 503 if not ready, within 3 s.

    Without the broker the service still accepts work, and does it when the broker is back.
    """
    checks = dict.fromkeys(_OK["checks"], "does not answer in time")

    async def run_check(check: Callable[[], dict[str, str]]) -> None:
        checks.update(await to_thread.run_sync(check, abandon_on_cancel=True))

    with move_on_after(_PATIENCE_SECONDS):
        async with create_task_group() as running:
            running.start_soon(run_check, partial(_database_checks, request.app.state.prober, request.app.state.probe))
            running.start_soon(run_check, partial(_secret_check, settings))
            running.start_soon(run_check, partial(_broker_check, settings))
    good = all(value == "ok" for value in checks.values())
    return JSONResponse({"status": "ok" if good else "unavailable", "checks": checks}, 200 if good else 503)


@router.get(
    "/problems/{slug}",
    summary="Explain a problem type",
    response_model=ProblemPage,
    responses={
        200: documentation.body("The meaning of the problem type", ("application/json", documentation.PROBLEM_PAGE)),
        **documentation.problems(ProblemKind.NOT_FOUND),
    },
)
def problem_page(slug: str) -> ProblemPage:
    """Explain a problem type."""
    for kind in ProblemKind:
        if kind.slug == slug:
            return ProblemPage(slug=slug, status=kind.status, title=kind.title, description=kind.description)
    raise ProblemError(ProblemKind.NOT_FOUND, "There is no such problem.")


@router.get(
    "/metrics",
    summary="Get the metrics",
    response_class=Response,
    responses={200: documentation.body("Metrics for Prometheus", ("text/plain", "galloping_jobs_waiting 0.0"))},
)
def prometheus_metrics(request: Request, readers: Readers) -> Response:
    """Return requests, queues, finished jobs and lost leases in Prometheus format; every process returns the same."""
    text, media_type = metrics.text(request.app.state.requests, readers, request.headers.get("accept", ""))
    return Response(text, media_type=media_type)


def _database_checks(prober: Engine, probe: WriteProbe) -> dict[str, str]:
    reading = prober.execution_options(read_only=True)  # which a writer does not hold up
    try:
        with reading.connect() as connection:
            migrated = schema_fault(connection) is None
        state = probe.state() if _has_room(prober) else "its disk is full"
    except SQLAlchemyError:
        return {"database": "cannot be reached", "migrations": "unknown"}
    return {"database": state, "migrations": "ok" if migrated else "not those of this version"}


def _secret_check(settings: Settings) -> dict[str, str]:
    """Return nothing where all is well: most services have their secret from their settings."""
    try:
        signing_key(settings)
    except SecretUnavailable:
        return {"secret": "cannot be read"}
    return {}


def _has_room(prober: Engine) -> bool:
    """Tell whether the disk of an embedded database has room to write; a server looks after its own."""
    file = prober.url.database
    return prober.dialect.name != "sqlite" or not file or shutil.disk_usage(Path(file).parent).free > _LEAST_BYTES


def _broker_check(settings: Settings) -> dict[str, str]:
    try:
        with open_queue(settings) as queue:
            queue.is_empty()
    except BrokerUnavailable:
        return {"broker": "cannot be reached"}
    return {"broker": "ok"}
