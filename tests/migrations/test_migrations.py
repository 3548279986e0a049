import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from alembic import command
from alembic.autogenerate import compare_metadata
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from alembic.util import CommandError
from sqlalchemy import Connection, Engine, Inspector, inspect, text

from app.runtime.processes import environment
from app.runtime.settings import Settings
from app.storage.database import make_engine
from app.storage.migration import Migrated, alembic_config, migrate, schema_fault
from app.tables import Base


@pytest.fixture
def engine(settings: Settings) -> Iterator[Engine]:
    made = make_engine(settings)
    yield made
    made.dispose()


def checks(inspector: Inspector) -> dict[str, dict[str | None, str]]:
    tables = sorted(set(inspector.get_table_names()) - {"alembic_version"})
    return {table: {c["name"]: c["sqltext"] for c in inspector.get_check_constraints(table)} for table in tables}


def columns(inspector: Inspector) -> dict[str, list[str]]:
    tables = sorted(set(inspector.get_table_names()) - {"alembic_version"})
    return {table: [column["name"] for column in inspector.get_columns(table)] for table in tables}


def differences(connection: Connection) -> list[object]:
    context = MigrationContext.configure(connection, opts={"compare_type": True})
    return list(compare_metadata(context, Base.metadata))


def test_migrated_database_equals_the_tables(settings: Settings, engine: Engine) -> None:
    migrate(settings)
    with engine.connect() as connection:
        assert differences(connection) == []
        migrated = checks(inspect(connection)), columns(inspect(connection))
    with engine.begin() as connection:
        command.downgrade(alembic_config(connection), "base")
    Base.metadata.create_all(engine)
    assert migrated == (checks(inspect(engine)), columns(inspect(engine)))
    assert set(migrated[0]["jobs"]) == {
        "ck_jobs_status",
        "ck_jobs_failure_kind",
        "ck_jobs_failed_with_kind",
        "ck_jobs_running_with_lease",
    }


def test_down_leaves_nothing_and_up_works_again(settings: Settings, engine: Engine) -> None:
    migrate(settings)
    with engine.begin() as connection:
        command.downgrade(alembic_config(connection), "base")
    assert inspect(engine).get_table_names() == ["alembic_version"]
    migrate(settings)
    with engine.connect() as connection:
        assert differences(connection) == []


def test_goes_to_a_named_revision_and_says_where_it_was(settings: Settings, engine: Engine) -> None:
    newest = _newest()
    assert migrate(settings) == Migrated(None, newest)
    assert migrate(settings, "0021") == Migrated(newest, "0021")
    with engine.connect() as connection:
        assert "tags" not in {column["name"] for column in inspect(connection).get_columns("batches")}
        assert schema_fault(connection) == "has an older schema: run `galloping migrate`"
    assert migrate(settings, "0022") == Migrated("0021", "0022")
    assert migrate(settings) == Migrated("0022", newest)
    assert migrate(settings) == Migrated(newest, newest)


@pytest.mark.parametrize("revision", ["base", "-1", "9999", ""])
def test_a_revision_that_is_not_known_changes_nothing(settings: Settings, engine: Engine, revision: str) -> None:
    migrate(settings)
    with pytest.raises(CommandError, match=f"knows no revision {revision}, only 0001 to {_newest()}"):
        migrate(settings, revision)
    with engine.connect() as connection:
        assert schema_fault(connection) is None


def test_missing_column_would_be_seen(settings: Settings, engine: Engine) -> None:
    migrate(settings)
    with engine.begin() as connection:
        connection.execute(text("ALTER TABLE jobs DROP COLUMN engine_version"))
        assert len(differences(connection)) == 1


def test_several_at_once_migrate_once(settings: Settings, engine: Engine) -> None:
    imports = "from app.runtime.settings import get_settings; from app.storage.migration import migrate"
    script = f"{imports}; migrate(get_settings())"
    commands = [
        subprocess.Popen([sys.executable, "-c", script], env=environment(settings), stderr=subprocess.PIPE)
        for _ in range(4)
    ]
    errors = [process.communicate(timeout=60)[1].decode() for process in commands]
    assert [(process.returncode, error) for process, error in zip(commands, errors, strict=True)] == [(0, "")] * 4
    with engine.connect() as connection:
        assert connection.execute(text("SELECT version_num FROM alembic_version")).scalars().all() == [_newest()]


def test_alembic_command_works_for_those_who_write_migrations(tmp_path: Path) -> None:
    root = Path(__file__).parents[2]
    arguments = [sys.executable, "-m", "alembic", "-x", f"url=sqlite:///{tmp_path}/scratch.sqlite3"]
    subprocess.run([*arguments, "upgrade", "head"], cwd=root, check=True, capture_output=True)
    done = subprocess.run([*arguments, "check"], cwd=root, check=True, capture_output=True, text=True)
    assert "No new upgrade operations detected" in done.stdout


def _newest() -> str:
    head = ScriptDirectory(str(Path(__file__).parents[2] / "migrations")).get_current_head()
    assert head is not None
    return head
