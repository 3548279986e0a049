"""Commands that run the service: `galloping serve`, `api`, `worker` and `migrate`."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.console import BAD_INPUT, end
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
) -> None:
    """Run the service with its embedded database, broker and worker; SIGTERM ends it cleanly."""
    from app.serve import Unguarded
    from app.serve import serve as run

    try:
        with ending_on_faults():
            code = run(_with_processes(read_settings(data_dir), processes), host, port)
    except Unguarded as error:
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


def migrate(data_dir: DataDirectory = None) -> None:
    """Bring the configured database to the newest schema."""
    from app.storage.migration import migrate as run

    with ending_on_faults():
        run(read_settings(data_dir))
