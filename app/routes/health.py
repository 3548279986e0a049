"""Whether the service lives, whether it can take work, and the pages that problem types lead to."""

from typing import Any

from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from fastapi import APIRouter
from fastapi.responses import JSONResponse
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session, sessionmaker

from app.errors import ProblemError, ProblemKind
from app.queue import BrokerUnavailable, open_queue
from app.routes import documentation
from app.routes.common import Readers, SettingsOf
from app.schemas.answers import Health, ProblemPage
from app.serve import alembic_config
from app.settings import Settings

router = APIRouter(tags=["service"])

_OK: dict[str, Any] = {"status": "ok", "checks": {"database": "ok", "migrations": "ok", "broker": "ok"}}
_DOWN: dict[str, Any] = {"status": "unavailable", "checks": {**_OK["checks"], "broker": "cannot be reached"}}


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
def ready(settings: SettingsOf, readers: Readers) -> JSONResponse:
    """Say whether the database is there and migrated, and the broker is there; 503 if not.

    Work is accepted without the broker too, and is done when it is back.
    """
    checks = {**_database_checks(readers), "broker": _broker_check(settings)}
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


def _database_checks(readers: sessionmaker[Session]) -> dict[str, str]:
    try:
        with readers() as session:
            connection = session.connection()
            present = MigrationContext.configure(connection).get_current_heads()
            newest = ScriptDirectory.from_config(alembic_config(connection)).get_heads()
    except SQLAlchemyError:
        return {"database": "cannot be reached", "migrations": "unknown"}
    return {"database": "ok", "migrations": "ok" if set(present) == set(newest) else "not the newest"}


def _broker_check(settings: Settings) -> str:
    try:
        with open_queue(settings) as queue:
            queue.is_empty()
    except BrokerUnavailable:
        return "cannot be reached"
    return "ok"
