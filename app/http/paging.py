"""Opaque cursors for keyset paging: the position of the last row, signed so that clients cannot forge one."""

import base64
import binascii
import hashlib
import hmac
from datetime import UTC, datetime
from uuid import UUID

_SIGNATURE_BYTES = 16
_STAMP_BYTES = 8
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)

Place = tuple[datetime, UUID]


class BadCursor(ValueError):
    """Raised when a cursor was not signed with this key."""


def encode(key: bytes, place: Place) -> str:
    """Return the cursor for a position."""
    created_at, identity = place
    delta = created_at - _EPOCH
    microseconds = (delta.days * 86_400 + delta.seconds) * 1_000_000 + delta.microseconds
    payload = microseconds.to_bytes(_STAMP_BYTES, "big") + identity.bytes
    return seal(key, payload)


def decode(key: bytes, cursor: str) -> Place:
    """Return the position in a cursor.

    Raises
    ------
    BadCursor
        If `encode` did not create it with this key.
    """
    payload = unseal(key, cursor)
    microseconds = int.from_bytes(payload[:_STAMP_BYTES], "big")
    seconds, fraction = divmod(microseconds, 1_000_000)
    return datetime.fromtimestamp(seconds, UTC).replace(microsecond=fraction), UUID(bytes=payload[_STAMP_BYTES:])


def seal(key: bytes, payload: bytes) -> str:
    """Return a payload and its signature as text."""
    return base64.urlsafe_b64encode(_sign(key, payload) + payload).decode()


def unseal(key: bytes, cursor: str) -> bytes:
    """Return the payload of a text that `seal` created with this key.

    Raises
    ------
    BadCursor
        If `seal` did not create it with this key.
    """
    try:
        raw = base64.b64decode(cursor.encode("ascii"), altchars=b"-_", validate=True)
    except (binascii.Error, UnicodeEncodeError) as error:
        raise BadCursor("the cursor is not one that this service issued") from error
    signature, payload = raw[:_SIGNATURE_BYTES], raw[_SIGNATURE_BYTES:]
    if not hmac.compare_digest(signature, _sign(key, payload)):
        raise BadCursor("the cursor is not one that this service issued")
    return payload


def _sign(key: bytes, payload: bytes) -> bytes:
    return hmac.new(key, b"galloping-cursor:" + payload, hashlib.sha256).digest()[:_SIGNATURE_BYTES]
