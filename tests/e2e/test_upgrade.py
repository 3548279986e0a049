"""Upgrade and rollback by the commands of docs/deployment.md, with jobs that wait and run.

`released/0.5.0.sql` is a database as version 0.5.0 itself left it when it was killed: a job and a batch that are done,
a study at its second point, a job and a batch that wait. `released/0.5.0.json` has what that version answered.
"""

import json
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import httpx

from app.runtime.settings import Settings
from tests.app.command_line import run
from tests.documents import hasty_settings
from tests.e2e.operators import all_is_there, documented, work
from tests.embedded import serving, status, wait_for
from tests.servers import free_port, postgres_database, postgres_server

RELEASED = Path(__file__).parent / "released"
ANSWERS: dict[str, Any] = json.loads((RELEASED / "0.5.0.json").read_text())

Rows = dict[str, list[dict[str, Any]]]


def test_the_database_of_a_release_is_upgraded_and_taken_back(tmp_path: Path) -> None:
    settings = hasty_settings(tmp_path)
    file = tmp_path / "galloping.sqlite3"
    with closing(sqlite3.connect(file)) as database:
        database.executescript((RELEASED / "0.5.0.sql").read_text())
    released = rows(file)
    with serving(settings, free_port()) as (_, client):
        what_was_answered_is_answered(client)
        everything_ends_well(client)
    go_back(settings)
    back = rows(file)
    assert {name: columns(of) for name, of in back.items() if of} == {
        name: columns(of) for name, of in (released | {"orbits": []}).items() if of
    }
    assert set(back) == set(released)
    assert finished(released) <= finished(back)
    with serving(settings, free_port()) as (_, client):  # and forth again
        what_was_answered_is_answered(client)
        everything_ends_well(client)


def test_postgresql_goes_back_with_a_job_that_runs(tmp_path: Path) -> None:
    with postgres_server() as server, postgres_database(server) as address:
        settings = hasty_settings(tmp_path).model_copy(update={"database_url": address.replace("://", "+psycopg://")})
        with serving(settings, free_port()) as (_, client):
            made = work(client)
        go_back(settings)
        with serving(settings, free_port()) as (_, client):
            all_is_there(client, *made)


def what_was_answered_is_answered(client: httpx.Client) -> None:
    results = client.get(f"{ANSWERS['done']}/results").raise_for_status().json()
    lines = client.get(f"{ANSWERS['batch']}/results").raise_for_status().text.splitlines()
    assert (
        unsaid(
            {"results": ANSWERS["results"], "lines": ANSWERS["lines"]},
            {"results": results, "lines": [json.loads(line) for line in lines]},
        )
        == []
    )


def everything_ends_well(client: httpx.Client) -> None:
    for name in ("running", "waiting", "open_batch"):
        wait_for(client, ANSWERS[name], "successful")
    assert status(client, ANSWERS["running"])["attempt"] == 2
    frequencies = client.get(f"{ANSWERS['running']}/results/frequencies").raise_for_status().json()
    assert {row["span.horizontal_tension_n"] for row in frequencies["frequencies"]} == {25000.0, 25100.0, 25200.0}
    assert len(client.get(f"{ANSWERS['open_batch']}/results").raise_for_status().text.splitlines()) == 3


def go_back(settings: Settings) -> None:
    _, *words = documented("galloping migrate")
    place = {"GALLOPING_DATABASE_URL": settings.database_url, "GALLOPING_DATA_DIR": str(settings.data_dir)}
    done = run(*words, environment=place)
    assert (done.returncode, done.stdout) == (0, "")
    assert done.stderr.startswith("the schema is 0021 now; it was 00")


def rows(file: Path) -> Rows:
    with closing(sqlite3.connect(file)) as database:
        database.row_factory = sqlite3.Row
        names = [row["name"] for row in database.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
        return {name: [dict(row) for row in database.execute(f'SELECT * FROM "{name}"')] for name in names}


def columns(of: list[dict[str, Any]]) -> list[str]:
    return list(of[0])


def finished(of: Rows) -> set[str]:
    """Return the jobs that were done at the release and their results, each as a text."""
    ids = {job["id"] for job in of["jobs"] if job["created_at"] < "2026-11-30 12:15:20.5"}
    assert len(ids) == 2
    return {repr(row) for row in of["jobs"] if row["id"] in ids} | {
        repr(row) for row in of["results"] if row["job_id"] in ids
    }


def unsaid(before: Any, after: Any, place: str = "") -> list[str]:
    """Return where a later answer lacks what an earlier one had, or says something else; it may say more."""
    if isinstance(before, dict) and isinstance(after, dict):
        return [x for name in before for x in unsaid(before[name], after.get(name), f"{place}/{name}")]
    if isinstance(before, list) and isinstance(after, list) and len(before) == len(after):
        return [x for n, pair in enumerate(zip(before, after, strict=True)) for x in unsaid(*pair, f"{place}/{n}")]
    return [] if before == after else [f"{place}: {before!r} became {after!r}"]
