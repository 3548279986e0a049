"""`galloping remedies` prints a table on a terminal, and JSON elsewhere."""

import json
from pathlib import Path

from app.reference.source_lines import example
from tests.app.command_line import galloping, on_a_terminal, refused


def test_the_table_and_the_result(tmp_path: Path) -> None:
    line, tried = tmp_path / "line.json", tmp_path / "remedies.json"
    analysis = {"loops": [2], "wind_speeds_m_per_s": [6.0]}
    line.write_text(json.dumps({"line": example("c11-twin"), "analysis": analysis}))
    remedy = {"type": "detuning_pendulum", "positions_m": [31.47, 94.41], "mass_kg": 15.0, "arm_m": 0.3}
    tried.write_text(json.dumps({"tried": [remedy]}))
    output = tmp_path / "result.json"
    asked = ("remedies", str(line), "--remedies", str(tried))
    shown = on_a_terminal(*asked, "--output", str(output))
    table = shown.partition("-  The line as it is.")[0].splitlines()
    assert any("detuning pendulum" in row for row in table)
    assert max(map(len, map(str.rstrip, table))) <= 80
    assert not any("margin" in row for row in table)  # the line has no phases
    assert "Better: the onset rises from 2.25 to" in shown
    result = json.loads(output.read_text())
    assert [row["rank"] for row in result["remedies"]] == [None, 1]
    assert json.loads(galloping(*asked).stdout)["remedies"] == result["remedies"]
    feet = on_a_terminal(*asked, "--units", "feet")
    assert "Better: the onset rises from 5.03 to" in feet and " mph, " in feet
    assert result["input"]["remedies"]["tried"][0]["positions_m"] == [31.47, 94.41]


def test_a_fault_names_its_field(tmp_path: Path) -> None:
    tried = tmp_path / "remedies.json"
    tried.write_text(json.dumps({"tried": [{"type": "tension", "factor": 99}]}))
    line = tmp_path / "line.json"
    line.write_text(json.dumps(example("c11-twin")))
    assert "/remedies/tried/0" in refused("remedies", str(line), "--remedies", str(tried))
