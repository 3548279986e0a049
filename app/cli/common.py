"""What the commands share: reading requests and settings, writing results, ending with a sentence."""
# ruff: noqa: PLC0415 - what a command needs is imported by the command, so that --help and example answer at once

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

if TYPE_CHECKING:
    from sqlalchemy.orm import Session, sessionmaker

    from app.runtime.settings import Settings
    from app.schemas.faults import Fault

BAD_INPUT = 2
FAILED = 1
_FILE_WIDTH = 250

LineFile = Annotated[
    Path,
    typer.Argument(metavar="LINE.json", help="A line, or {line, analysis, study, placement}; - reads standard input."),
]
AnalysisFile = Annotated[Path | None, typer.Option("--analysis", metavar="ANALYSIS.json", help="What is asked.")]
StudyFile = Annotated[Path | None, typer.Option("--study", metavar="STUDY.json", help="Fields of the line to vary.")]
PlacementFile = Annotated[
    Path | None, typer.Option("--placement", metavar="PLACEMENT.json", help="Devices to be placed.")
]
OutputFile = Annotated[
    Path | None, typer.Option("--output", metavar="RESULT.json", help="Where the result goes; else standard output.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON, for programs.")]
DataDirectory = Annotated[Path | None, typer.Option("--data-dir", help="Directory of all files of the service.")]


def read_request(line: Path, analysis: Path | None, study: Path | None, placement: Path | None = None) -> Any:
    """Put the request together from its files; a file that holds a whole request may be completed, not contradicted."""
    whole = _read_json(line)
    document = whole if isinstance(whole, dict) and "line" in whole else {"line": whole}
    for name, path in (("analysis", analysis), ("study", study), ("placement", placement)):
        if path is None:
            continue
        if name in document:
            end(f"{name} is given twice: in {line} and in {path}", BAD_INPUT)
        document = {**document, name: _read_json(path)}
    return document


def _read_json(path: Path) -> Any:
    from app.schemas.faults import BadInput, parse_json

    try:
        raw = sys.stdin.buffer.read() if str(path) == "-" else path.read_bytes()
        return parse_json(raw)
    except OSError as error:
        end(f"{path} cannot be read: {error.strerror or error}", BAD_INPUT)
    except BadInput as error:
        end("\n".join(f"{path}: {fault.detail if not fault.pointer else fault}" for fault in error.faults), BAD_INPUT)


def read_settings(data_dir: Path | None) -> "Settings":
    """Read the settings from the environment; end with what is wrong with them, if anything is."""
    from pydantic import ValidationError

    from app.runtime.settings import Settings

    try:
        return Settings() if data_dir is None else Settings(data_dir=data_dir)
    except ValidationError as error:
        # A default that depends on a wrong value could not be made: that is no fault of its own.
        faults = [fault for fault in error.errors() if fault["type"] != "default_factory_not_called"]
        end(
            "\n".join(_variable(fault["loc"]) + fault["msg"].removeprefix("Value error, ") for fault in faults),
            BAD_INPUT,
        )


def _variable(location: Sequence[int | str]) -> str:
    return f"GALLOPING_{'_'.join(map(str, location)).upper()}: " if location else ""


@contextmanager
def operator_told() -> Iterator[None]:
    """End with one sentence where files or database cannot be used as the settings say."""
    from alembic.util import CommandError
    from sqlalchemy.exc import SQLAlchemyError

    try:
        yield
    except (SQLAlchemyError, CommandError) as error:
        said = str(getattr(error, "orig", None) or error).splitlines()
        end(f"the database of GALLOPING_DATABASE_URL cannot be used: {said[0] if said else error!r}", BAD_INPUT)
    except OSError as error:
        end(f"{error.filename or 'a file of the service'} cannot be used: {error.strerror or error}", BAD_INPUT)


@contextmanager
def using_database(settings: "Settings") -> Iterator["sessionmaker[Session]"]:
    """Give sessions on a database of this version; end with one sentence where there is none."""
    from app.storage.database import make_engine, session_factory
    from app.storage.migration import is_newest

    with operator_told():
        engine = make_engine(settings)
        try:
            with engine.connect() as connection:
                newest = is_newest(connection)
            if not newest:
                end("the database is not of this version: `galloping migrate` brings it there", BAD_INPUT)
            yield session_factory(engine)
        finally:
            engine.dispose()


def print_table(columns: Sequence[str], rows: Sequence[Mapping[str, Any]]) -> None:
    """Print rows as a table for people."""
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table

    table = Table(*(name.removesuffix("_at").replace("_", " ") for name in columns), box=SIMPLE_HEAD)
    for row in rows:
        table.add_row(*(_shown(row[name]) for name in columns))
    # What goes into a file or to another program is not folded to a terminal's width.
    Console(width=None if sys.stdout.isatty() else _FILE_WIDTH).print(table)


def _shown(value: Any) -> str:
    if isinstance(value, list):
        return " ".join(map(str, value))
    return "-" if value is None else str(value)


def write(document: Any, output: Path | None) -> None:
    """Write a document as JSON into a file, or to standard output if none is named."""
    text = json.dumps(document, indent=2, ensure_ascii=False) + "\n"
    try:
        if output is None:
            sys.stdout.write(text)
        else:
            output.write_text(text, encoding="utf-8")
    except OSError as error:
        end(f"the result cannot be written: {error.strerror or error}", BAD_INPUT)


def refuse(faults: Sequence["Fault"]) -> NoReturn:
    """End with the faults of what was put in."""
    end("\n".join(str(fault) for fault in faults), BAD_INPUT)


def end(message: str, code: int) -> NoReturn:
    """End with a message on standard error and an exit code."""
    typer.echo(message, err=True)
    raise typer.Exit(code)


@contextmanager
def progress_bar() -> Iterator[Any]:
    """Give a function of fraction and step that draws a bar on a terminal, and does nothing elsewhere."""
    if not sys.stderr.isatty():  # rich loads slowly
        yield lambda fraction, step: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    columns = (BarColumn(), TaskProgressColumn(), TimeElapsedColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("starting", total=1.0)
        yield lambda fraction, step: progress.update(task, completed=fraction, description=step)
