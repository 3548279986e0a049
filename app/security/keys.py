"""API keys: create, look up, list, revoke. The caller commits the transaction.

The text of a key has 192 random bits after a visible prefix and is shown once. The database keeps its SHA-256 and finds
keys by it. A slow hash would protect a guessable password, but a random key needs none, and nobody can choose a hash to
learn from response times. A valid, expired or unknown key costs the same queries. Recording the use of a known key, at
most every ten minutes, is the only extra one.
"""

import hashlib
import secrets
from collections.abc import Iterable, Sequence
from datetime import datetime, timedelta

from sqlalchemy import func, or_, select, update
from sqlalchemy.orm import Session
from uuid_utils.compat import uuid7

from app.security import audit
from app.security.audit import OPERATOR
from app.security.caller import LOCAL, Caller, Scope
from app.storage.database import database_time
from app.tables import ApiKey, AuditAction, Batch, Job

_SCHEME = "galloping_"
_RANDOM_BYTES = 24
_SHOWN = len(_SCHEME) + 8  # 160 bits of the random part stay secret
_USE_RECORDED_EVERY = timedelta(minutes=10)


class NotOneKey(LookupError):
    """Raised when an id or prefix matches no key or several."""


def create(
    session: Session, owner: str, scopes: Iterable[Scope], name: str | None, expires_at: datetime | None
) -> tuple[ApiKey, str]:
    """Create a key for an owner; return its row and its text, which cannot be recovered later."""
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
    """Return the digest under which a key is stored."""
    return hashlib.sha256(text.encode()).hexdigest()


def look_up(session: Session, digest: str) -> tuple[Caller | None, bool]:
    """Return the caller of a valid key, otherwise None; and whether to record that the key was used."""
    now = database_time(session)  # always queried, so that unknown keys take as long as known ones
    key = session.scalars(select(ApiKey).where(ApiKey.digest == digest)).one_or_none()
    if key is None:
        return None, False
    stale = key.used_at is None or key.used_at <= now - _USE_RECORDED_EVERY
    return (_caller(key) if _is_valid(key, now) else None), stale


def valid_digests(session: Session) -> frozenset[str]:
    """Return the digests of all valid keys."""
    good = ApiKey.revoked_at.is_(None), or_(ApiKey.expires_at.is_(None), ApiKey.expires_at > database_time(session))
    return frozenset(session.scalars(select(ApiKey.digest).where(*good)))


def record_use(session: Session, digest: str) -> None:
    """Record that a key was used now; if it is no longer valid, add that to the audit record."""
    now = database_time(session)
    key = session.scalars(select(ApiKey).where(ApiKey.digest == digest)).one()
    if not _is_valid(key, now):
        audit.record(session, _caller(key), AuditAction.KEY_REFUSED, key.id, key.prefix)
    session.execute(update(ApiKey).where(ApiKey.id == key.id).values(used_at=now))


def made_before(session: Session) -> int:
    """Return how many jobs and batches belong to `local`, as whom everything is made until a key exists."""
    jobs = select(func.count()).select_from(Job).where(Job.owner == LOCAL.owner, Job.batch_id.is_(None))
    batches = select(func.count()).select_from(Batch).where(Batch.owner == LOCAL.owner)
    return (session.scalar(jobs) or 0) + (session.scalar(batches) or 0)


def any_exist(session: Session) -> bool:
    """Tell whether any key exists, even a revoked one: revoking the last key must not open the service."""
    return session.execute(select(ApiKey.id).limit(1)).first() is not None


def listed(session: Session, owner: str | None = None) -> Sequence[ApiKey]:
    """Return all keys, or those of one owner, oldest first."""
    statement = select(ApiKey).order_by(ApiKey.created_at, ApiKey.id)
    return session.scalars(statement if owner is None else statement.where(ApiKey.owner == owner)).all()


def revoke(session: Session, name: str) -> ApiKey:
    """Revoke the key with this id or beginning of its text; a revoked key stays revoked.

    Raises
    ------
    NotOneKey
        If it matches no key, or several.
    """
    key = _find(session, name)
    if key.revoked_at is None:
        key.revoked_at = database_time(session)
        audit.record(session, OPERATOR, AuditAction.KEY_REVOKED, key.id, f"{key.prefix} of {key.owner}")
    return key


def _find(session: Session, name: str) -> ApiKey:
    found = [key for key in listed(session) if str(key.id) == name or _begins_with(key, name)]
    if len(found) != 1:
        raise NotOneKey(f"{len(found) or 'no'} keys have the id or beginning {name[:_SHOWN]!r}")
    return found[0]


def _begins_with(key: ApiKey, text: str) -> bool:
    return len(text) > len(_SCHEME) and (key.prefix.startswith(text) or key.digest == digest_of(text))


def _is_valid(key: ApiKey, now: datetime) -> bool:
    return key.revoked_at is None and (key.expires_at is None or now < key.expires_at)


def _caller(key: ApiKey) -> Caller:
    return Caller(key.owner, frozenset(map(Scope, key.scopes)), key.id)
