"""The commands that run the service: migrate, api, worker, and serve, which is the whole of it in one command."""

import asyncio
import gc
import logging
import math
import os
import shutil
import signal
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any, NoReturn

import uvicorn

from app.runtime import logs, processes, telemetry
from app.runtime.loopback import is_loopback
from app.runtime.settings import Settings, get_settings
from app.security import keys
from app.storage.database import make_engine, session_factory
from app.storage.migration import migrate

if TYPE_CHECKING:
    from app.main import Service

HTTP = "app.http.bounded_heads:BoundedHeads"
"""What speaks HTTP on a connection, as uvicorn is told of it."""

_SHARED_METRICS = "PROMETHEUS_MULTIPROC_DIR"  # the client library's name, read as it is loaded
_METRICS_BYTES = 1 << 20  # far more than all routes and answers need
_STOP_SECONDS = 10.0
_LOOK_SECONDS = 0.5
_START_SECONDS = 30  # a process that says nothing for so long is replaced; loading takes seconds on a busy machine

_logger = logging.getLogger(__name__)


class Unguarded(Exception):
    """Raised when a service would be open to everybody."""


def worker(settings: Settings) -> NoReturn:
    """Become a worker: a new program in this process, since the BLAS library reads its settings as it loads."""
    os.execve(sys.executable, [sys.executable, "-m", "worker"], processes.environment(settings))


def api(settings: Settings, host: str, port: int) -> int:
    """Run the API alone, until SIGTERM or SIGINT; returns 0.

    Requests that are being served then are finished, as long as that takes no longer than the time for a stop.
    """
    logs.configure(settings)
    os.environ.update(settings.environment())  # where the application reads them, here or in children of uvicorn's
    os.environ[_SHARED_METRICS] = str(_empty_folder(settings.data_dir / f"metrics-{port}"))
    uvicorn.run(
        "app.serve:_application",
        factory=True,
        http=HTTP,
        loop="uvloop",
        host=host,
        port=port,
        workers=settings.api_processes,
        log_config=None,
        access_log=False,  # ours is in the place of uvicorn's
        server_header=False,
        timeout_worker_healthcheck=_START_SECONDS,
        timeout_graceful_shutdown=math.ceil(settings.shutdown_seconds),
    )
    return 0


def serve(settings: Settings, host: str, port: int) -> int:
    """Migrate, then run the API and a worker as child processes until SIGTERM or SIGINT; return the exit code.

    A worker that ends by itself is started again; if the API does, the service ends with its code. Both end with this
    process even if it is killed, and whatever they left undone is taken up by the next start.

    Raises
    ------
    Unguarded
        If others than this machine could reach a service that has no key.
    """
    logs.configure(settings)
    migrate(settings)
    if not is_loopback(host) and not _has_keys(settings):
        raise Unguarded(f"{host} can be reached by others, and there is no key yet: `galloping keys create` makes one")
    with processes.until_stopped() as wait:
        api_process = processes.start(settings, "app.serve", host, str(port))
        worker_process = processes.start(settings, "worker")
        while not wait(_LOOK_SECONDS) and api_process.poll() is None:
            if worker_process.poll() is not None:
                _logger.warning("the worker ended with code %s and is started again", worker_process.returncode)
                worker_process = processes.start(settings, "worker")
        code = api_process.poll()
        processes.stop([api_process, worker_process], signal.SIGTERM, settings.shutdown_seconds + _STOP_SECONDS)
    return code or 0


def _has_keys(settings: Settings) -> bool:
    engine = make_engine(settings)
    try:
        with session_factory(engine, read_only=True)() as session:
            return keys.any_exist(session)
    finally:
        engine.dispose()


def _application() -> "Service":
    """Make the application of one API process, which is a child of uvicorn's if there are several."""
    from app.main import create_app  # noqa: PLC0415 - the client library of the metrics reads the variable as it loads

    settings = get_settings()
    _reserve_metrics(Path(os.environ[_SHARED_METRICS]))
    telemetry.configure(settings, "api")
    if settings.api_processes > 1:
        logs.configure(settings)
        processes.end_with_parent(os.getppid())
    app = create_app(settings)
    _release_at_a_stop(app)
    _exempt_what_stays()
    return app


def _exempt_what_stays() -> None:
    """Let the garbage collector pass over what is loaded by now: to go through it all holds up everybody for 0.2 s."""
    gc.collect()
    gc.freeze()


def _release_at_a_stop(app: "Service") -> None:
    """Let those go who wait for a change as soon as a stop is asked for: the server waits for them before it ends."""
    loop = asyncio.get_running_loop()

    def release() -> None:
        for watch in (app.state.job_watch, app.state.batch_watch):
            watch.release()

    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, partial(_after, partial(loop.call_soon_threadsafe, release), signal.getsignal(number)))


def _after(first: Callable[[], object], handler: Any, number: int, frame: FrameType | None) -> None:
    first()
    handler(number, frame)


def _empty_folder(path: Path) -> Path:
    """Make a folder without anything in it; what an earlier run counted there is no longer counted on."""
    shutil.rmtree(path, ignore_errors=True)
    path.mkdir(parents=True)
    return path


def _reserve_metrics(folder: Path) -> None:
    """Write the file of this process's metrics in full: the library maps it, and a disk without room kills who counts.

    It would make a sparse file, whose pages are only sought when they are written, by a signal instead of an error.
    """
    (folder / f"histogram_{os.getpid()}.db").write_bytes(bytes(_METRICS_BYTES))


if __name__ == "__main__":
    processes.end_with_parent()
    sys.exit(api(get_settings(), sys.argv[1], int(sys.argv[2])))
