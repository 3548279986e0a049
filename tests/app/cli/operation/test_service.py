"""`galloping serve` on a terminal: it says where it is, and nothing about requests."""

import os
import pty
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Thread

import httpx
import pytest

from app.runtime.processes import environment
from app.runtime.settings import Settings
from tests.app.command_line import printed_pieces, refused
from tests.processes import Process, group, kill_group
from tests.servers import free_port, wait_until


@contextmanager
def serving_on_a_terminal(settings: Settings, *arguments: str) -> Iterator[tuple[Process, list[str]]]:
    """Run `galloping serve` on a terminal of its own, and give it with what it prints there, as it grows."""
    ours, theirs = pty.openpty()
    printed: list[str] = []
    reader = Thread(target=lambda: printed.extend(piece.decode() for piece in printed_pieces(ours)))
    command = [sys.executable, "-m", "app.cli", "serve", "--data-dir", str(settings.data_dir), *arguments]
    # What the test settings say would count as the operator's choice.
    chosen = {name: text for name, text in environment(settings).items() if not name.startswith("GALLOPING_LOG_")}
    process = subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=theirs, env=chosen, start_new_session=True)
    os.close(theirs)
    reader.start()
    try:
        yield process, printed
    finally:
        kill_group(process)
        reader.join()
        os.close(ours)


@pytest.mark.parametrize("verbose", [False, True])
def test_a_terminal_reads_the_address_and_no_flood(tmp_path: Path, verbose: bool) -> None:
    port = free_port()
    settings = Settings(data_dir=tmp_path, worker_processes=1)
    arguments = ("--port", str(port), *(["--verbose"] if verbose else []))
    address = f"http://127.0.0.1:{port}"
    with serving_on_a_terminal(settings, *arguments) as (process, printed):
        if verbose:
            wait_until(lambda: "Uvicorn running" in "".join(printed), 60.0, "the log")
        else:
            wait_until(lambda: "Ctrl-C ends it" in "".join(printed), 60.0, "the address")
        with httpx.Client(base_url=address) as client:
            wait_until(lambda: client.get("/health/live").status_code == 200, what="an answer")
            assert [client.get(path).status_code for path in ("/nothing", "/docs", "/v1/fields")] == [404, 200, 200]
            wait_until(lambda: client.get("/health/ready").status_code == 200, 60.0, "a worker")
            wait_until(lambda: len(group(process)) >= 5, 60.0, "the process of the pool")
        os.killpg(process.pid, signal.SIGINT)  # Ctrl-C reaches every process of the terminal
        assert process.wait(30.0) == 0
    text = "".join(printed)
    assert "Hitting Ctrl+C" not in text and "Warm shutdown" not in text
    if verbose:
        assert '"event": "request"' in text and "Ctrl-C ends it" not in text
    else:
        said = f"Galloping is at {address}/ (pages) and {address}/docs (API). Its files are in {tmp_path}."
        assert said in text
        assert "/nothing" not in text and '"event"' not in text and "Uvicorn" not in text


def test_a_port_that_is_taken_is_named(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
        told = refused("serve", "--port", str(port), "--data-dir", str(tmp_path / "data"))
    assert told.startswith(f"cannot listen on port {port} of 127.0.0.1: Address already in use")
    assert not (tmp_path / "data").exists()
