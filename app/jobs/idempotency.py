"""Idempotency keys: perform a POST once, store its answer under the key, and return it to later requests with that key.

The row of a key is written in the transaction that creates what the POST asks for, so both exist or neither does. A
body received over several transactions holds its key under a lease that its process renews. If the process dies, the
key is soon free; if it returns late, it finds the key with another request. The caller commits the transaction.
"""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import timedelta
from typing import Any
from uuid import UUID, uuid4

from sqlalchemy import ColumnElement, and_, delete, or_, select, tuple_, update
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from app.storage.steady_clock import steady_time
from app.tables import IdempotencyKey

KEPT = timedelta(hours=24)


class KeyTaken(Exception):
    """Raised to undo a transaction whose key an earlier request uses, or a later one has taken over."""


@dataclass(frozen=True, slots=True)
class Key:
    """An owner's key as one request holds it."""

    owner: str
    value: str
    holder: UUID


@dataclass(frozen=True, slots=True)
class Answer:
    """The stored answer: status, relevant headers, and the text of the body."""

    status: int
    headers: Mapping[str, str]
    body: str


def new_key(owner: str, value: str) -> Key:
    """Return a key for a request that has just arrived."""
    return Key(owner, value, uuid4())


def fingerprint(*parts: str) -> str:
    """Return the SHA-256 that identifies a request, from the parts that define it."""
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()


@dataclass(frozen=True, slots=True)
class Kept:
    """What to store under a key: the fingerprint of the request and its answer."""

    key: Key
    request: str
    answer: Answer


def keep(session: Session, kept: Sequence[Kept]) -> set[UUID]:
    """Store answers for as long as keys are kept; return the holders of the keys that were free.

    A key in use stays unchanged; of two equal keys the first wins. On PostgreSQL this waits for a transaction that is
    about to use a key. The keys are locked in a fixed order, so two such groups never deadlock.
    """
    first = {(item.key.owner, item.key.value): item for item in reversed(kept)}
    ordered = [first[place] for place in sorted(first)]
    return _take(
        session, KEPT, [(item.key, {"fingerprint": item.request, **_columns(item.answer)}) for item in ordered]
    )


def hold(session: Session, key: Key, lease: timedelta) -> None:
    """Reserve a key whose answer follows in a later transaction; the reservation ends with the lease unless renewed.

    Raises
    ------
    KeyTaken
        If the key is in use.
    """
    nothing = {"fingerprint": None, "status": None, "headers": None, "body": None}
    if not _take(session, lease, [(key, nothing)]):
        raise KeyTaken


def renew(session: Session, key: Key, lease: timedelta) -> None:
    """Extend the reservation of a key by another lease.

    Raises
    ------
    KeyTaken
        If another request has taken the key.
    """
    _change(session, key, {"expires_at": steady_time(session) + lease})


def finish(session: Session, key: Key, request: str, answer: Answer) -> None:
    """Store the answer under a reserved key.

    Raises
    ------
    KeyTaken
        If another request has taken the key.
    """
    end = steady_time(session) + KEPT
    _change(session, key, {"expires_at": end, "fingerprint": request, **_columns(answer)})


def release(session: Session, key: Key) -> None:
    """Free a reserved key, because nothing was created under it."""
    session.execute(delete(IdempotencyKey).where(*_held(key)))


def forget(session: Session, keys: Sequence[Key]) -> None:
    """Free keys whose answers this transaction has stored, because what they answer is not done."""
    place = tuple_(IdempotencyKey.owner, IdempotencyKey.key, IdempotencyKey.holder)
    session.execute(delete(IdempotencyKey).where(place.in_([(key.owner, key.value, key.holder) for key in keys])))


def find(session: Session, key: Key) -> tuple[str, Answer] | None:
    """Return the fingerprint and the answer under a key, None if there is no answer yet."""
    statement = select(IdempotencyKey).where(IdempotencyKey.owner == key.owner, IdempotencyKey.key == key.value)
    row = session.scalars(statement).one_or_none()
    if row is None or row.fingerprint is None or row.status is None or row.body is None:
        return None
    return row.fingerprint, Answer(row.status, row.headers or {}, row.body)


def forget_expired(session: Session) -> None:
    """Delete expired keys; keep a key without an answer longer, for a sender that is only slow."""
    now = steady_time(session)
    over = and_(IdempotencyKey.expires_at <= now, IdempotencyKey.status.is_not(None))
    session.execute(delete(IdempotencyKey).where(or_(over, IdempotencyKey.expires_at <= now - KEPT)))


def _take(session: Session, lifetime: timedelta, wanted: Sequence[tuple[Key, Mapping[str, object]]]) -> set[UUID]:
    """Insert keys, or take over expired ones, in one statement; return the holders of the keys taken."""
    now = steady_time(session)
    rows = [
        {"owner": key.owner, "key": key.value, "holder": key.holder, "expires_at": now + lifetime, **values}
        for key, values in wanted
    ]
    insert = postgresql.insert if session.get_bind().dialect.name == "postgresql" else sqlite.insert
    statement = insert(IdempotencyKey)
    changed = {name: statement.excluded[name] for name in rows[0] if name not in {"owner", "key"}}
    over = IdempotencyKey.expires_at <= now
    taking = statement.on_conflict_do_update(index_elements=["owner", "key"], set_=changed, where=over)
    return set(session.scalars(taking.returning(IdempotencyKey.holder), rows))


def _change(session: Session, key: Key, values: Mapping[str, object]) -> None:
    statement = update(IdempotencyKey).where(*_held(key)).values(**values).returning(IdempotencyKey.key)
    if session.execute(statement.execution_options(synchronize_session=False)).first() is None:
        raise KeyTaken


def _held(key: Key) -> tuple[ColumnElement[bool], ...]:
    mine = IdempotencyKey.owner == key.owner, IdempotencyKey.key == key.value, IdempotencyKey.holder == key.holder
    return *mine, IdempotencyKey.status.is_(None)


def _columns(answer: Answer) -> dict[str, Any]:
    return {"status": answer.status, "headers": dict(answer.headers), "body": answer.body}
