"""`galloping fit`: the figures of the API's fit, from JSON and from the table of a spreadsheet."""

import json
import math
from pathlib import Path
from typing import Any

import pytest

from app import convert, schemas
from tests.app.command_line import on_a_terminal, refused, run

ANGLES = [30.0, 34.0, 38.0, 40.0, 42.0, 46.0, 50.0]


def table() -> list[dict[str, float]]:
    """Return coefficients whose drag is constant and whose lift falls steeply enough to gallop."""
    turned = [math.radians(angle - 40.0) for angle in ANGLES]
    return [
        {"angle_deg": angle, "lift": 0.3 - 2.0 * alpha, "drag": 1.1, "moment": 0.1 * alpha}
        for angle, alpha in zip(ANGLES, turned, strict=True)
    ]


def as_csv(directory: Path, separator: str = ",", point: str = ".") -> str:
    rows = [list(table()[0]), *([str(value).replace(".", point) for value in row.values()] for row in table())]
    path = directory / "table.csv"
    path.write_text("".join(separator.join(row) + "\n" for row in rows))
    return str(path)


def fitted() -> dict[str, Any]:
    document = {"table": table(), "static_angle_deg": 40.0, "half_range_deg": 15.0}
    return convert.fit(schemas.MeasuredCoefficients.model_validate(document))


ANGLE = ("--static-angle-deg", "40", "--half-range-deg", "15")


def test_a_table_is_fitted_from_either_file(tmp_path: Path) -> None:
    document = tmp_path / "table.json"
    document.write_text(json.dumps({"table": table(), "static_angle_deg": 40.0, "half_range_deg": 15.0}))
    expected = json.loads(json.dumps(fitted()))
    assert expected["den_hartog"]["coefficient"] == pytest.approx(-2.0 + 1.1, abs=0.02)
    assert expected["rows_used"] == 7
    assert json.loads(run("fit", str(document)).stdout) == expected
    assert json.loads(run("fit", as_csv(tmp_path), *ANGLE).stdout) == expected
    assert json.loads(run("fit", as_csv(tmp_path, ";", ","), *ANGLE).stdout) == expected
    narrower = json.loads(run("fit", str(document), "--half-range-deg", "7").stdout)
    assert narrower["rows_used"] == 5  # the option counts, not the file
    written = tmp_path / "fit.json"
    assert run("fit", str(document), "--output", str(written)).stdout == ""
    assert json.loads(written.read_text()) == expected


def test_a_person_reads_a_table_and_the_verdict(tmp_path: Path) -> None:
    shown = on_a_terminal("fit", as_csv(tmp_path), *ANGLE)
    assert "alpha^3" in shown and "horizontal" in shown
    assert "7 rows, up to 10 degrees from the static angle. Den Hartog's coefficient is -0." in shown
    assert "unstable" in shown


def test_what_is_wrong_is_named(tmp_path: Path) -> None:
    assert "/static_angle_deg: " in refused("fit", as_csv(tmp_path))
    (tmp_path / "table.csv").write_text("angle_deg,lift,drag,moment\n" + "40,0.3,1.1,x\n" * 5)
    assert "/table/0/moment: " in refused("fit", str(tmp_path / "table.csv"), *ANGLE)
    (tmp_path / "list.json").write_text("[]")
    assert "must be an object" in refused("fit", str(tmp_path / "list.json"))
    assert "cannot be read" in refused("fit", str(tmp_path / "none.csv"))
