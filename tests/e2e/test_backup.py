"""Backup and restore by the commands of docs/deployment.md: dump under a running service, lose everything, restore."""

import os
import shutil
import sqlite3
import subprocess
from pathlib import Path

from app.runtime.settings import Settings
from tests.documents import hasty_settings
from tests.e2e.operators import all_is_there, documented, work
from tests.embedded import serving
from tests.servers import binary, free_port, postgres_database, postgres_server


def run(command: list[str], folder: Path) -> None:
    subprocess.run([binary(command[0]), *command[1:]], check=True, cwd=folder, env=dict(os.environ), timeout=60.0)


def test_postgresql_is_dumped_lost_and_restored(tmp_path: Path) -> None:
    with postgres_server() as server, postgres_database(server) as address:
        settings = hasty_settings(tmp_path).model_copy(update={"database_url": address.replace("://", "+psycopg://")})
        with serving(settings, free_port()) as (_, client):
            made = work(client)
            run(documented("pg_dump", DATABASE=address), tmp_path)
        name = address.rpartition("/")[2]
        subprocess.run([binary("dropdb"), "--force", f"--maintenance-db={server}", name], check=True)
        shutil.rmtree(settings.data_dir / "broker", ignore_errors=True)
        run([word if word != "galloping" else name for word in documented("createdb", SERVER=server)], tmp_path)
        run(documented("pg_restore", DATABASE=address), tmp_path)
        with serving(settings, free_port()) as (_, client):
            all_is_there(client, *made)


def test_embedded_database_is_copied_lost_and_restored(tmp_path: Path) -> None:
    folder = tmp_path / "data"
    folder.mkdir()
    settings = Settings(
        **{**hasty_settings(tmp_path).model_dump(), "data_dir": folder, "database_url": _address(folder)}
    )
    with serving(settings, free_port()) as (_, client):
        made = work(client)
        client.get("/v1/jobs?limit=1").raise_for_status()  # its cursor is signed
        _, file, statement = documented("sqlite3")
        with sqlite3.connect(tmp_path / file) as connection:
            connection.execute(statement.replace("galloping.backup", str(tmp_path / "galloping.backup")))
        connection.close()
        _, _, secret, kept = documented("cp")
        shutil.copy2(tmp_path / secret, tmp_path / kept)
    shutil.rmtree(folder)
    folder.mkdir()
    shutil.move(tmp_path / "galloping.backup.sqlite3", folder / "galloping.sqlite3")
    shutil.move(tmp_path / "signing-secret.backup", folder / "signing-secret")
    with serving(settings, free_port()) as (_, client):
        all_is_there(client, *made)


def _address(folder: Path) -> str:
    return f"sqlite:///{folder}/galloping.sqlite3"
