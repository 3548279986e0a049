from datetime import timedelta
from pathlib import Path
from uuid import UUID, uuid4

import pytest
from itsdangerous import URLSafeTimedSerializer
from sqlalchemy import func, select, update
from sqlalchemy.orm import Session, sessionmaker

from app.runtime.settings import Settings
from app.runtime.signing import make_signing_key
from app.security import sessions as browser_sessions
from app.security.sessions import COOKIE
from app.tables import EndedSession

DIGEST = "5f" * 32


def started(data_dir: Path) -> Settings:
    found = Settings(data_dir=data_dir)
    make_signing_key(found)
    return found


@pytest.fixture
def own(tmp_path: Path) -> Settings:
    return started(tmp_path)


def test_a_session_gives_back_the_digest_of_its_key(own: Settings) -> None:
    text = browser_sessions.issue(own, DIGEST)
    shown = browser_sessions.shown_by(own, f"other=1; {COOKIE}={text}")
    assert shown is not None and (shown.digest, type(shown.session)) == (DIGEST, UUID)
    other = browser_sessions.shown_by(own, f"{COOKIE}={browser_sessions.issue(own, DIGEST)}")
    assert other is not None and other.session != shown.session


@pytest.mark.parametrize("cookies", ["", "other=1", f"{COOKIE}=forged", f"{COOKIE}=", "=;=", "\x00"])
def test_what_is_no_session_gives_nothing(own: Settings, cookies: str) -> None:
    assert browser_sessions.shown_by(own, cookies) is None


def test_a_session_of_another_service_or_an_old_one_gives_nothing(
    own: Settings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = started(tmp_path / "other")
    assert browser_sessions.shown_by(own, f"{COOKIE}={browser_sessions.issue(other, DIGEST)}") is None
    text = browser_sessions.issue(own, DIGEST)
    monkeypatch.setattr(browser_sessions, "LASTS_SECONDS", -1)
    assert browser_sessions.shown_by(own, f"{COOKIE}={text}") is None


def test_a_mark_of_a_form_is_no_session_and_is_for_one_caller_only(own: Settings) -> None:
    mark = browser_sessions.form_mark(own, "north key")
    assert browser_sessions.is_form_mark(own, "north key", mark)
    assert not browser_sessions.is_form_mark(own, "south key", mark)
    assert not browser_sessions.is_form_mark(own, "north key", browser_sessions.issue(own, "north key"))
    assert browser_sessions.shown_by(own, f"{COOKIE}={mark}") is None
    assert isinstance(browser_sessions._serializer(own, "form"), URLSafeTimedSerializer)


def test_an_ended_session_is_kept_until_its_cookie_has_expired(sessions: sessionmaker[Session]) -> None:
    number = uuid4()
    for _ in range(2):  # it may be ended by two at once
        with sessions.begin() as session:
            assert not browser_sessions.is_ended(session, uuid4())
            browser_sessions.end(session, number)
            browser_sessions.forget_expired(session)
    with sessions.begin() as session:
        assert browser_sessions.is_ended(session, number)
        row = session.get_one(EndedSession, number)
        left = row.expires_at - session.execute(select(func.now())).scalar_one().replace(tzinfo=row.expires_at.tzinfo)
        assert left > timedelta(seconds=browser_sessions.LASTS_SECONDS)
        session.execute(update(EndedSession).values(expires_at=row.expires_at - timedelta(days=2)))
    with sessions.begin() as session:
        browser_sessions.forget_expired(session)
        assert not browser_sessions.is_ended(session, number)
