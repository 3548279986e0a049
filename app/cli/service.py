"""Commands that run the service, and `submit`, which sends it a line."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

import json
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.console import BAD_INPUT, FAILED, end, progress_bar, refuse, write
from app.cli.inputs import ending_on_faults, read_request, read_settings
from app.cli.options import AnalysisFile, DataDirectory, DefaultsFile, LineFile, OutputFile, StudyFile

if TYPE_CHECKING:
    from app.runtime.settings import Settings

INTERRUPTED = 130  # as shells count a program that Ctrl-C ended
_PATIENCE_SECONDS = 5.0  # a person is waiting

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


def submit(  # noqa: PLR0913, PLR0917 - the options of a command are its arguments
    line: LineFile,
    analysis: AnalysisFile = None,
    study: StudyFile = None,
    defaults: DefaultsFile = None,
    url: Annotated[str, typer.Option(envvar="GALLOPING_URL", help="Address of the service.")] = "http://127.0.0.1:8000",
    wait: Annotated[bool, typer.Option("--wait", help="Wait until the job ends and print the result.")] = False,
    output: OutputFile = None,
) -> None:
    """Send a line to a service and print the job's status, or with --wait its result. GALLOPING_KEY holds the key."""
    from app import client

    document = read_request(line, analysis, study, defaults=defaults)
    try:
        with client.Client(url, patience_seconds=_PATIENCE_SECONDS) as service:
            job = service.submit_document(document)
            if not wait:
                write(job.model_dump(mode="json"), output)
                return
            try:
                with progress_bar() as show:
                    job = service.wait(job, show)
            except KeyboardInterrupt:
                end(f"job {job.id} goes on; its result will be at {url}/v1/jobs/{job.id}/results", INTERRUPTED)
            if job.status == "dismissed":
                end("the job was cancelled", FAILED)
            write(json.loads(service.download(job, "results")), output)
    except client.Refused as error:
        refuse(error.faults)
    except client.ServiceError as error:
        end(str(error), FAILED)
    if job.failure is not None:
        end(f"the job failed: {job.failure.detail}", FAILED)
