"""Write results, tables and progress, and end a command with a message."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from tempfile import TemporaryFile
from typing import TYPE_CHECKING, Any, NoReturn

import typer

if TYPE_CHECKING:
    from app.schemas.faults import Fault

BAD_INPUT = 2
FAILED = 1
INTERRUPTED = 130  # as shells count a program that Ctrl-C ended
_FILE_WIDTH = 250
_FOLDER = f"{__name__}.output_dir"
_STANDARD_OUTPUT = Path("-")
_quiet = ContextVar("quiet", default=False)


def for_people(as_json: bool) -> bool:
    """Tell whether a result is for people: standard output is a terminal, and JSON is not asked for."""
    return sys.stdout.isatty() and not as_json


def print_table(columns: Sequence[str], rows: Sequence[Mapping[str, Any]]) -> None:
    """Print rows as a table."""
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table

    table = Table(*(name.removesuffix("_at").replace("_", " ") for name in columns), box=SIMPLE_HEAD)
    for row in rows:
        table.add_row(*(_shown(row[name]) for name in columns))
    # Do not wrap output to a file or another program at a terminal's width.
    Console(width=None if sys.stdout.isatty() else _FILE_WIDTH).print(table)


def _shown(value: Any) -> str:
    if isinstance(value, list):
        return " ".join(map(str, value))
    return "-" if value is None else str(value)


def write(document: Any, output: Path | None) -> None:
    """Write a document as JSON to a file, or to standard output without one or where the file cannot be written."""
    write_bytes((json.dumps(document, indent=2, ensure_ascii=False) + "\n").encode(), output)


def write_bytes(content: bytes, output: Path | None) -> None:
    """Write bytes to a file, or to standard output without one or where the file cannot be written."""
    try:
        if output is not None:
            output.write_bytes(content)
            return
    except OSError as error:
        reason = error.strerror or error
        typer.echo(f"{output} cannot be written: {reason}; the result follows on standard output", err=True)
        _print(content)
        raise typer.Exit(FAILED) from error
    _print(content)


def _print(content: bytes) -> None:
    try:
        sys.stdout.flush()
        sys.stdout.buffer.write(content)
        sys.stdout.buffer.flush()
    except OSError as error:
        end(f"the result cannot be written: {error.strerror or error}", BAD_INPUT)


def remember_folder(context: typer.Context, folder: Path | None) -> Path | None:
    """Remember the folder from which relative paths of files for results start."""
    context.meta[_FOLDER] = folder
    return folder


def placed(context: typer.Context, path: Path | None) -> Path | None:
    """Return the place of a file or folder for results; make the folder that it starts from, or end."""
    folder: Path | None = context.meta.get(_FOLDER)
    if path is None or folder is None or path == _STANDARD_OUTPUT or path.is_absolute() or context.resilient_parsing:
        return path
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        end(f"{folder} cannot be made: {error.strerror or error}", BAD_INPUT)
    return folder / path


def try_output(path: Path | None) -> None:
    """End if a file cannot be written, before any work is done for it; what it holds stays."""
    try:
        if path is not None:
            path.open("a", encoding="utf-8").close()
    except OSError as error:
        end(f"{path} cannot be written: {error.strerror or error}", BAD_INPUT)


def try_folder(path: Path | None) -> None:
    """End if no file can be made in a folder, before any work is done for it; make the folder if it is missing."""
    try:
        if path is not None:
            path.mkdir(parents=True, exist_ok=True)
            TemporaryFile(dir=path).close()
    except OSError as error:
        end(f"{path} cannot be written: {error.strerror or error}", BAD_INPUT)


def notice(sentence: str) -> None:
    """Say on standard error what is good to know and no fault, unless it is to be quiet."""
    if not _quiet.get():
        typer.echo(sentence, err=True)


@contextmanager
def quietly() -> Iterator[None]:
    """Leave out progress and notices."""
    former = _quiet.set(True)
    try:
        yield
    finally:
        _quiet.reset(former)


def refuse(faults: Sequence["Fault"]) -> NoReturn:
    """End with the faults of the input."""
    end("\n".join(str(fault) for fault in faults), BAD_INPUT)


def end(message: str, code: int) -> NoReturn:
    """End with a message on standard error and an exit code."""
    typer.echo(message, err=True)
    raise typer.Exit(code)


@contextmanager
def progress_bar() -> Iterator[Any]:
    """Yield a function of fraction and step that draws a bar on a terminal, unless it is to be quiet."""
    if _quiet.get() or not sys.stderr.isatty():  # rich loads slowly
        yield lambda fraction, step: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    columns = (BarColumn(), TaskProgressColumn(), TimeElapsedColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("starting", total=1.0)
        yield lambda fraction, step: progress.update(task, completed=fraction, description=step)
