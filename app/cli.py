"""The command line: `galloping analyse`, `serve`, `worker`, `migrate`, `submit`, `example`."""
# ruff: noqa: PLC0415 - what a command needs is imported by the command, so that --help and example answer at once

import json
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from app.examples import EXAMPLE_NAMES

if TYPE_CHECKING:
    from app.convert import PointResult
    from app.faults import Fault
    from app.settings import Settings

app = typer.Typer(
    help="Tells whether an iced transmission-line span gallops, from which wind speed, and how far.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

_BAD_INPUT = 2
_FAILED = 1

LineFile = Annotated[
    Path, typer.Argument(metavar="LINE.json", help="A line, or {line, analysis, study}; - reads standard input.")
]
AnalysisFile = Annotated[Path | None, typer.Option("--analysis", metavar="ANALYSIS.json", help="What is asked.")]
StudyFile = Annotated[Path | None, typer.Option("--study", metavar="STUDY.json", help="Fields of the line to vary.")]
OutputFile = Annotated[
    Path | None, typer.Option("--output", metavar="RESULT.json", help="Where the result goes; else standard output.")
]
DataDirectory = Annotated[Path | None, typer.Option("--data-dir", help="Directory of all files of the service.")]


def main() -> None:
    """Run the command line."""
    app()


@app.command()
def analyse(line: LineFile, analysis: AnalysisFile = None, study: StudyFile = None, output: OutputFile = None) -> None:
    """Analyse a line in this process, without service or database."""
    from app.processes import ONE_BLAS_THREAD

    os.environ.update(ONE_BLAS_THREAD)  # before convert loads numpy, which reads it once
    from app import convert
    from app.faults import BadInput

    document = _document(line, analysis, study)
    try:
        request = convert.read(document)
    except BadInput as error:
        _refuse(error.faults)
    points: list[PointResult] = []
    try:
        with _progress_bar() as show:
            for item in convert.run(request.model_dump(mode="json", by_alias=True)):
                if isinstance(item, convert.Advance):
                    show(item.fraction, item.step)
                else:
                    points.append(item)
    except (ArithmeticError, ValueError) as error:
        _end(f"the computation failed: {error}", _FAILED)
    _write(_result(points, study=request.study is not None), output)


@app.command()
def serve(
    host: Annotated[str, typer.Option(help="Address to listen on.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=1, max=65535, help="Port to listen on.")] = 8000,
    data_dir: DataDirectory = None,
) -> None:
    """Run the service with its embedded database, broker and worker; SIGTERM ends it cleanly."""
    from app.serve import serve as run

    with _operator_told():
        code = run(_settings(data_dir), host, port)
    raise typer.Exit(code)


@app.command()
def worker(data_dir: DataDirectory = None) -> None:
    """Run a worker that takes jobs from the broker of the settings."""
    from app.serve import worker as run

    run(_settings(data_dir))


@app.command()
def migrate(data_dir: DataDirectory = None) -> None:
    """Bring the database of the settings to the newest schema."""
    from app.serve import migrate as run

    with _operator_told():
        run(_settings(data_dir))


@app.command()
def submit(
    line: LineFile,
    analysis: AnalysisFile = None,
    study: StudyFile = None,
    url: Annotated[str, typer.Option(envvar="GALLOPING_URL", help="Address of the service.")] = "http://127.0.0.1:8000",
    wait: Annotated[bool, typer.Option("--wait", help="Wait for the end and print the result.")] = False,
    output: OutputFile = None,
) -> None:
    """Send a line to a service; print the job's status, or with --wait its result."""
    from app import client

    document = _document(line, analysis, study)
    try:
        with client.connect(url) as service:
            job = client.submit(service, document)
            if not wait:
                _write(job, output)
                return
            with _progress_bar() as show:
                job = client.follow(service, job, show)
            if job["status"] == "dismissed":
                _end("the job was cancelled", _FAILED)
            _write(client.results(service, job), output)
    except client.Refused as error:
        _refuse(error.faults)
    except client.ServiceError as error:
        _end(str(error), _FAILED)
    if job["status"] == "failed":
        _end(f"the job failed: {job['failure']['detail']}", _FAILED)


@app.command()
def example(
    name: Annotated[str, typer.Argument(metavar="|".join(EXAMPLE_NAMES), help="Which of the source's lines.")],
) -> None:
    """Print one of the source's lines, ready to run."""
    from app import examples

    if name not in EXAMPLE_NAMES:
        _end(f"there is no example {name!r}; there are {', '.join(EXAMPLE_NAMES)}", _BAD_INPUT)
    _write(examples.example(name), None)


def _document(line: Path, analysis: Path | None, study: Path | None) -> Any:
    """Put the request together from its files; a file that holds a whole request may be completed, not contradicted."""
    whole = _read_json(line)
    document = whole if isinstance(whole, dict) and "line" in whole else {"line": whole}
    for name, path in (("analysis", analysis), ("study", study)):
        if path is None:
            continue
        if name in document:
            _end(f"{name} is given twice: in {line} and in {path}", _BAD_INPUT)
        document = {**document, name: _read_json(path)}
    return document


def _read_json(path: Path) -> Any:
    from app.faults import BadInput, parse_json

    try:
        raw = sys.stdin.buffer.read() if str(path) == "-" else path.read_bytes()
        return parse_json(raw)
    except OSError as error:
        _end(f"{path} cannot be read: {error.strerror or error}", _BAD_INPUT)
    except BadInput as error:
        _end("\n".join(f"{path}: {fault.detail if not fault.pointer else fault}" for fault in error.faults), _BAD_INPUT)


def _settings(data_dir: Path | None) -> "Settings":
    from pydantic import ValidationError

    from app.settings import Settings

    try:
        return Settings() if data_dir is None else Settings(data_dir=data_dir)
    except ValidationError as error:
        # A default that depends on a wrong value could not be made: that is no fault of its own.
        faults = [fault for fault in error.errors() if fault["type"] != "default_factory_not_called"]
        _end(
            "\n".join(_variable(fault["loc"]) + fault["msg"].removeprefix("Value error, ") for fault in faults),
            _BAD_INPUT,
        )


def _variable(location: Sequence[int | str]) -> str:
    return f"GALLOPING_{'_'.join(map(str, location)).upper()}: " if location else ""


@contextmanager
def _operator_told() -> Iterator[None]:
    """End with one sentence where files or database cannot be used as the settings say."""
    from alembic.util import CommandError
    from sqlalchemy.exc import SQLAlchemyError

    try:
        yield
    except (SQLAlchemyError, CommandError) as error:
        said = str(getattr(error, "orig", None) or error).splitlines()
        _end(f"the database of GALLOPING_DATABASE_URL cannot be used: {said[0] if said else error!r}", _BAD_INPUT)
    except OSError as error:
        _end(f"{error.filename or 'a file of the service'} cannot be used: {error.strerror or error}", _BAD_INPUT)


def _result(points: Sequence["PointResult"], *, study: bool) -> Any:
    from dataclasses import asdict

    from app import convert, export

    tables: dict[str, list[dict[str, object]]] = {
        name: [{**point.axes, **row} for point in points for row in point.tables[name]] for name in convert.TABLES
    }
    return json.loads("".join(export.result_text([asdict(point) for point in points], tables, study=study)))


def _write(document: Any, output: Path | None) -> None:
    text = json.dumps(document, indent=2, ensure_ascii=False) + "\n"
    try:
        if output is None:
            sys.stdout.write(text)
        else:
            output.write_text(text, encoding="utf-8")
    except OSError as error:
        _end(f"the result cannot be written: {error.strerror or error}", _BAD_INPUT)


def _refuse(faults: Sequence["Fault"]) -> NoReturn:
    _end("\n".join(str(fault) for fault in faults), _BAD_INPUT)


def _end(message: str, code: int) -> NoReturn:
    typer.echo(message, err=True)
    raise typer.Exit(code)


@contextmanager
def _progress_bar() -> Iterator[Any]:
    """Give a function of fraction and step that draws a bar on a terminal, and does nothing elsewhere."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    columns = (BarColumn(), TaskProgressColumn(), TimeElapsedColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=console, disable=not console.is_terminal, transient=True) as progress:
        task = progress.add_task("starting", total=1.0)
        yield lambda fraction, step: progress.update(task, completed=fraction, description=step)


if __name__ == "__main__":
    main()
