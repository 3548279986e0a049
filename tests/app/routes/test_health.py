import asyncio
import contextlib
import shutil
import socket
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import httpx
import pytest
from fastapi import FastAPI
from sqlalchemy import text
from sqlalchemy.orm import Session, sessionmaker

from app.main import create_app
from app.runtime.settings import Settings
from tests.app import service


def test_a_service_with_database_and_broker_is_ready(settings: Settings) -> None:
    with service.running(settings) as client:
        assert client.get("/health/live").json() == {"status": "ok", "checks": {}}
        answer = client.get("/health/ready")
    assert answer.status_code == 200
    assert answer.json() == {"status": "ok", "checks": {"database": "ok", "migrations": "ok", "broker": "ok"}}


def test_without_its_broker_it_is_alive_but_not_ready(tmp_path: Path) -> None:
    away = service.sqlite_settings(tmp_path, broker_url="redis://127.0.0.1:9/0", broker_timeout_seconds=0.3)
    with service.running(away) as client:
        answer = client.get("/health/ready")
        assert client.get("/health/live").status_code == 200
    assert answer.status_code == 503
    assert answer.json()["checks"] == {"database": "ok", "migrations": "ok", "broker": "cannot be reached"}


def test_a_database_of_another_revision_is_not_ready(settings: Settings, sessions: sessionmaker[Session]) -> None:
    with service.running(settings) as client:
        with sessions.begin() as session:
            session.execute(text("UPDATE alembic_version SET version_num = 'older'"))
        answer = client.get("/health/ready")
    assert answer.status_code == 503
    assert answer.json()["checks"] == {"database": "ok", "migrations": "not those of this version", "broker": "ok"}


@contextlib.contextmanager
def silent_server() -> Iterator[int]:
    """Give a port that takes connections and never says a word."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        yield listener.getsockname()[1]


def test_servers_that_never_answer_are_told_in_time(tmp_path: Path) -> None:
    with silent_server() as port, silent_server() as other:
        database, broker = f"postgresql://a@127.0.0.1:{port}/a", f"redis://127.0.0.1:{other}/0"
        app = create_app(Settings(data_dir=tmp_path, database_url=database, broker_url=broker))
        answer = asyncio.run(asyncio.wait_for(ask(app, "/health/ready"), 30.0))
    assert answer.status_code == 503
    assert set(answer.json()["checks"]) == {"database", "migrations", "broker"}
    assert "ok" not in answer.json()["checks"].values()


async def ask(app: FastAPI, path: str) -> httpx.Response:
    async with httpx.AsyncClient(transport=httpx.ASGITransport(app), base_url="http://test") as client:
        return await client.get(path)


def test_a_full_disk_is_not_ready(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with service.running(service.sqlite_settings(tmp_path)) as client:
        assert client.get("/health/ready").json()["checks"]["database"] == "ok"
        monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=4096))
        answer = client.get("/health/ready")
    assert answer.status_code == 503
    assert answer.json()["checks"]["database"] == "its disk is full"
