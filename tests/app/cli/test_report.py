"""What `galloping analyse` prints for a person."""

import json
import os
import pty
import subprocess
import sys
from pathlib import Path

import pytest

from app.reference.source_lines import example
from tests.app.command_line import galloping
from tests.app.lines import SHORT, changed
from tests.documents import short_request


def on_a_terminal(*arguments: str) -> str:
    """Return what a command prints on a terminal of its own."""
    ours, theirs = pty.openpty()
    environment = {**os.environ, "COLUMNS": "100", "TERM": "dumb"}
    command = [sys.executable, "-m", "app.cli", *arguments]
    with subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=subprocess.PIPE, env=environment) as running:
        os.close(theirs)
        printed = b""
        while True:
            try:
                piece = os.read(ours, 65536)
            except OSError:  # the other end is closed
                break
            if not piece:
                break
            printed += piece
        assert running.wait(60.0) == 0, running.stderr.read() if running.stderr else ""
    os.close(ours)
    return printed.decode().replace("\r\n", "\n")


@pytest.fixture
def request_file(tmp_path: Path) -> str:
    path = tmp_path / "request.json"
    path.write_text(json.dumps(short_request()))
    return str(path)


def test_a_terminal_shows_the_verdict_before_the_tables(request_file: str) -> None:
    result = json.loads(galloping("analyse", request_file).stdout)
    printed = on_a_terminal("analyse", request_file)
    assert printed.startswith(result["verdict"][0]["sentence"])
    stable = [row for row in result["limit_cycles"] if row["stability"] == "stable" and row["kind"] != "equilibrium"]
    for row in stable:
        assert f"{2.0 * row['vertical_m']:.2f}" in printed
    assert f"{result['critical_wind_speeds'][0]['wind_speed_m_per_s']:.2f}" in printed
    for text in result["warnings"]:
        assert text[:40] in printed


def test_a_terminal_shows_json_where_it_is_asked_for(request_file: str) -> None:
    assert json.loads(on_a_terminal("analyse", request_file, "--json"))["verdict"]


def test_every_point_of_a_study_has_its_verdict(tmp_path: Path) -> None:
    axis = {"parameter": "span.horizontal_tension_n", "values": [24000, 36000]}
    path = tmp_path / "study.json"
    path.write_text(json.dumps({"line": example("c11-twin"), "analysis": SHORT, "study": {"axes": [axis]}}))
    printed = on_a_terminal("analyse", str(path))
    for tension in axis["values"]:
        assert f"span.horizontal_tension_n {tension}: Gallops from" in printed


def test_a_line_that_rests_has_no_table_of_motions(tmp_path: Path) -> None:
    path = tmp_path / "calm.json"
    line = changed("damping.vertical_ratio", 0.2, example("c11-twin"))
    path.write_text(
        json.dumps({"line": line, "analysis": SHORT | {"models": ["hybrid"], "wind_speeds_m_per_s": [1.0]}})
    )
    printed = on_a_terminal("analyse", str(path))
    assert "Stays at rest" in printed
    assert "Stable motions" not in printed


def test_tables_are_written_as_csv(request_file: str, tmp_path: Path) -> None:
    result = json.loads(galloping("analyse", request_file, "--csv", str(tmp_path / "tables")).stdout)
    lines = (tmp_path / "tables" / "verdict.csv").read_text().splitlines()
    assert lines[0].split(",")[0] == "gallops"
    assert lines[1].startswith("yes,")
    filled = {name for name, rows in result.items() if isinstance(rows, list) and rows and isinstance(rows[0], dict)}
    written = {path.stem for path in (tmp_path / "tables").iterdir()}
    assert written == filled - {"static", "den_hartog", "failures"}


def test_an_output_that_cannot_be_written_is_noticed_before_the_work(request_file: str, tmp_path: Path) -> None:
    ended = galloping("analyse", request_file, "--output", str(tmp_path / "missing" / "result.json"))
    assert ended.returncode == 2
    assert "missing" in ended.stderr
    assert "No such file or directory" in ended.stderr
