"""What `tests/e2e/test_serve.py` and `tests/migrations` leave of app.serve: a worker that dies under the service."""

import os
import signal
from pathlib import Path

from app.settings import Settings
from tests.documents import short_request
from tests.e2e.test_serve import serving, submit, wait_for
from tests.processes import children
from tests.servers import free_port, wait_until


def test_worker_that_dies_is_started_again(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path, sweep_seconds=0.3, worker_processes=1)
    with serving(settings, free_port()) as (process, client):
        before = children(process.pid)
        assert len(before) == 2
        (worker,) = [pid for pid in before if "worker" in Path(f"/proc/{pid}/cmdline").read_text().split("\0")]
        os.kill(worker, signal.SIGKILL)
        wait_until(lambda: len(children(process.pid)) == 2 and worker not in children(process.pid), what="another")
        wait_for(client, submit(client, short_request()), "successful")
