"""Runs the command line in tests."""

import os
import pty
import subprocess
import sys
from collections.abc import Iterator, Mapping

from typer.testing import CliRunner

from app.cli import app


def galloping(*arguments: str, text: str | None = None) -> subprocess.CompletedProcess[str]:
    """Run the command line as users do."""
    command = [sys.executable, "-W", "error", "-m", "app.cli", *arguments]
    return subprocess.run(command, input=text, capture_output=True, text=True, timeout=120.0, check=False)


def run(*arguments: str, environment: Mapping[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    """Run a command in this process, which takes a small part of the time of `galloping`."""
    ended = CliRunner().invoke(app, arguments, env=environment)
    if ended.exception is not None and not isinstance(ended.exception, SystemExit):
        raise ended.exception
    return subprocess.CompletedProcess(arguments, ended.exit_code, ended.stdout, ended.stderr)


def refused(*arguments: str, text: str | None = None) -> str:
    ended = galloping(*arguments, text=text)
    assert ended.returncode == 2, ended.stderr
    assert ended.stdout == ""
    assert "Traceback" not in ended.stderr
    return ended.stderr


def on_a_terminal(*arguments: str, code: int = 0) -> str:
    """Return what a command prints on a terminal of its own, a hundred characters wide."""
    ours, theirs = pty.openpty()
    environment = {**os.environ, "COLUMNS": "100", "LINES": "50", "TERM": "dumb"}  # without LINES rich takes 80 columns
    command = [sys.executable, "-m", "app.cli", *arguments]
    with subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=subprocess.PIPE, env=environment) as running:
        os.close(theirs)
        printed = b"".join(printed_pieces(ours))
        assert running.wait(60.0) == code, running.stderr.read() if running.stderr else ""
    os.close(ours)
    return printed.decode().replace("\r\n", "\n")


def printed_pieces(ours: int) -> Iterator[bytes]:
    """Yield what is printed on the other end of a terminal, until that end is closed."""
    while piece := _read(ours):
        yield piece


def _read(end: int) -> bytes:
    try:
        return os.read(end, 65536)
    except OSError:  # the other end is closed
        return b""
