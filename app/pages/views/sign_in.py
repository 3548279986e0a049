"""Sign in with a key, and out again. The cookie is for this service only, and scripts cannot read it."""

from contextlib import suppress
from uuid import UUID

from anyio import to_thread
from fastapi import APIRouter, Request, Response
from sqlalchemy.exc import SQLAlchemyError
from starlette.datastructures import State

from app.http.forwarded import is_encrypted
from app.http.problems import ProblemError, ProblemKind
from app.http.strict_routes import KnownParametersRoute
from app.pages.forms import Fields, local_path
from app.pages.frame import address, moved, page
from app.pages.wording import words
from app.routes.dependencies import CallerOf
from app.security import audit, keys, sessions
from app.security.caller import Caller
from app.tables import AuditAction

router = APIRouter(include_in_schema=False, route_class=KnownParametersRoute)


@router.get("/pages/sign-in")
async def sign_in_form(request: Request, back: str = "/") -> Response:
    """Return the form that asks for a key."""
    return page(request, "sign_in.html", back=local_path(back), fault=None)


@router.post("/pages/sign-in")
async def sign_in(request: Request, fields: Fields) -> Response:
    """Begin a session for a valid key, and go to the page that wanted one.

    Raises
    ------
    ProblemError
        429 if too many keys were tried from this address.
    """
    settings, back = request.app.state.settings, local_path(fields.get("back", "/"))
    digest = keys.digest_of(fields.get("key", "").strip())
    standing = await request.app.state.strangers.try_key(request.scope, digest)
    if standing is not None and standing.left is None:
        raise ProblemError(ProblemKind.TOO_MANY_REQUESTS, words().sign_in.too_often, headers=standing.fields)

    if not await to_thread.run_sync(_begin, request.app.state, digest):
        return page(request, "sign_in.html", 401, back=back, fault=words().sign_in.wrong)
    answer = moved(request, back)
    answer.set_cookie(
        sessions.COOKIE,
        sessions.issue(settings, digest),
        max_age=sessions.LASTS_SECONDS,
        path=address(request)("/"),
        secure=is_encrypted(request.scope),
        httponly=True,
        samesite="lax",
    )
    return answer


@router.post("/pages/sign-out")
async def sign_out(request: Request, fields: Fields, caller: CallerOf) -> Response:
    """End the session, in this browser and for every copy of its cookie."""
    state = request.app.state
    shown = sessions.shown_by(state.settings, request.headers.get("cookie", ""))
    if shown is not None and shown.session is not None:
        await to_thread.run_sync(_end, state, caller, shown.session)
        state.callers.forget(shown)  # other processes look within `key_cache_seconds`
    answer = moved(request, "/pages/sign-in")
    answer.delete_cookie(sessions.COOKIE, path=address(request)("/"), httponly=True, samesite="lax")
    return answer


def _end(state: State, caller: Caller, number: UUID) -> None:
    with state.writers.begin() as session:
        sessions.end(session, number)
        audit.record(session, caller, AuditAction.SIGNED_OUT, caller.key_id)


def _begin(state: State, digest: str) -> bool:
    """Tell whether a key is valid, and add to the audit record that a session begins with it."""
    with state.readers() as session:
        caller = keys.look_up(session, digest)[0]
    if caller is None:
        return False
    with suppress(SQLAlchemyError), state.writers.begin() as session:  # pages may be read even if the database is full
        audit.record(session, caller, AuditAction.SIGNED_IN, caller.key_id)
    return True
