import subprocess
import sys
from pathlib import Path

import pytest
from pydantic import SecretStr, ValidationError

from app.runtime.settings import Settings
from app.runtime.weak_secrets import weak_secrets

GOOD = "d1bca6ef8f0244f0"
HERE = ("sqlite:////var/lib/galloping.sqlite3", "filesystem://localhost")
DEPLOYED = ("postgresql://galloping:Wn7qTq0c@postgres/galloping", "redis://:Tq0cWn7q@redis:6379/0")


@pytest.mark.parametrize(
    ("database", "broker"),
    [
        HERE,
        ("postgresql://postgres:postgres@127.0.0.1/x", "redis://:secret@localhost:6379/0"),
        ("postgresql:///galloping?host=/run/postgresql", "redis://[::1]"),
    ],
)
def test_what_is_on_one_machine_may_be_left_as_it_is(database: str, broker: str) -> None:
    assert weak_secrets(database, broker, None) == []
    assert weak_secrets(database, broker, "test") == []


@pytest.mark.parametrize("secret", [None, "", "short", "changeme", "d1bca6ef8f0244f"])
def test_a_deployment_needs_a_secret_for_its_cursors(secret: str | None) -> None:
    (said,) = weak_secrets(*DEPLOYED, secret)
    assert said.startswith("GALLOPING_SIGNING_SECRET must be")
    assert weak_secrets(*DEPLOYED, GOOD) == []


@pytest.mark.parametrize("password", ["postgres", "Password", "galloping", "changeme", "me", ""])
def test_passwords_of_examples_are_refused(password: str) -> None:
    (said,) = weak_secrets(f"postgresql+psycopg://me:{password}@db.example/x", HERE[1], GOOD)
    assert said.startswith("GALLOPING_DATABASE_URL has a password")
    (said,) = weak_secrets(HERE[0], f"redis://me:{password}@redis.example", GOOD)
    assert said.startswith("GALLOPING_BROKER_URL has a password")


def test_a_password_may_be_left_to_files_or_certificates() -> None:
    assert weak_secrets("postgresql://me@db.example/x", "rediss://redis.example", GOOD) == []


def test_settings_are_refused_without_showing_what_they_hold() -> None:
    with pytest.raises(ValidationError) as refused:
        Settings(database_url="postgresql://me:Wn7qTq0c@db.example/x", signing_secret=SecretStr("short-one"))
    assert "GALLOPING_SIGNING_SECRET must be a random text" in str(refused.value)
    assert "Wn7qTq0c" not in str(refused.value)
    assert "short-one" not in str(refused.value)


@pytest.mark.parametrize("command", ["serve", "worker", "api"])
def test_no_process_of_a_deployment_starts_with_a_weak_secret(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    monkeypatch.setenv("GALLOPING_DATABASE_URL", "postgresql://postgres:postgres@db.example/x")
    arguments = [sys.executable, "-m", "app.cli", command, "--data-dir", str(tmp_path)]
    ended = subprocess.run(arguments, capture_output=True, text=True, timeout=60.0, check=False)
    assert ended.returncode == 2
    assert ended.stderr.splitlines() == [
        "GALLOPING_DATABASE_URL has a password that is easy to guess; "
        "GALLOPING_SIGNING_SECRET must be set when the database or the broker is on another machine"
    ]
