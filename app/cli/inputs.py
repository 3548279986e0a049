"""Read what a command works on: request files, settings and the database."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from app.cli.console import BAD_INPUT, end, notice, refuse
from app.cli.exchanged import SUFFIXES, exchanged_request, with_defaults

if TYPE_CHECKING:
    from sqlalchemy.orm import Session, sessionmaker

    from app.runtime.settings import Settings


def read_request(
    line: Path,
    analysis: Path | None,
    study: Path | None,
    placement: Path | None = None,
    defaults: Path | None = None,
    *,
    remedies: Path | None = None,
) -> Any:
    """Build the request from its files; a file may add to a whole request, but not repeat a part of it.

    A file of a GIS or CIM program, told by its name, must hold one line.
    """
    document = _document(line, None if defaults is None else read_json(defaults))
    parts = {"analysis": analysis, "study": study, "placement": placement, "remedies": remedies}
    for name, path in parts.items():
        if path is None:
            continue
        if name in document:
            end(f"{name} is given twice: in {line} and in {path}", BAD_INPUT)
        document = {**document, name: read_json(path)}
    return document


def _document(path: Path, defaults: Any) -> dict[str, Any]:
    """Return the request in the file of a line, which may be the line alone."""
    if path.suffix.lower() in SUFFIXES:
        return exchanged_request(path, read_bytes(path), defaults)
    given = read_json(path)
    document = given if isinstance(given, dict) and "line" in given else {"line": given}
    if defaults is None or not isinstance(document["line"], dict):
        return document
    from app.schemas.faults import BadInput
    from app.sheets.columns import PlacedLine

    try:
        return {**document, "line": with_defaults(PlacedLine("", document["line"]), defaults)}
    except BadInput as error:
        refuse(error.faults)


def read_bytes(path: Path) -> bytes:
    """Read a file, or standard input for -; end the command with a message if that cannot be read."""
    try:
        return sys.stdin.buffer.read() if str(path) == "-" else path.read_bytes()
    except OSError as error:
        end(f"{path} cannot be read: {error.strerror or error}", BAD_INPUT)


def read_json(path: Path) -> Any:
    """Read a JSON file, or standard input for -; end the command with a message if that cannot be read."""
    from app.schemas.faults import BadInput, parse_json

    raw = read_bytes(path)
    try:
        return parse_json(raw)
    except BadInput as error:
        end("\n".join(f"{path}: {fault.detail if not fault.pointer else fault}" for fault in error.faults), BAD_INPUT)


def read_settings(data_dir: Path | None) -> "Settings":
    """Read the settings from the environment; if they are wrong, print their faults and end."""
    from pydantic import ValidationError

    from app.runtime.settings import Settings

    try:
        return Settings() if data_dir is None else Settings(data_dir=data_dir)
    except ValidationError as error:
        # A default that depends on a wrong value cannot be computed; that is not a fault itself.
        faults = [fault for fault in error.errors() if fault["type"] != "default_factory_not_called"]
        end(
            "\n".join(_variable(fault["loc"]) + fault["msg"].removeprefix("Value error, ") for fault in faults),
            BAD_INPUT,
        )


def _variable(location: Sequence[int | str]) -> str:
    return f"GALLOPING_{'_'.join(map(str, location)).upper()}: " if location else ""


@contextmanager
def ending_on_faults() -> Iterator[None]:
    """End the command with one sentence if files or the database cannot be used."""
    from alembic.util import CommandError
    from sqlalchemy.exc import SQLAlchemyError

    try:
        yield
    except (SQLAlchemyError, CommandError) as error:
        reasons = str(getattr(error, "orig", None) or error).splitlines()
        end(f"the database of GALLOPING_DATABASE_URL cannot be used: {reasons[0] if reasons else error!r}", BAD_INPUT)
    except OSError as error:
        end(f"{error.filename or 'a file of the service'} cannot be used: {error.strerror or error}", BAD_INPUT)


def place_of(settings: "Settings") -> str:
    """Return where the database is: its file, or its address without the password."""
    from sqlalchemy import make_url

    file = _database_file(settings)
    return make_url(settings.database_url).render_as_string(hide_password=True) if file is None else str(file)


def require_database(settings: "Settings") -> None:
    """End with a sentence that names the place if the configured database is a file that does not exist."""
    with ending_on_faults():
        file = _database_file(settings)
        missing = file is not None and not file.exists()
    if missing:
        end(
            f"there is no database {file}: name the directory of the service with --data-dir or GALLOPING_DATA_DIR; "
            "`galloping serve`, `migrate` and `keys create` make one",
            BAD_INPUT,
        )


def make_missing_database(settings: "Settings") -> None:
    """Make the configured database if there is none yet, and say where on standard error."""
    from app.storage.database import make_engine
    from app.storage.migration import is_empty, migrate

    with ending_on_faults():
        engine = make_engine(settings)
        try:
            with engine.connect() as connection:
                missing = is_empty(connection)
        finally:
            engine.dispose()
        if missing:
            migrate(settings)
            notice(f"made the new database {place_of(settings)}")


def _database_file(settings: "Settings") -> Path | None:
    from sqlalchemy import make_url

    url = make_url(settings.database_url)
    return Path(url.database) if url.get_backend_name() == "sqlite" and url.database else None


@contextmanager
def using_database(settings: "Settings") -> Iterator["sessionmaker[Session]"]:
    """Yield sessions on a database of this version; end with one sentence, and make nothing, if there is none."""
    from app.storage.database import make_engine, session_factory
    from app.storage.migration import schema_fault

    require_database(settings)
    with ending_on_faults():
        engine = make_engine(settings)
        try:
            with engine.connect() as connection:
                fault = schema_fault(connection)
            if fault:
                end(f"the database {place_of(settings)} {fault}", BAD_INPUT)
            yield session_factory(engine)
        finally:
            engine.dispose()
