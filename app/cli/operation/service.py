"""Commands that run the service: `galloping serve`, `api`, `worker` and `migrate`."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

import sys
from functools import partial
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.console import BAD_INPUT, end, notice
from app.cli.inputs import ending_on_faults, read_settings
from app.cli.options import DataDirectory

if TYPE_CHECKING:
    from app.runtime.settings import Settings

Host = Annotated[str, typer.Option(help="Address to listen on.")]
Port = Annotated[int, typer.Option(min=1, max=65535, help="Port to listen on.")]
Processes = Annotated[
    int | None, typer.Option("--processes", min=1, help="API processes; GALLOPING_API_PROCESSES if absent.")
]


def serve(
    host: Host = "127.0.0.1",
    port: Port = 8000,
    data_dir: DataDirectory = None,
    processes: Processes = None,
    verbose: Annotated[bool, typer.Option("--verbose", help="Write the whole log also on a terminal.")] = False,
) -> None:
    """Run the service with its embedded database, broker and worker; SIGTERM or Ctrl-C ends it cleanly.

    On a terminal it says its address and logs warnings only, elsewhere or with --verbose it logs as JSON.
    """
    from app.serve import PortTaken, Unguarded
    from app.serve import serve as run

    settings = _with_processes(read_settings(data_dir), processes)
    for_people = sys.stderr.isatty() and not verbose
    try:
        with ending_on_faults():
            if for_people:
                code = run(_quiet(settings), host, port, partial(_tell_address, settings, host, port))
            else:
                code = run(settings, host, port)
    except (PortTaken, Unguarded) as error:
        end(str(error), BAD_INPUT)
    raise typer.Exit(code)


def api(
    host: Host = "127.0.0.1", port: Port = 8000, data_dir: DataDirectory = None, processes: Processes = None
) -> None:
    """Run the API alone, on a migrated database; workers run as separate processes."""
    from app.serve import api as run

    with ending_on_faults():
        code = run(_with_processes(read_settings(data_dir), processes), host, port)
    raise typer.Exit(code)


def _quiet(settings: "Settings") -> "Settings":
    """Return settings that log warnings, as text, where the operator did not choose."""
    chosen = {"log_level": "warning", "log_format": "text"}
    return settings.model_copy(update={k: v for k, v in chosen.items() if k not in settings.model_fields_set})


def _tell_address(settings: "Settings", host: str, port: int) -> None:
    address = f"http://{f'[{host}]' if ':' in host else host}:{port}{settings.root_path}"
    notice(
        f"Galloping is at {address}/ (pages) and {address}/docs (API). Its files are in {settings.data_dir}. "
        "Ctrl-C ends it."
    )


def _with_processes(settings: "Settings", count: int | None) -> "Settings":
    return settings if count is None else settings.model_copy(update={"api_processes": count})


def worker(
    data_dir: DataDirectory = None,
    check: Annotated[
        bool, typer.Option("--check", help="Only check that the worker of this directory is alive.")
    ] = False,
) -> None:
    """Run a worker that takes jobs from the configured broker."""
    from app.serve import worker as run

    run(read_settings(data_dir), check=check)


def migrate(
    data_dir: DataDirectory = None,
    to: Annotated[
        str | None,
        typer.Option(
            metavar="REVISION",
            help="The schema to go to, also an older one; what has no place in that is removed. The newest if absent.",
        ),
    ] = None,
) -> None:
    """Bring the configured database to the newest schema, or back to that of an older version."""
    from app.storage.migration import migrate as run

    with ending_on_faults():
        done = run(read_settings(data_dir), to)
    if done.before == done.after:
        notice(f"the schema is {done.after} already")
    else:
        notice(f"the schema is {done.after} now" + (f"; it was {done.before}" if done.before else ""))
