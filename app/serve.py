"""The commands that run the service: migrate, api, worker, and serve, which runs all of them together."""

import asyncio
import gc
import logging
import math
import os
import shutil
import signal
import socket
import sys
from collections.abc import Callable
from functools import partial
from http import HTTPStatus
from http.client import HTTPConnection, HTTPException
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any, NoReturn

import uvicorn

from app.runtime import logs, processes, telemetry
from app.runtime.loopback import is_loopback
from app.runtime.settings import Settings, get_settings
from app.runtime.signing import make_signing_key
from app.security import keys
from app.storage.database import make_engine, session_factory
from app.storage.migration import migrate

if TYPE_CHECKING:
    from app.main import Service

HTTP = f"{__package__}.http.bounded_heads:BoundedHeads"
"""The protocol class that uvicorn loads for each connection."""

_WORKER = f"{__package__.removesuffix('app')}worker"  # in a distribution all our packages lie in `galloping`
_SHARED_METRICS = "PROMETHEUS_MULTIPROC_DIR"  # prometheus_client reads this variable when it is imported
_METRICS_BYTES = 1 << 20  # far more than the metrics of all routes need
_STOP_SECONDS = 10.0
_POLL_SECONDS = 0.5
_EVERY_ADDRESS = {"0.0.0.0": "127.0.0.1", "::": "::1"}  # hosts that stand for all addresses -> one of them
_START_SECONDS = 30  # uvicorn replaces a process silent for this long; loading takes seconds on a busy machine

_logger = logging.getLogger(__name__)


class Unguarded(Exception):
    """Raised when the service would be open to other machines without any key."""


class PortTaken(Exception):
    """Raised when the service cannot listen on its port."""


def worker(settings: Settings, *, check: bool = False) -> NoReturn:
    """Replace this process by a worker program, or by one that ends with 0 if the worker here is alive.

    BLAS reads its settings only when a program loads it.
    """
    module = f"{_WORKER}.health" if check else _WORKER
    os.execve(sys.executable, [sys.executable, "-m", module], processes.environment(settings))


def api(settings: Settings, host: str, port: int) -> int:
    """Run the API alone until SIGTERM or SIGINT arrives; return 0.

    At a stop the API finishes the requests in progress, for at most `shutdown_seconds`.

    Raises
    ------
    OSError
        If `data_dir` cannot be written to.
    """
    logs.configure(settings)
    os.environ.update(settings.environment())  # the application reads them here, and in the child processes of uvicorn
    make_signing_key(settings)  # now, since the disk may be full when the first cursor is signed
    os.environ[_SHARED_METRICS] = str(_empty_folder(settings.data_dir / f"metrics-{port}"))
    uvicorn.run(
        f"{__package__}.serve:_application",
        factory=True,
        http=HTTP,
        loop="auto",
        host=host,
        port=port,
        workers=settings.api_processes,
        log_config=None,
        access_log=False,  # app.http.request_log replaces it
        server_header=False,
        proxy_headers=False,  # app.http.forwarded replaces them, for the proxies that the operator trusts
        timeout_worker_healthcheck=_START_SECONDS,
        timeout_graceful_shutdown=math.ceil(settings.shutdown_seconds),
    )
    return 0


def serve(settings: Settings, host: str, port: int, announce: Callable[[], object] = lambda: None) -> int:
    """Migrate, then run the API and a worker as child processes until SIGTERM or SIGINT; return the exit code.

    Call `announce` once when the API answers.

    If the worker exits, start it again. If the API exits, end the service with its exit code. Both children end when
    this process ends, even if it is killed. The next start resumes unfinished work.

    Raises
    ------
    Unguarded
        If other machines could reach the service and no key exists.
    PortTaken
        If another program listens on the port.
    """
    logs.configure(settings)
    _check_port(host, port)
    migrate(settings)
    if not is_loopback(host) and settings.oidc_issuer is None and not _has_keys(settings):
        raise Unguarded(f"other machines can reach {host}, and no key exists: create one with `galloping keys create`")
    with processes.until_stopped() as wait:
        api_process = processes.start(settings, f"{__package__}.serve", host, str(port))
        worker_process = processes.start(settings, _WORKER)
        announced = False
        while not wait(_POLL_SECONDS) and api_process.poll() is None:
            if not announced and _answers(host, port):
                announced = True
                announce()
            if worker_process.poll() is not None:
                _logger.warning("the worker exited with code %s; starting it again", worker_process.returncode)
                worker_process = processes.start(settings, _WORKER)
        code = api_process.poll()
        processes.stop([api_process, worker_process], signal.SIGTERM, settings.shutdown_seconds + _STOP_SECONDS)
    return code or 0


def _check_port(host: str, port: int) -> None:
    try:
        family, *_, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        socket.create_server(address[:2], family=family).close()
    except OSError as error:
        raise PortTaken(f"cannot listen on port {port} of {host}: {error.strerror or error}") from error


def _answers(host: str, port: int) -> bool:
    connection = HTTPConnection(_EVERY_ADDRESS.get(host, host), port, timeout=_POLL_SECONDS)
    try:
        connection.request("GET", "/health/live")
        return connection.getresponse().status < HTTPStatus.INTERNAL_SERVER_ERROR
    except (OSError, HTTPException):
        return False
    finally:
        connection.close()


def _has_keys(settings: Settings) -> bool:
    engine = make_engine(settings)
    try:
        with session_factory(engine, read_only=True)() as session:
            return keys.any_exist(session)
    finally:
        engine.dispose()


def _application() -> "Service":
    """Build the application of one API process; with several processes, each is a child of uvicorn."""
    from app.main import create_app  # noqa: PLC0415 - prometheus_client reads the variable when it is imported

    settings = get_settings()
    _reserve_metrics(Path(os.environ[_SHARED_METRICS]))
    telemetry.configure(settings, "api")
    if settings.api_processes > 1:
        logs.configure(settings)
        processes.end_with_parent(os.getppid())
    app = create_app(settings)
    _release_watches_on_stop(app)
    _freeze_loaded_objects()
    return app


def _freeze_loaded_objects() -> None:
    """Exclude everything loaded so far from garbage collection; a full collection stops all requests for 0.2 s."""
    gc.collect()
    gc.freeze()


def _release_watches_on_stop(app: "Service") -> None:
    """Release the clients that wait for a change as soon as a stop signal arrives.

    Otherwise the server would wait for them before it ends.
    """
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
    """Create an empty folder; delete what an earlier run left there, whose counts no longer matter."""
    shutil.rmtree(path, ignore_errors=True)
    path.mkdir(parents=True)
    return path


def _reserve_metrics(folder: Path) -> None:
    """Write this process's metrics file in full, because prometheus_client maps it into memory.

    The library would create a sparse file. On a full disk, writing to it kills the process by a signal instead of
    raising an error.
    """
    (folder / f"histogram_{os.getpid()}.db").write_bytes(bytes(_METRICS_BYTES))


if __name__ == "__main__":
    processes.end_with_parent()
    sys.exit(api(get_settings(), sys.argv[1], int(sys.argv[2])))
