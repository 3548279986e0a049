import shutil
from pathlib import Path

import pytest
from sqlalchemy import text
from sqlalchemy.exc import OperationalError

from app.runtime.settings import Settings
from app.storage.database import make_engine, session_factory
from app.storage.migration import migrate
from tests.app import service


def test_connections_follow_the_file_and_never_make_one(tmp_path: Path) -> None:
    folder, aside = tmp_path / "here", tmp_path / "aside"
    file = folder / "a.sqlite3"
    engine = make_engine(Settings(data_dir=tmp_path / "data", database_url=f"sqlite:///{file}"))
    sessions = session_factory(engine)
    with sessions.begin() as session:
        session.execute(text("CREATE TABLE first (one INTEGER)"))
    with session_factory(engine, read_only=True)() as session:
        session.execute(text("SELECT * FROM first"))
    folder.rename(aside)
    with sessions() as session, pytest.raises(OperationalError, match="the file of the database is gone"):
        session.execute(text("SELECT 1"))
    assert not folder.exists()
    folder.mkdir()
    file.touch()
    with sessions() as session, pytest.raises(OperationalError, match="no such table"):
        session.execute(text("SELECT * FROM first"))
    shutil.rmtree(folder)
    aside.rename(folder)
    with sessions() as session:
        session.execute(text("SELECT * FROM first"))
    engine.dispose()


def test_replaced_data_directory_is_told_and_nothing_is_lost_in_the_old_one(tmp_path: Path) -> None:
    folder, aside = tmp_path / "data", tmp_path / "aside"
    settings = service.sqlite_settings(folder)
    with service.running(settings) as client:
        kept = service.submit(client)["id"]
        folder.rename(aside)
        answers = [client.get(f"/v1/jobs/{kept}"), client.post("/v1/jobs", json={}), client.get("/health/ready")]
        assert [answer.status_code for answer in answers] == [503, 422, 503]
        assert answers[0].json()["detail"] == "The database does not answer."
        assert answers[2].json()["checks"]["database"] == "cannot be reached"
        assert not folder.exists()
        folder.mkdir()
        migrate(settings)  # another start in the new directory
        assert client.get(f"/v1/jobs/{kept}").status_code == 404
        new = service.submit(client)["id"]
        shutil.rmtree(folder)
        aside.rename(folder)
        assert client.get(f"/v1/jobs/{kept}").status_code == 200
        assert client.get(f"/v1/jobs/{new}").status_code == 404
        assert client.get("/health/ready").status_code == 200
