"""Runs the command line in tests."""

import subprocess
import sys


def galloping(*arguments: str, text: str | None = None) -> subprocess.CompletedProcess[str]:
    """Run the command line as users do."""
    command = [sys.executable, "-W", "error", "-m", "app.cli", *arguments]
    return subprocess.run(command, input=text, capture_output=True, text=True, timeout=120.0, check=False)


def refused(*arguments: str, text: str | None = None) -> str:
    ended = galloping(*arguments, text=text)
    assert ended.returncode == 2, ended.stderr
    assert ended.stdout == ""
    assert "Traceback" not in ended.stderr
    return ended.stderr
