"""What the command line does whatever the command: versions, short help, completion in the shell."""

import os
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest

from app.convert import ENGINE_VERSION
from tests.app.command_line import run


def test_the_versions_are_printed() -> None:
    assert run("--version").stdout == f"galloping {version('galloping')}, engine {ENGINE_VERSION}\n"


@pytest.mark.parametrize("arguments", [["-h"], ["submit", "-h"], ["jobs", "-h"], ["keys", "list", "-h"]])
def test_help_has_a_short_name(arguments: list[str]) -> None:
    ended = run(*arguments)
    assert (ended.returncode, "Usage" in ended.stdout) == (0, True)


def in_bash(folder: Path, script: str) -> list[str]:
    """Run a script in a bash in which the command is on the path, and return the lines that it prints."""
    command = folder / "galloping"
    command.write_text(f'#!/bin/sh\nexec {sys.executable} -m app.cli "$@"\n')
    command.chmod(0o755)
    environment = {**os.environ, "PATH": f"{folder}{os.pathsep}{os.environ['PATH']}"}
    ended = subprocess.run(
        ["bash", "--norc", "-c", script], env=environment, capture_output=True, text=True, timeout=60.0, check=True
    )
    return ended.stdout.splitlines()


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (("galloping", "re"), ["remedies", "resolve"]),
        (("galloping", "jobs", "c"), ["cancel"]),
        (("galloping", "submit", "--w"), ["--wait"]),
    ],
)
def test_bash_completes_commands_and_options(tmp_path: Path, words: tuple[str, ...], offered: list[str]) -> None:
    typed = " ".join(words)
    script = (
        'eval "$(galloping --show-completion)"; complete -p galloping; '
        f'COMP_WORDS=({typed}); COMP_CWORD={len(words) - 1}; _galloping_completion galloping; printf "%s\\n" '
        '"${COMPREPLY[@]}"'
    )
    registered, *completions = in_bash(tmp_path, script)
    assert registered == "complete -o default -F _galloping_completion galloping"
    assert completions == offered


@pytest.mark.parametrize("shell", ["zsh", "fish"])
def test_other_shells_get_their_script(tmp_path: Path, shell: str) -> None:
    script = "\n".join(in_bash(tmp_path, f"_GALLOPING_COMPLETE=source_{shell} galloping"))
    assert "galloping" in script and f"_GALLOPING_COMPLETE=complete_{shell}" in script
    asked = f"_TYPER_COMPLETE_FISH_ACTION=get-args _GALLOPING_COMPLETE=complete_{shell}"
    offered = "\n".join(in_bash(tmp_path, f"{asked} _TYPER_COMPLETE_ARGS='galloping re' galloping"))
    assert "remedies" in offered and "resolve" in offered and "submit" not in offered
