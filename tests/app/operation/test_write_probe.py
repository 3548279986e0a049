import os
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from sqlalchemy import text
from sqlalchemy.exc import OperationalError

from app.http.problems import MEDIA_TYPE
from app.operation.write_probe import WriteProbe
from app.runtime.settings import Settings
from app.storage.database import make_engine
from app.storage.migration import migrate
from tests import servers
from tests.app import service
from tests.documents import short_request

KEY = {"Idempotency-Key": "one"}
NOBODY = 65534


@contextmanager
def folder_of_an_ordinary_user() -> Iterator[Path]:
    """Give a folder of its own to a user whom modes hold back, whom root is not."""
    folder = Path(tempfile.mkdtemp())
    root = os.geteuid() == 0
    if root:
        os.chown(folder, NOBODY, -1)
        os.seteuid(NOBODY)
    try:
        yield folder
    finally:
        if root:
            os.seteuid(0)
        shutil.rmtree(folder)


@pytest.mark.parametrize("what", ["file", "folder"])
def test_what_may_not_be_written_is_named(what: str) -> None:
    now = [0.0]
    with folder_of_an_ordinary_user() as folder:
        settings = Settings(data_dir=folder)
        migrate(settings)
        engine = make_engine(settings, impatient=True)
        probe = WriteProbe(engine, lambda: now[0])
        assert probe.state() == "ok"
        place, mode = (folder / "galloping.sqlite3", 0o400) if what == "file" else (folder, 0o500)
        keeper = make_engine(settings).connect()  # as a running service: the journal stays
        keeper.execute(text("SELECT 1"))
        keeper.rollback()
        place.chmod(mode)
        assert probe.state() == "ok"  # not tried again so soon
        now[0] += 3.0
        told = {"file": "takes no changes", "folder": "its folder cannot be written to: Permission denied"}
        assert probe.state() == told[what]
        for changed in (place, *folder.glob("*-wal")):  # the journal took the mode of its file
            changed.chmod(0o700)
        now[0] += 3.0
        assert probe.state() == "ok"
        keeper.close()
        keeper.engine.dispose()
        engine.dispose()


def test_database_that_does_not_answer_is_no_finding(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path)
    migrate(settings)
    engine = make_engine(settings, impatient=True)
    (tmp_path / "galloping.sqlite3").unlink()
    with pytest.raises(OperationalError):
        WriteProbe(engine).state()


def test_server_that_takes_no_changes_is_told(postgres_address: str, tmp_path: Path) -> None:
    with servers.postgres_database(postgres_address) as address:
        settings = Settings(data_dir=tmp_path, database_url=address)
        with service.running(settings) as client:
            assert client.get("/health/ready").status_code == 200
            engine = make_engine(settings)
            with engine.begin() as connection:
                held = f'ALTER DATABASE "{engine.url.database}" SET default_transaction_read_only = on'
                connection.execute(text(held))
            engine.dispose()
            time.sleep(2.1)  # until the service tries again
            answer = client.get("/health/ready")
    assert answer.status_code == 503
    assert answer.json()["checks"]["database"] == "takes no changes"


def test_posts_to_a_server_that_takes_no_changes_are_answered_by_503(postgres_address: str, tmp_path: Path) -> None:
    line = {"lines": [short_request()["line"]], "analysis": short_request()["analysis"]}
    with servers.postgres_database(postgres_address) as address:
        settings = Settings(data_dir=tmp_path, database_url=address)
        with service.running(settings) as client:
            job = service.submit(client)["id"]
            switch(settings, "on")
            refused = [client.post("/v1/jobs", json=short_request(), headers=key) for key in ({}, KEY)]
            refused += [client.post("/v1/batches", json=line, headers=key) for key in ({}, KEY)]
            refused += [client.delete(f"/v1/jobs/{job}"), client.post(f"/v1/jobs/{job}/cancel")]
            for answer in refused:
                assert answer.status_code == 503, answer.text
                assert answer.headers["content-type"] == MEDIA_TYPE
                assert answer.headers["retry-after"] == "5"
                assert answer.json()["type"] == "/problems/unavailable"
                assert answer.json()["detail"] == "The database takes no changes."
            assert client.get(f"/v1/jobs/{job}").json()["status"] == "accepted"  # what is there can be read
            switch(settings, "off")
            assert client.post("/v1/jobs", json=short_request(), headers=KEY).status_code == 202  # its key is free
            assert len(client.get("/v1/jobs").json()["jobs"]) == 2
            assert client.get("/v1/batches").json()["batches"] == []


def switch(settings: Settings, to: str) -> None:
    """Let the server take changes or not, and end all connections, which would go on as they began."""
    engine = make_engine(settings)
    with engine.begin() as connection:
        connection.execute(text("SET TRANSACTION READ WRITE"))
        name = engine.url.database
        connection.execute(text(f'ALTER DATABASE "{name}" SET default_transaction_read_only = {to}'))
        others = (
            "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = :name AND pid <> pg_backend_pid()"
        )
        connection.execute(text(others), {"name": name})
    engine.dispose()
