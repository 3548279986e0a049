"""What `galloping analyse` prints for a person."""

import json
from pathlib import Path

import pytest

from app.pages.measures import SI
from app.reference.source_lines import example
from tests.app.command_line import galloping, on_a_terminal
from tests.app.known_documents import CONTRACT
from tests.app.lines import SHORT, changed
from tests.documents import short_request


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


def test_distances_and_weights_stand_below_the_motions(tmp_path: Path) -> None:
    phases = [{"name": "top", "y_m": 7.0, "z_m": 0.0}]
    line = {**CONTRACT, "phases": phases, "required_clearance_m": 5.9}
    analysis = {"models": ["hybrid"], "loops": [1], "wind_speeds_m_per_s": [6.0]}
    path = tmp_path / "known.json"
    path.write_text(json.dumps({"line": line, "analysis": analysis}))
    result = json.loads(galloping("analyse", str(path)).stdout)
    printed = on_a_terminal("analyse", str(path))
    computed = min(row["distance_m"] for row in result["clearances"] if row["method"] == "computed")
    (row,) = [text.split() for text in printed.splitlines() if "computed" in text]
    assert row == ["this", "top", "computed", f"{computed:.2f}", "5.90", "yes" if computed > 5.9 else "no"]
    weighty = {row["path"] for row in result["sensitivities"] if (row["onset_total_lowest"] or 0.0) >= 0.01}
    assert ("What the assumed values weigh" in printed) == bool(weighty)
    assert {row["path"] for row in result["sensitivities"] if f" {row['path']} " in printed} == weighty


def test_a_report_is_written_as_pdf_or_html(request_file: str, tmp_path: Path) -> None:
    galloping("analyse", request_file, "--report", str(tmp_path / "report.pdf"))
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF-")
    result = json.loads(galloping("analyse", request_file, "--report", str(tmp_path / "report.html")).stdout)
    assert SI.sentence(result["verdict"][0]["sentence"]) in (tmp_path / "report.html").read_text(encoding="utf-8")
