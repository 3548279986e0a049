import os
import time
from pathlib import Path

from app.runtime.settings import Settings
from worker.health import is_alive, show_life


def test_worker_is_alive_only_while_it_sweeps(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path / "data")
    now = time.time()
    assert not is_alive(settings, now)
    show_life(settings)
    assert is_alive(settings, now)
    for off in (-31.0, 31.0):  # a file of the future was written before the clock was set back
        os.utime(tmp_path / "data" / "worker-alive", (now + off, now + off))
        assert not is_alive(settings, now)
    show_life(settings)
    assert is_alive(settings, now)
