from pathlib import Path
from typing import Any

import pytest
from pydantic import SecretStr, ValidationError

from app.runtime.settings import Settings


def test_defaults_need_no_other_server(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path)
    assert settings.database_url == f"sqlite:///{tmp_path}/galloping.sqlite3"
    assert settings.broker_url == "filesystem://localhost"
    assert settings.max_attempts == 3
    assert settings.max_body_bytes == 20_000_000
    assert settings.signing_secret is None


def test_quotas_of_an_owner_allow_the_largest_batch_and_follow_the_database(tmp_path: Path) -> None:
    embedded, server = Settings(data_dir=tmp_path), Settings(database_url="postgresql://a:b@localhost/d")
    assert (embedded.stored_bytes_per_owner, server.stored_bytes_per_owner) == (10_000_000_000, 100_000_000_000)
    assert embedded.waiting_jobs_per_owner == 2 * embedded.max_batch_lines
    assert embedded.running_jobs_per_owner == 0
    with pytest.raises(ValidationError):
        Settings(data_dir=tmp_path, stored_bytes_per_owner=-1)


def test_relative_data_directory_becomes_absolute(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    settings = Settings(data_dir=Path("here"))
    assert settings.data_dir == tmp_path / "here"
    assert settings.database_url == f"sqlite:///{tmp_path}/here/galloping.sqlite3"


@pytest.mark.parametrize("scheme", ["postgres", "postgresql", "postgresql+psycopg"])
def test_postgres_gets_its_driver(scheme: str) -> None:
    assert Settings(database_url=f"{scheme}://a:b@localhost/d").database_url == "postgresql+psycopg://a:b@localhost/d"


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("database_url", "mysql://a/b"),
        ("database_url", "sqlite"),
        ("broker_url", "amqp://a"),
        ("lease_seconds", 0.0),
        ("lease_seconds", float("inf")),
        ("max_attempts", 0),
        ("heartbeat_seconds", 16.0),  # more than half of the lease
        ("soft_time_limit_seconds", 3660.0),  # not below the hard limit
    ],
)
def test_bad_settings_are_refused(field: str, value: Any) -> None:
    with pytest.raises(ValidationError, match=field):
        Settings(**{field: value})


def test_child_processes_get_the_same_settings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    settings = Settings(data_dir=tmp_path, lease_seconds=4.5, worker_processes=7, signing_secret=SecretStr("s3cret"))
    for name, value in settings.environment().items():
        monkeypatch.setenv(name, value)
    assert Settings() == settings


def test_secret_is_not_shown(tmp_path: Path) -> None:
    assert "s3cret" not in repr(Settings(data_dir=tmp_path, signing_secret=SecretStr("s3cret")))


def test_secrets_may_stand_in_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    secrets = {
        "DATABASE_URL": "postgresql://a:b@localhost/d",
        "BROKER_URL": "redis://x@localhost",
        "SIGNING_SECRET": "s3",
    }
    for name, text in secrets.items():
        (tmp_path / name).write_text(f"{text}\n")
        monkeypatch.setenv(f"GALLOPING_{name}_FILE", str(tmp_path / name))
    settings = Settings()
    assert settings.database_url == "postgresql+psycopg://a:b@localhost/d"
    assert settings.broker_url == "redis://x@localhost"
    assert settings.signing_secret == SecretStr("s3")
    monkeypatch.setenv("GALLOPING_SIGNING_SECRET", "s4")  # what is set itself comes first
    assert Settings().signing_secret == SecretStr("s4")
    child = settings.environment()
    assert child["GALLOPING_SIGNING_SECRET"] == "s3"


def test_missing_file_of_a_secret_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GALLOPING_BROKER_URL_FILE", str(tmp_path / "none"))
    with pytest.raises(ValidationError, match=r"GALLOPING_BROKER_URL_FILE: .*none cannot be read"):
        Settings()


def test_proxies_reach_child_processes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GALLOPING_TRUSTED_PROXIES", "127.0.0.1, 2001:db8::/32")
    settings = Settings(data_dir=tmp_path)
    assert settings.trusted_proxies == ("127.0.0.1", "2001:db8::/32")
    monkeypatch.setenv("GALLOPING_TRUSTED_PROXIES", settings.environment()["GALLOPING_TRUSTED_PROXIES"])
    assert Settings(data_dir=tmp_path) == settings
