"""Keys under which a POST is done once: the first answer is kept beside what it made, and given to who asks again.

The row of a key is written in the transaction that makes the rest, so that there is both or neither. A body that comes
in over several transactions holds its key meanwhile, as a lease that its process renews: one that dies holds up nobody
for long, and one that comes back late finds its key with another. The caller commits the transaction.
"""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import timedelta
from typing import Any
from uuid import UUID, uuid4

from sqlalchemy import ColumnElement, and_, delete, or_, select, update
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from app.storage.database import database_time
from app.tables import IdempotencyKey

KEPT = timedelta(hours=24)


class KeyTaken(Exception):
    """Raised to undo a transaction whose key belongs to an earlier request, or by now to a later one."""


@dataclass(frozen=True, slots=True)
class Key:
    """A key of an owner, as one request holds it."""

    owner: str
    value: str
    holder: UUID


@dataclass(frozen=True, slots=True)
class Answer:
    """What is given again: status, headers that matter, and the text of the body."""

    status: int
    headers: Mapping[str, str]
    body: str


def new_key(owner: str, value: str) -> Key:
    """Return a key for a request that has just come in."""
    return Key(owner, value, uuid4())


def fingerprint(*parts: str) -> str:
    """Return the SHA-256 by which a request is known again, from what makes it that request."""
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()


@dataclass(frozen=True, slots=True)
class Kept:
    """What is to be kept under a key: the fingerprint of the request, and its answer."""

    key: Key
    request: str
    answer: Answer


def keep(session: Session, kept: Sequence[Kept]) -> set[UUID]:
    """Keep answers for as long as keys are kept, and return the holders of the keys that were free.

    A key that is in use stays as it is, and of two equal ones the first gets it. On PostgreSQL this waits for a
    transaction that is about to use a key; the keys are taken in order, so that two such groups never wait for each
    other.
    """
    first = {(item.key.owner, item.key.value): item for item in reversed(kept)}
    ordered = [first[place] for place in sorted(first)]
    return _take(
        session, KEPT, [(item.key, {"fingerprint": item.request, **_columns(item.answer)}) for item in ordered]
    )


def hold(session: Session, key: Key, lease: timedelta) -> None:
    """Reserve a key whose answer comes in a later transaction; it is free again after the lease unless that is renewed.

    Raises
    ------
    KeyTaken
        If the key is in use.
    """
    nothing = {"fingerprint": None, "status": None, "headers": None, "body": None}
    if not _take(session, lease, [(key, nothing)]):
        raise KeyTaken


def renew(session: Session, key: Key, lease: timedelta) -> None:
    """Go on holding a key for another lease.

    Raises
    ------
    KeyTaken
        If another has taken it meanwhile.
    """
    _change(session, key, {"expires_at": database_time(session) + lease})


def finish(session: Session, key: Key, request: str, answer: Answer) -> None:
    """Keep the answer under a key that is held.

    Raises
    ------
    KeyTaken
        If another has taken it meanwhile.
    """
    end = database_time(session) + KEPT
    _change(session, key, {"expires_at": end, "fingerprint": request, **_columns(answer)})


def release(session: Session, key: Key) -> None:
    """Give up a key that is held, since nothing was made under it."""
    session.execute(delete(IdempotencyKey).where(*_held(key)))


def find(session: Session, key: Key) -> tuple[str, Answer] | None:
    """Return fingerprint and answer under a key, None if there is no answer yet."""
    statement = select(IdempotencyKey).where(IdempotencyKey.owner == key.owner, IdempotencyKey.key == key.value)
    row = session.scalars(statement).one_or_none()
    if row is None or row.fingerprint is None or row.status is None or row.body is None:
        return None
    return row.fingerprint, Answer(row.status, row.headers or {}, row.body)


def forget_expired(session: Session) -> None:
    """Remove the keys whose time is over; one without an answer stays longer, for a sender who is only slow."""
    now = database_time(session)
    over = and_(IdempotencyKey.expires_at <= now, IdempotencyKey.status.is_not(None))
    session.execute(delete(IdempotencyKey).where(or_(over, IdempotencyKey.expires_at <= now - KEPT)))


def _take(session: Session, lasting: timedelta, wanted: Sequence[tuple[Key, Mapping[str, object]]]) -> set[UUID]:
    """Insert the rows of keys, or put them in the place of some whose time is over; return the holders of those taken.

    That is one statement, however many there are.
    """
    now = database_time(session)
    rows = [
        {"owner": key.owner, "key": key.value, "holder": key.holder, "expires_at": now + lasting, **values}
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
