import base64
from datetime import UTC, datetime, timedelta, timezone
from uuid import UUID

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.http.paging import BadCursor, decode, encode

PLACE = (datetime(2026, 11, 22, 10, 0, 0, 123456, tzinfo=UTC), UUID("0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e"))


@given(st.datetimes(min_value=datetime(1971, 1, 1), max_value=datetime(2999, 1, 1)), st.uuids(), st.binary(min_size=1))
def test_a_cursor_leads_back_to_its_place(moment: datetime, identity: UUID, key: bytes) -> None:
    place = (moment.replace(tzinfo=UTC), identity)
    assert decode(key, encode(key, place)) == place


def test_a_cursor_keeps_the_moment_whatever_its_zone() -> None:
    moment = datetime(2026, 11, 22, 12, 0, tzinfo=timezone(timedelta(hours=2)))
    assert decode(b"key", encode(b"key", (moment, PLACE[1])))[0] == datetime(2026, 11, 22, 10, 0, tzinfo=UTC)


def test_another_key_refuses_the_cursor() -> None:
    with pytest.raises(BadCursor):
        decode(b"other", encode(b"key", PLACE))


@pytest.mark.parametrize("position", range(40))
def test_a_change_of_any_byte_is_seen(position: int) -> None:
    raw = bytearray(base64.urlsafe_b64decode(encode(b"key", PLACE)))
    raw[position] ^= 1
    with pytest.raises(BadCursor):
        decode(b"key", base64.urlsafe_b64encode(raw).decode())


@given(st.text(max_size=100))
def test_any_other_text_is_refused(text: str) -> None:
    with pytest.raises(BadCursor):
        decode(b"key", text)
