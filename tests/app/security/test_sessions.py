from pathlib import Path

import pytest
from itsdangerous import URLSafeTimedSerializer

from app.runtime.settings import Settings
from app.runtime.signing import make_signing_key
from app.security import sessions

DIGEST = "5f" * 32


def started(data_dir: Path) -> Settings:
    found = Settings(data_dir=data_dir)
    make_signing_key(found)
    return found


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    return started(tmp_path)


def test_a_session_gives_back_the_digest_of_its_key(settings: Settings) -> None:
    text = sessions.issue(settings, DIGEST)
    assert sessions.digest_of(settings, f"other=1; {sessions.COOKIE}={text}") == DIGEST


@pytest.mark.parametrize("cookies", ["", "other=1", f"{sessions.COOKIE}=forged", f"{sessions.COOKIE}=", "=;=", "\x00"])
def test_what_is_no_session_gives_nothing(settings: Settings, cookies: str) -> None:
    assert sessions.digest_of(settings, cookies) is None


def test_a_session_of_another_service_or_an_old_one_gives_nothing(
    settings: Settings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = started(tmp_path / "other")
    assert sessions.digest_of(settings, f"{sessions.COOKIE}={sessions.issue(other, DIGEST)}") is None
    text = sessions.issue(settings, DIGEST)
    monkeypatch.setattr(sessions, "LASTS_SECONDS", -1)
    assert sessions.digest_of(settings, f"{sessions.COOKIE}={text}") is None


def test_a_mark_of_a_form_is_no_session_and_is_for_one_caller_only(settings: Settings) -> None:
    mark = sessions.form_mark(settings, "north key")
    assert sessions.is_form_mark(settings, "north key", mark)
    assert not sessions.is_form_mark(settings, "south key", mark)
    assert not sessions.is_form_mark(settings, "north key", sessions.issue(settings, "north key"))
    assert sessions.digest_of(settings, f"{sessions.COOKIE}={mark}") is None
    assert isinstance(sessions._serializer(settings, "form"), URLSafeTimedSerializer)
