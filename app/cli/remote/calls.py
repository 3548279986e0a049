"""What the commands that call a service share: its address and key, its errors, waiting, and its answers' bytes."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeVar
from urllib.parse import urljoin
from uuid import UUID

import typer

from app.cli.console import BAD_INPUT, FAILED, INTERRUPTED, end, progress_bar, refuse

if TYPE_CHECKING:
    from app.answers.batches import BatchDocument
    from app.answers.jobs import JobDocument
    from app.client import Client

    Followed = TypeVar("Followed", bound=JobDocument | BatchDocument)

DEFAULT_URL = "http://127.0.0.1:8000"
ENDED = frozenset({"successful", "failed", "dismissed"})
_PATIENCE_SECONDS = 5.0  # a person is waiting

ServiceUrl = Annotated[str, typer.Option("--url", envvar="GALLOPING_URL", help="Address of the service.")]
KeyFile = Annotated[
    Path | None,
    typer.Option(
        "--key-file",
        metavar="FILE",
        envvar="GALLOPING_KEY_FILE",
        help="File that holds the API key. Without one GALLOPING_KEY holds it.",
    ),
]


@contextmanager
def service_at(url: str, key_file: Path | None) -> Iterator["Client"]:
    """Yield a client of the service; end the command with a message if the service refuses or does not answer."""
    from app import client

    key = None if key_file is None else _key_in(key_file)
    try:
        with client.Client(url, key, patience_seconds=_PATIENCE_SECONDS) as service:
            yield service
    except client.Refused as error:
        refuse(error.faults)
    except client.ServiceError as error:
        end(str(error), FAILED)


def _key_in(file: Path) -> str:
    try:
        return file.read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        end(f"--key-file: {file} cannot be read: {getattr(error, 'strerror', None) or error}", BAD_INPUT)


def found(service: "Client", identity: UUID) -> "JobDocument | BatchDocument":
    """Return the status of the job, or of the batch, of this id; end the command if there is neither."""
    from app.client import NotFound

    try:
        return service.job(identity)
    except NotFound:
        pass
    try:
        return service.batch(identity)
    except NotFound:
        end(f"the service has no job and no batch {identity} of yours", FAILED)


def waited_for(service: "Client", work: "Followed", url: str) -> "Followed":
    """Wait until a job or batch ends and return its status; Ctrl-C ends the command and says how to go on."""
    try:
        with progress_bar() as show:
            return service.wait(work, show)
    except KeyboardInterrupt:
        end(going_on(work, url), INTERRUPTED)


def going_on(work: "JobDocument | BatchDocument", url: str) -> str:
    """Return the sentences that say how to come back to a job or batch."""
    own = {link.rel: link.href for link in work.links}["self"]
    kind = "batch" if own.rstrip("/").rpartition("/")[0].endswith("/batches") else "job"
    ending = f"{work.id}" + ("" if url == DEFAULT_URL else f" --url {url}")
    return (
        f"{kind} {work.id} goes on; its results will be at {urljoin(url, own)}/results\n"
        f"`galloping jobs wait {ending}` waits for it again, `galloping jobs results {ending}` prints what it found, "
        f"`galloping jobs cancel {ending}` stops it."
    )
