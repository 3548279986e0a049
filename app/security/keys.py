"""API keys: made, looked up, listed, revoked. The caller commits the transaction.

The text of a key has 192 random bits behind a visible prefix and is shown once. What is kept is its SHA-256, and keys
are looked up by that: a slow hash would protect a guessable password, not this, and nobody can steer towards a hash in
order to learn from the time of the answer. Whether a key is good, over or unknown, the same is asked of the database;
only that a known one was used, which is written at most every ten minutes, is more.
"""

import hashlib
import secrets
from collections.abc import Iterable, Sequence
from datetime import datetime, timedelta

from sqlalchemy import select, update
from sqlalchemy.orm import Session
from uuid_utils.compat import uuid7

from app.security import audit
from app.security.audit import OPERATOR
from app.security.caller import Caller, Scope
from app.storage.database import database_time
from app.tables import ApiKey, AuditAction

_SCHEME = "galloping_"
_RANDOM_BYTES = 24
_SHOWN = len(_SCHEME) + 8  # of the random part 160 bits stay unknown
_USE_RECORDED_EVERY = timedelta(minutes=10)


class NotOneKey(LookupError):
    """Raised when what was said of a key fits none or several."""


def create(
    session: Session, owner: str, scopes: Iterable[Scope], name: str | None, expires_at: datetime | None
) -> tuple[ApiKey, str]:
    """Make a key of an owner; return its row, and its text, which can never be had again."""
    text = _SCHEME + secrets.token_hex(_RANDOM_BYTES)
    key = ApiKey(
        id=uuid7(),
        created_at=database_time(session),
        expires_at=expires_at,
        owner=owner,
        name=name,
        prefix=text[:_SHOWN],
        digest=digest_of(text),
        scopes=sorted(scope.value for scope in scopes),
    )
    session.add(key)
    audit.record(session, OPERATOR, AuditAction.KEY_CREATED, key.id, f"{key.prefix} of {owner}: {' '.join(key.scopes)}")
    return key, text


def digest_of(text: str) -> str:
    """Return what is kept of a key."""
    return hashlib.sha256(text.encode()).hexdigest()


def present(session: Session, digest: str) -> tuple[Caller | None, bool]:
    """Return whose key this is, None if it is unknown, revoked or expired; and whether its use should be recorded."""
    now = database_time(session)  # asked for before it is known whether it is needed
    key = session.scalars(select(ApiKey).where(ApiKey.digest == digest)).one_or_none()
    if key is None:
        return None, False
    stale = key.used_at is None or key.used_at <= now - _USE_RECORDED_EVERY
    return (_caller(key) if _is_good(key, now) else None), stale


def record_use(session: Session, digest: str) -> None:
    """Note that a key was shown just now, and put it on record if it was one that is no longer good."""
    now = database_time(session)
    key = session.scalars(select(ApiKey).where(ApiKey.digest == digest)).one()
    if not _is_good(key, now):
        audit.record(session, _caller(key), AuditAction.KEY_REFUSED, key.id, key.prefix)
    session.execute(update(ApiKey).where(ApiKey.id == key.id).values(used_at=now))


def any_exist(session: Session) -> bool:
    """Tell whether there is any key, be it a revoked one: revoking the last must not open the service."""
    return session.execute(select(ApiKey.id).limit(1)).first() is not None


def listed(session: Session, owner: str | None = None) -> Sequence[ApiKey]:
    """Return all keys, or those of an owner, oldest first."""
    statement = select(ApiKey).order_by(ApiKey.created_at, ApiKey.id)
    return session.scalars(statement if owner is None else statement.where(ApiKey.owner == owner)).all()


def revoke(session: Session, said: str) -> ApiKey:
    """Revoke the key of an id or of the beginning of its text; one that is revoked stays so.

    Raises
    ------
    NotOneKey
        If that fits no key, or several.
    """
    key = _find(session, said)
    if key.revoked_at is None:
        key.revoked_at = database_time(session)
        audit.record(session, OPERATOR, AuditAction.KEY_REVOKED, key.id, f"{key.prefix} of {key.owner}")
    return key


def _find(session: Session, said: str) -> ApiKey:
    fitting = [key for key in listed(session) if str(key.id) == said or _begins_with(key, said)]
    if len(fitting) != 1:
        raise NotOneKey(f"{len(fitting) or 'no'} keys begin with {said[:_SHOWN]!r} or have it for their id")
    return fitting[0]


def _begins_with(key: ApiKey, said: str) -> bool:
    return len(said) > len(_SCHEME) and (key.prefix.startswith(said) or key.digest == digest_of(said))


def _is_good(key: ApiKey, now: datetime) -> bool:
    return key.revoked_at is None and (key.expires_at is None or now < key.expires_at)


def _caller(key: ApiKey) -> Caller:
    return Caller(key.owner, frozenset(map(Scope, key.scopes)), key.id)
