"""What `submit` says while it waits, and help by its short name."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from typer.testing import CliRunner

from app import client
from app.cli import app


class Waiting:
    """A client whose wait is interrupted from the keyboard."""

    def __init__(self, *_: Any, **__: Any) -> None: ...
    def __enter__(self) -> "Waiting":
        return self

    def __exit__(self, *_: object) -> None: ...
    def submit_document(self, _: Any) -> Any:
        return SimpleNamespace(id="0199a3c4")

    def wait(self, *_: Any) -> Any:
        raise KeyboardInterrupt


def test_ctrl_c_says_the_job_and_where_its_result_will_be(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(client, "Client", Waiting)
    line = tmp_path / "line.json"
    line.write_text(json.dumps({"name": "line"}))
    ended = CliRunner().invoke(app, ["submit", str(line), "--wait", "--url", "http://here:8000"])
    assert ended.exit_code == 130
    assert "job 0199a3c4 goes on; its result will be at http://here:8000/v1/jobs/0199a3c4/results" in ended.output


@pytest.mark.parametrize("arguments", [["-h"], ["submit", "-h"], ["keys", "list", "-h"]])
def test_help_has_a_short_name(arguments: list[str]) -> None:
    ended = CliRunner().invoke(app, arguments)
    assert ended.exit_code == 0
    assert "Usage" in ended.output
