"""Run the source's four lines through the whole service and back: HTTP, queue, worker, engine, SQL (`make demo`)."""

import contextlib
import json
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Any

import httpx
import typer
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn
from rich.table import Table

import app
from app import client
from app.answers.jobs import JobDocument
from app.client import Client
from app.reference.source_lines import EXAMPLE_NAMES, example

Json = Mapping[str, Any]
Jobs = dict[str, dict[str, JobDocument]]

_SOURCE: Json = {"physics": "source"}  # that of the tables beside which the results are printed
_CYCLES: Json = {**_SOURCE, "loops": [1, 2], "wind_speeds_m_per_s": {"start": 4.0, "stop": 6.0, "count": 5}}
_FREQUENCIES: Json = {**_SOURCE, "loops": [1, 2, 3], "wind_speeds_m_per_s": [], "finite_element_loops": []}
_COEXISTING: Json = {**_SOURCE, "loops": [2], "models": ["hybrid"], "wind_speeds_m_per_s": [12.0]}
_LIGHT_DAMPING = 0.0308  # torsional ratio: a tenth of the source's
_TABLES = ("frequencies", "critical-wind-speeds", "limit-cycles")
_PICTURES = ("amplitude", "orbit")
_DIRECTIONS = ("vertical", "horizontal", "torsional")
_MODELS = {"hybrid": "hybrid", "finite_element": "FE"}
_START_SECONDS = 60.0
_STOP_SECONDS = 30.0


