"""Child processes: start them with the settings in their environment, end them with their parent, stop them in time."""

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from queue import Empty, SimpleQueue
from types import FrameType
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:  # pydantic loads slowly, and `galloping analyse` needs no settings
    from app.runtime.settings import Settings

_PARENT = "GALLOPING_PARENT_PROCESS"
_POLL_SECONDS = 0.3
# BLAS threads can deadlock in forked workers. The library reads these variables once, when numpy loads it.
ONE_BLAS_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")


def environment(settings: "Settings") -> dict[str, str]:
    """Return this process's environment with the settings added and BLAS limited to one thread.

    A child imports nothing from the folder that it is started in, where a file may be called `worker.py` or `redis.py`.
    """
    return {**os.environ, **ONE_BLAS_THREAD, **_import_paths(), **settings.environment()}


def _import_paths() -> dict[str, str]:
    safe = {"PYTHONSAFEPATH": "1"}
    if not __name__.startswith("app."):
        return safe  # installed: Python finds us in its own folders
    paths = [str(Path(__file__).parents[2]), *filter(None, [os.environ.get("PYTHONPATH")])]
    return safe | {"PYTHONPATH": os.pathsep.join(paths)}


def start(
    settings: "Settings",
    module: str,
    *arguments: str,
    extra: Mapping[str, str] | None = None,
    log: IO[bytes] | None = None,
) -> "Child":
    """Start one of our modules as a child process; send its output to `log` if given.

    The module should call `end_with_parent`.

    Raises
    ------
    OSError
        If the process cannot be started.
    """
    variables = {**environment(settings), _PARENT: str(os.getpid()), **(extra or {})}
    command = [sys.executable, "-m", module, *arguments]
    return subprocess.Popen(command, env=variables, stdin=subprocess.DEVNULL, stdout=log, stderr=log)


Child = subprocess.Popen[bytes]


def end_with_parent(parent: int | None = None) -> None:
    """End this process soon after its parent ends, even if the parent was killed; without a known parent, do nothing.

    An orphan would keep a port, take messages, and work on jobs that now belong to another process.
    """
    expected = parent or int(os.environ.get(_PARENT, "0"))
    if expected:
        threading.Thread(target=_watch, args=(expected,), name="watch-parent", daemon=True).start()


def stop(children: Sequence[Child], signal_number: int, seconds: float) -> None:
    """Signal the children to end, and kill those still running after `seconds`."""
    for child in children:
        child.send_signal(signal_number)
    deadline = time.monotonic() + seconds
    for child in children:
        try:
            child.wait(max(0.0, deadline - time.monotonic()))
        except subprocess.TimeoutExpired:
            child.kill()
            child.wait()


@contextlib.contextmanager
def until_stopped() -> Iterator[Callable[[float], bool]]:
    """Yield a function that waits for some seconds and tells whether SIGTERM or SIGINT has arrived."""
    signals: SimpleQueue[int] = SimpleQueue()  # a handler may put while this thread gets; an Event would deadlock

    def note(number: int, _frame: FrameType | None) -> None:
        signals.put(number)

    def wait(seconds: float) -> bool:
        try:
            signals.get(timeout=seconds)
        except Empty:
            return False
        return True

    former = {number: signal.signal(number, note) for number in (signal.SIGTERM, signal.SIGINT)}
    try:
        yield wait
    finally:
        for number, handler in former.items():
            signal.signal(number, handler)


def _watch(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(_POLL_SECONDS)
    os._exit(1)  # at once: the next start repairs what a clean shutdown would have done
