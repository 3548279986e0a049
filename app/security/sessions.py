"""Sessions of browsers, made from a key, and the marks that protect forms: signed texts.

A session holds the digest under which the key is stored, so it ends when the key is revoked or expires, and a number,
under which the database keeps that it was ended. At the latest it ends after some hours. Only the database knows what a
digest stands for, and it admits nobody by itself. A mark of a form holds whose form it is; another site cannot read it,
and so cannot send the form in the name of somebody signed in.
"""

from datetime import timedelta
from http.cookies import CookieError, SimpleCookie
from typing import Any, NamedTuple
from uuid import UUID, uuid4

from itsdangerous import BadSignature, URLSafeTimedSerializer
from sqlalchemy import delete
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from app.runtime.settings import Settings
from app.runtime.signing import signing_key
from app.storage.steady_clock import steady_time
from app.tables import EndedSession

COOKIE = "galloping_session"
LASTS_SECONDS = 12 * 3600
_KEPT = timedelta(seconds=2 * LASTS_SECONDS)  # the clocks of API and database may differ


class Shown(NamedTuple):
    """What a request shows: the digest of a key, by itself or by a session of this number."""

    digest: str
    session: UUID | None = None


def issue(settings: Settings, digest: str) -> str:
    """Return the text of a new session's cookie for the digest of a key."""
    return _serializer(settings, "session").dumps([digest, uuid4().hex])


def shown_by(settings: Settings, cookies: str) -> Shown | None:
    """Return what the session in a Cookie header shows, None without one that is valid; it may have been ended."""
    text = _cookie(cookies)
    match None if text is None else _loaded(settings, "session", text):
        case [str(digest), str(number)]:
            return Shown(digest, UUID(number))
    return None


def end(session: Session, number: UUID) -> None:
    """Keep that a session was ended, for as long as its cookie could be shown."""
    insert = postgresql.insert if session.get_bind().dialect.name == "postgresql" else sqlite.insert
    row = {"id": number, "expires_at": steady_time(session) + _KEPT}
    session.execute(insert(EndedSession).values(row).on_conflict_do_nothing())  # two may sign out at once


def is_ended(session: Session, number: UUID) -> bool:
    """Tell whether a session was ended."""
    return session.get(EndedSession, number) is not None


def forget_expired(session: Session) -> None:
    """Forget ended sessions whose cookies have expired."""
    session.execute(delete(EndedSession).where(EndedSession.expires_at <= steady_time(session)))


def form_mark(settings: Settings, whose: str) -> str:
    """Return the mark for the forms of somebody."""
    return _serializer(settings, "form").dumps(whose)


def is_form_mark(settings: Settings, whose: str, mark: str) -> bool:
    """Tell whether this service gave this mark to the same one, not too long ago."""
    return bool(_loaded(settings, "form", mark) == whose)


def _cookie(cookies: str) -> str | None:
    try:
        found = SimpleCookie(cookies).get(COOKIE)
    except CookieError:
        return None
    return found.value if found is not None else None


def _loaded(settings: Settings, use: str, text: str) -> Any:
    try:
        return _serializer(settings, use).loads(text, max_age=LASTS_SECONDS)
    except BadSignature:
        return None


def _serializer(settings: Settings, use: str) -> URLSafeTimedSerializer:
    return URLSafeTimedSerializer(signing_key(settings), salt=f"galloping {use}")