def main(
    output: Annotated[Path, typer.Option(help="Directory for CSV files, pictures and the service's data.")] = Path(
        "demo-output"
    ),
) -> None:
    """Run the source's four lines through a new service and compare the results with the source."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # ends the service with the demo
    console = Console()
    output.mkdir(parents=True, exist_ok=True)
    try:
        with _service(output) as address, Client(address) as service:
            console.print(f"The service runs at {address}; its documentation is at {address}/docs until the demo ends.")
            jobs = _run_jobs(service, console)
            console.print("Models: hybrid and finite element (FE), each followed by the number of loops per span.")
            console.print(_frequency_table({name: job["frequencies"] for name, job in jobs.items()}, service))
            finished = {name: service.results(job["cycles"]).model_dump() for name, job in jobs.items()}
            console.print(_critical_table(finished))
            console.print(_cycle_table(finished))
            console.print(_coexisting_table(service))
            _save(service, jobs, output)
    except client.ServiceError as error:
        console.print(f"[red]{error}")
        raise typer.Exit(1) from error
    console.print(f"CSV files and pictures are in {output}.")


@contextlib.contextmanager
def _service(output: Path) -> Iterator[str]:
    """Run the embedded service on a free port, and yield its address when it is ready.

    Raises
    ------
    ServiceError
        If the service does not start in time.
    """
    port = _free_port()
    command = [sys.executable, "-m", __package__, "serve", "--port", str(port), "--data-dir", str(output / "service")]
    log = output / "service.log"
    # Drop variables of the shell that would point the demo at another database or broker.
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GALLOPING_")}
    with (
        log.open("w", encoding="utf-8") as sink,
        subprocess.Popen(command, stdout=sink, stderr=sink, env=environment) as process,
    ):
        try:
            address = f"http://127.0.0.1:{port}"
            _wait_until_ready(address, process, log)
            yield address
        finally:
            _stop(process)


def _wait_until_ready(address: str, process: subprocess.Popen[bytes], log: Path) -> None:
    deadline = time.monotonic() + _START_SECONDS
    while process.poll() is None and time.monotonic() < deadline:
        with contextlib.suppress(httpx.HTTPError):
            if httpx.get(f"{address}/health/ready", timeout=5.0).is_success:
                return
        time.sleep(0.1)
    raise client.ServiceError(f"the service did not start; {log} ends with:\n{log.read_text(encoding='utf-8')[-2000:]}")


def _stop(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.wait(_STOP_SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()


def _run_jobs(service: Client, console: Console) -> Jobs:
    """Submit all jobs, then follow each job to its end."""
    wanted = {"frequencies": _FREQUENCIES, "cycles": _CYCLES}
    jobs: Jobs = {
        name: {kind: service.submit(example(name), analysis) for kind, analysis in wanted.items()}
        for name in EXAMPLE_NAMES
    }
    with _progress(console) as show:
        for name, kinds in jobs.items():
            for kind, job in kinds.items():
                kinds[kind] = _successful(service.wait(job, show(name, kind)))
    return jobs


def _successful(job: JobDocument) -> JobDocument:
    if job.status != "successful":
        raise client.JobFailed(job)
    return job


@contextlib.contextmanager
def _progress(console: Console) -> Iterator[Callable[[str, str], client.Show]]:
    """Yield a function that adds a progress bar for a job; without a terminal, print when a job begins."""
    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, disable=not console.is_terminal) as progress:

        def bar(name: str, kind: str) -> client.Show:
            if not console.is_terminal:
                console.print(f"{name}: {kind} ...")
            task = progress.add_task(f"{name}, {kind}", total=1.0)
            return lambda fraction, _: progress.update(task, completed=fraction)

        yield bar


def _frequency_table(jobs: Mapping[str, JobDocument], service: Client) -> Table:
    """Show the computed frequencies beside Table 2 of the source."""
    source = json.loads((files(app) / "data" / "table2.json").read_text(encoding="utf-8"))
    printed = {(row["subconductors"], row["model"]): row["loops"] for row in source["rows"]}
    table = _table("Natural frequencies [Hz]: computed, Table 2 of the source, difference in %", *_DIRECTIONS)
    for subconductors, (name, job) in enumerate(jobs.items(), start=1):
        for row in service.results(job).model_dump()["frequencies"]:
            theirs = printed[subconductors, row["model"]][str(row["loops"])]
            cells = [_beside(row[f"{d}_hz"], value) for d, value in zip(_DIRECTIONS, theirs, strict=True)]
            table.add_row(*_whose(name, row), *cells)
        table.add_section()
    return table


def _beside(ours: float, theirs: float) -> str:
    return f"{ours:.4f} {theirs:.3f} {100.0 * (ours / theirs - 1.0):+.2f}"


def _critical_table(results: Mapping[str, Json]) -> Table:
    columns = ("wind\n[m/s]", "crossing", "direction", "frequency\n[Hz]")
    table = _table("Critical wind speeds up to 30 m/s", *columns)
    for name, result in results.items():
        for row in result["critical_wind_speeds"]:
            speed, frequency = f"{row['wind_speed_m_per_s']:.3f}", f"{row['frequency_hz']:.4f}"
            table.add_row(*_whose(name, row), speed, row["crossing"], row["direction"], frequency)
        table.add_section()
    return table


def _cycle_table(results: Mapping[str, Json]) -> Table:
    """Show the stable cycles; the CSV files also hold the equilibria and the unstable cycles."""
    columns = ("wind\n[m/s]", "vertical\n[m]", "horizontal\n[m]", "torsional\n[rad]", "frequency\n[Hz]")
    table = _table("Stable limit cycles: amplitudes at the observation point", *columns)
    for name, result in results.items():
        for row in _stable(result["limit_cycles"]):
            sizes = [f"{row[key]:.4f}" for key in ("vertical_m", "horizontal_m", "torsional_rad", "frequency_hz")]
            table.add_row(*_whose(name, row), f"{row['wind_speed_m_per_s']:g}", *sizes)
        table.add_section()
    return table


def _coexisting_table(service: Client) -> Table:
    """Show a line with two stable cycles at one wind speed: the initial motion decides which one develops."""
    line = example("c11-triple")
    light = {**line, "damping": {**line["damping"], "torsional_ratio": _LIGHT_DAMPING}}
    job = _successful(service.wait(service.submit(light, _COEXISTING)))
    title = f"Cycles of the triple bundle at 12 m/s with a torsional damping ratio of {_LIGHT_DAMPING}"
    table = _table(title, "stability", "branch", "vertical\n[m]", "horizontal\n[m]", "torsional\n[rad]")
    for row in service.results(job).model_dump()["limit_cycles"]:
        if row["kind"] == "periodic":
            sizes = [f"{row[key]:.4f}" for key in ("vertical_m", "horizontal_m", "torsional_rad")]
            table.add_row(*_whose("c11-triple", row), row["stability"], str(row["branch"]), *sizes)
    return table


def _table(title: str, *columns: str) -> Table:
    table = Table(title=title, box=SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    for column in ("line", "model", *columns):
        table.add_column(column, no_wrap=True, overflow="fold")
    return table


def _whose(name: str, row: Json) -> tuple[str, str]:
    return name.removeprefix("c11-"), f"{_MODELS[row['model']]} {row['loops']}"


def _stable(rows: Sequence[Json]) -> list[Json]:
    return [row for row in rows if row["stability"] == "stable" and row["kind"] == "periodic"]


def _save(service: Client, jobs: Jobs, output: Path) -> None:
    for name, kinds in jobs.items():
        for table in _TABLES:
            job = kinds["frequencies" if table == "frequencies" else "cycles"]
            content = service.download(job, f"results/{table}?format=csv")
            (output / f"{name}-{table}.csv").write_bytes(content)
        for picture in _PICTURES:
            content = service.plot(kinds["cycles"], picture)
            (output / f"{name}-{picture}.svg").write_bytes(content)


def _free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


if __name__ == "__main__":
    typer.run(main)
