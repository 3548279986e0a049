import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from app.runtime import processes
from app.runtime.settings import Settings

STUBBORN = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); print('up', flush=True); time.sleep(60)"
PARENT = """
import subprocess, sys, os
from app.runtime.processes import _PARENT
watched = "from app.runtime.processes import end_with_parent; end_with_parent(); print('up', flush=True); input()"
child = subprocess.Popen([sys.executable, "-c", watched], env={**os.environ, _PARENT: str(os.getpid())},
                         stdin=subprocess.PIPE, stdout=subprocess.PIPE)
child.stdout.readline()
print(child.pid, flush=True)
input()
"""


def test_children_get_settings_and_one_blas_thread(tmp_path: Path) -> None:
    variables = processes.environment(Settings(data_dir=tmp_path, max_attempts=7))
    assert (variables["GALLOPING_MAX_ATTEMPTS"], variables["GALLOPING_DATA_DIR"]) == ("7", str(tmp_path))
    assert {variables[name] for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")} == {"1"}
    assert variables["PATH"] == os.environ["PATH"]


def test_child_that_does_not_end_in_time_is_killed() -> None:
    with subprocess.Popen([sys.executable, "-c", STUBBORN], stdout=subprocess.PIPE) as child:
        assert child.stdout is not None
        assert child.stdout.readline() == b"up\n"
        start = time.monotonic()
        processes.stop([child], signal.SIGTERM, 0.3)
        assert 0.3 <= time.monotonic() - start < 10.0
        assert child.returncode == -signal.SIGKILL


def test_child_that_ends_in_time_is_not_killed() -> None:
    with subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"]) as child:
        processes.stop([child], signal.SIGTERM, 30.0)
        assert child.returncode == -signal.SIGTERM


def test_child_ends_with_a_killed_parent() -> None:
    pipe = subprocess.PIPE
    with subprocess.Popen([sys.executable, "-c", PARENT], stdin=pipe, stdout=pipe) as parent:
        assert parent.stdout is not None
        child = int(parent.stdout.readline())
        parent.kill()
        parent.wait()
        deadline = time.monotonic() + 10.0
        while is_running(child):
            assert time.monotonic() < deadline, "the child outlives its parent"
            time.sleep(0.05)


def is_running(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_wait_tells_of_a_signal_at_once_and_handlers_come_back(number: signal.Signals) -> None:
    former = signal.getsignal(number)
    with processes.until_stopped() as wait:
        assert not wait(0.01)
        timer = threading.Timer(0.1, os.kill, (os.getpid(), number))
        timer.start()
        start = time.monotonic()
        assert wait(30.0)
        assert time.monotonic() - start < 10.0
        timer.join()
    assert signal.getsignal(number) is former
