"""Processes of ours in tests: started in a session of their own, looked at, and killed by their ids."""

import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

from app.runtime.processes import ONE_BLAS_THREAD, environment
from app.runtime.settings import Settings
from tests.servers import wait_until

Process = subprocess.Popen[bytes]


@contextlib.contextmanager
def running(settings: Settings, *arguments: str, extra: Mapping[str, str] | None = None) -> Iterator[Process]:
    """Run Python with these arguments, settings and variables; at the end every process of its group is killed."""
    with (settings.data_dir / "process.log").open("ab") as log:
        process = subprocess.Popen(
            [sys.executable, *arguments],
            env={**environment(settings), **(extra or {})},
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=log,
            start_new_session=True,
        )
    try:
        yield process
    finally:
        kill_group(process)


@contextlib.contextmanager
def running_worker(settings: Settings, extra: Mapping[str, str] | None = None) -> Iterator[Process]:
    """Run a worker whose pool is up, so that it has children of children."""
    with running(settings, "-m", "worker", extra=extra) as process:
        wait_until(lambda: len(pool_children(process)) == settings.worker_processes, what="the pool")
        yield process


def kill_group(process: Process) -> None:
    """Kill a process and all others of its group at once, as a power failure would, and wait for their end."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    wait_until(lambda: not group(process), 10.0, "the end of the group")


def group(process: Process) -> list[int]:
    """Return the ids of the living processes in the group of a process."""
    return [pid for pid in _all() if _stat(pid)[2] == str(process.pid) and _stat(pid)[0] != "Z"]


def children(pid: int) -> list[int]:
    """Return the ids of the living children of a process."""
    return [child for child in _all() if _stat(child)[1] == str(pid) and _stat(child)[0] != "Z"]


def pool_children(worker: Process) -> list[int]:
    """Return the ids of the processes that run jobs for a worker."""
    return [child for pool in children(worker.pid) for child in children(pool)]


def busy_child(worker: Process) -> int:
    """Return the id of the one process that runs a job: its heartbeat is a second thread."""
    wait_until(lambda: len(_busy(worker)) == 1, 10.0, "one process at work")
    return _busy(worker)[0]


def _busy(worker: Process) -> list[int]:
    return [pid for pid in pool_children(worker) if len(list(Path(f"/proc/{pid}/task").iterdir())) > 1]


def _all() -> list[int]:
    return [int(path.name) for path in Path("/proc").iterdir() if path.name.isdigit()]


def _stat(pid: int) -> list[str]:
    """Return state, parent and group of a process; empty words if it is gone."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[:3]
    except (FileNotFoundError, ProcessLookupError):
        return ["Z", "", ""]


def printed(script: str) -> str:
    """Run a script in a process of its own, since what is frozen and loaded stays, and return what it says."""
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env={**os.environ, **ONE_BLAS_THREAD})
    return done.stdout.strip()
