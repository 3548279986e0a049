"""Whether the service lives, whether it can take work, and the pages that problem types lead to."""

from collections.abc import Callable
from functools import partial
from typing import Any

from anyio import create_task_group, move_on_after, to_thread
from fastapi import APIRouter, Request, Response
from fastapi.responses import JSONResponse
from sqlalchemy import Engine
from sqlalchemy.exc import SQLAlchemyError

from app.answers.health import Health
from app.answers.problems import ProblemPage
from app.http.problems import ProblemError, ProblemKind
from app.jobs.dispatch import BrokerUnavailable, open_queue
from app.operation import metrics
from app.routes import documentation
from app.routes.dependencies import Readers, SettingsOf
from app.runtime.settings import Settings
from app.storage.migration import is_newest

router = APIRouter(tags=["service"])

_OK: dict[str, Any] = {"status": "ok", "checks": {"database": "ok", "migrations": "ok", "broker": "ok"}}
_DOWN: dict[str, Any] = {"status": "unavailable", "checks": {**_OK["checks"], "broker": "cannot be reached"}}
_PATIENCE_SECONDS = 3.0


@router.get(
    "/health/live",
    response_model=Health,
    responses={200: documentation.body("Alive", ("application/json", {"status": "ok", "checks": {}}))},
)
def live() -> JSONResponse:
    """Say that the process answers."""
    return JSONResponse({"status": "ok", "checks": {}})


@router.get(
    "/health/ready",
    response_model=Health,
    responses={
        200: documentation.body("Can take work", ("application/json", _OK)),
        503: {**documentation.body("Cannot", ("application/json", _DOWN)), "model": Health},
    },
)
async def ready(request: Request, settings: SettingsOf) -> JSONResponse:
    """Say whether the database is there and migrated, and the broker is there; 503 if not, within three seconds.

    Work is accepted without the broker too, and is done when it is back.
    """
    checks = dict.fromkeys(_OK["checks"], "does not answer in time")

    async def look(check: Callable[[], dict[str, str]]) -> None:
        checks.update(await to_thread.run_sync(check, abandon_on_cancel=True))

    with move_on_after(_PATIENCE_SECONDS):
        async with create_task_group() as looks:
            looks.start_soon(look, partial(_database_checks, request.app.state.prober))
            looks.start_soon(look, partial(_broker_check, settings))
    good = all(value == "ok" for value in checks.values())
    return JSONResponse({"status": "ok" if good else "unavailable", "checks": checks}, 200 if good else 503)


@router.get(
    "/problems/{slug}",
    response_model=ProblemPage,
    responses={
        200: documentation.body("What the problem means", ("application/json", documentation.PROBLEM_PAGE)),
        **documentation.problems(ProblemKind.NOT_FOUND),
    },
)
def problem_page(slug: str) -> ProblemPage:
    """Explain a type of problem."""
    for kind in ProblemKind:
        if kind.slug == slug:
            return ProblemPage(slug=slug, status=kind.status, title=kind.title, description=kind.description)
    raise ProblemError(ProblemKind.NOT_FOUND, "There is no such problem.")


@router.get(
    "/metrics",
    response_class=Response,
    responses={200: documentation.body("Metrics for Prometheus", ("text/plain", "galloping_jobs_waiting 0.0"))},
)
def show_metrics(request: Request, readers: Readers) -> Response:
    """Tell requests, queues, ended jobs and lost leases in Prometheus' format; the same in every process."""
    told, media_type = metrics.text(request.app.state.requests, readers, request.headers.get("accept", ""))
    return Response(told, media_type=media_type)


def _database_checks(prober: Engine) -> dict[str, str]:
    try:
        with prober.connect() as connection:
            newest = is_newest(connection)
    except SQLAlchemyError:
        return {"database": "cannot be reached", "migrations": "unknown"}
    return {"database": "ok", "migrations": "ok" if newest else "not the newest"}


def _broker_check(settings: Settings) -> dict[str, str]:
    try:
        with open_queue(settings) as queue:
            queue.is_empty()
    except BrokerUnavailable:
        return {"broker": "cannot be reached"}
    return {"broker": "ok"}
