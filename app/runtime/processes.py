"""Processes of our own: started with the settings in their environment, ended with their parent, stopped in time."""

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from queue import Empty, SimpleQueue
from types import FrameType
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:  # it loads slowly, and `galloping analyse` has no settings
    from app.runtime.settings import Settings

_PARENT = "GALLOPING_PARENT_PROCESS"
_LOOK_SECONDS = 0.3
# Threads of a BLAS library and forked workers freeze each other; the library reads these once, as numpy loads.
ONE_BLAS_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")


def environment(settings: "Settings") -> dict[str, str]:
    """Return this process's environment with the settings in it and one BLAS thread."""
    return {**os.environ, **ONE_BLAS_THREAD, **settings.environment()}


def start(
    settings: "Settings",
    module: str,
    *arguments: str,
    extra: Mapping[str, str] | None = None,
    log: IO[bytes] | None = None,
) -> "Child":
    """Start a module of ours as a child process, which should call `end_with_parent`; its output goes to log if given.

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
    """End this process soon after its parent, even if that was killed; without a known parent nothing happens.

    An orphan would keep a port, take messages, and work on jobs that are another's by now.
    """
    expected = parent or int(os.environ.get(_PARENT, "0"))
    if expected:
        threading.Thread(target=_watch, args=(expected,), name="watch-parent", daemon=True).start()


def stop(children: Sequence[Child], signal_number: int, seconds: float) -> None:
    """Ask the children to end, and kill those that have not done so in time."""
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
    """Give a function that waits for some seconds and tells whether SIGTERM or SIGINT has asked for an end."""
    asked: SimpleQueue[int] = SimpleQueue()  # its put, unlike an event's set, may interrupt a get of the same thread

    def ask(number: int, _frame: FrameType | None) -> None:
        asked.put(number)

    def wait(seconds: float) -> bool:
        try:
            asked.get(timeout=seconds)
        except Empty:
            return False
        return True

    former = {number: signal.signal(number, ask) for number in (signal.SIGTERM, signal.SIGINT)}
    try:
        yield wait
    finally:
        for number, handler in former.items():
            signal.signal(number, handler)


def _watch(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(_LOOK_SECONDS)
    os._exit(1)  # at once: whatever a clean end would do, the next start repairs
