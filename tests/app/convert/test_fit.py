import math
from typing import Any

import pytest

from app import convert, schemas
from app.reference.source_lines import example
from app.schemas.faults import BadInput
from tests.app.lines import faults

A_Y, A_Z, A_M = (0.2, -0.1667, -4.0547, 8.3581), (1.1, 0.8605, 0.8325, 1.7815), (-0.1, -0.7272, 0.2935, 5.9704)


def request(half_range: float = 20.0, static: float = 40.0) -> schemas.MeasuredCoefficients:
    """Return a table of exact cubics about 40 degrees: C_L = C_y cos - C_z sin, C_D = C_y sin + C_z cos."""
    rows = []
    for angle in range(10, 71, 2):
        a = math.radians(angle - 40.0)
        c_y, c_z, c_m = (sum(c * a**j for j, c in enumerate(row)) for row in (A_Y, A_Z, A_M))
        lift, drag = c_y * math.cos(a) - c_z * math.sin(a), c_y * math.sin(a) + c_z * math.cos(a)
        rows.append({"angle_deg": float(angle), "lift": lift, "drag": drag, "moment": c_m})
    return schemas.MeasuredCoefficients.model_validate(
        {"table": rows, "static_angle_deg": static, "half_range_deg": half_range},
    )


def test_angles_in_degrees_give_slopes_per_radian() -> None:
    answer = convert.fit(request())
    assert answer["aerodynamics"]["vertical"] == pytest.approx(A_Y[1:], rel=1e-9)
    assert answer["aerodynamics"]["horizontal"] == pytest.approx(A_Z[1:], rel=1e-9)
    assert answer["aerodynamics"]["torsional"] == pytest.approx(A_M[1:], rel=1e-9)
    assert answer["aerodynamics"]["fitted_range_deg"] == pytest.approx(20.0)
    assert list(answer["aerodynamics_at_rest"].values()) == pytest.approx([A_Y[0], A_Z[0], A_M[0]])
    assert answer["rows_used"] == 21
    assert list(answer["residual"].values()) == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)


def test_den_hartog_over_the_angle_passes_through_the_fits_at_the_static_angle() -> None:
    answer = convert.fit(request())
    assert len(answer["den_hartog_over_angle"]) == 31
    here = next(row for row in answer["den_hartog_over_angle"] if row["angle_deg"] == 40.0)
    assert answer["den_hartog"]["coefficient"] == pytest.approx(A_Y[1])
    assert here["coefficient"] == pytest.approx(A_Y[1], abs=0.02)  # differences over four degrees
    assert here["unstable"] is answer["den_hartog"]["unstable"] is True


@pytest.mark.parametrize(("half_range", "static"), [(3.0, 40.0), (20.0, 120.0)])
def test_too_few_rows_are_told_at_the_field_of_the_request(half_range: float, static: float) -> None:
    with pytest.raises(BadInput) as caught:
        convert.fit(request(half_range, static))
    assert [fault.pointer for fault in caught.value.faults] == ["/half_range_deg"]


def outcomes(aerodynamics: dict[str, Any]) -> set[str]:
    """Return the outcomes of the cycles of the twin line with these coefficients."""
    line = example("c11-twin")
    line["ice"]["aerodynamics"] = aerodynamics
    analysis = {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [6.0]}
    asked = convert.read({"line": line, "analysis": analysis}).model_dump(mode="json", by_alias=True)
    points = [item for item in convert.run(asked) if isinstance(item, convert.PointResult)]
    return {str(row["outcome"]) for row in points[0].tables["limit_cycles"] if row["kind"] == "periodic"}


def test_a_cycle_beyond_the_fitted_range_says_so() -> None:
    fitted = convert.fit(request())["aerodynamics"]
    assert outcomes(fitted | {"fitted_range_deg": 60.0}) == {"converged"}
    assert outcomes(fitted | {"fitted_range_deg": 5.0}) == {"outside_fit"}


def measured() -> dict[str, Any]:
    """Return the request as a line takes it."""
    return request().model_dump(mode="json", by_alias=True)


def test_a_line_with_the_table_is_the_line_with_its_fit() -> None:
    fitted = convert.fit(request())
    first, second = (example("c11-twin") for _ in range(2))
    first["ice"]["aerodynamics"] = measured()
    second["ice"] |= {name: fitted[name] for name in ("aerodynamics", "aerodynamics_at_rest")}
    options = {"physics": "source", "aerodynamic_model": "relative_wind"}
    asked = {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [6.0], **options}
    tables = [_tables({"line": line, "analysis": asked}) for line in (first, second)]
    assert tables[0] == tables[1]


def _tables(document: dict[str, Any]) -> object:
    asked = convert.read(document).model_dump(mode="json", by_alias=True)
    return next(item for item in convert.run(asked) if isinstance(item, convert.PointResult)).tables


@pytest.mark.parametrize(
    ("change", "pointer"),
    [
        ({"half_range_deg": 3.0}, "/line/ice/aerodynamics/half_range_deg"),
        ({"static_angle_deg": 400.0}, "/line/ice/aerodynamics/static_angle_deg"),
        ({"vertical": [1.0, 2.0, 3.0]}, "/line/ice/aerodynamics/vertical"),
    ],
)
def test_faults_of_a_table_point_into_the_line(change: dict[str, Any], pointer: str) -> None:
    line = example("c11-twin")
    line["ice"]["aerodynamics"] = measured() | change
    assert [fault.pointer for fault in faults({"line": line})] == [pointer]


def test_values_at_rest_beside_a_table_are_refused() -> None:
    line = example("c11-twin")
    line["ice"] |= {
        "aerodynamics": measured(),
        "aerodynamics_at_rest": {"vertical": 0, "horizontal": 1, "torsional": 0},
    }
    assert [fault.pointer for fault in faults({"line": line})] == ["/line/ice/aerodynamics_at_rest"]


def test_static_twist_is_asked_for_by_its_word() -> None:
    line = example("c11-single")
    line["span"]["length_m"] = 250.0
    analysis = {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [4.0], "static_twist": "solved"}
    asked = convert.read({"line": line, "analysis": analysis}).model_dump(mode="json", by_alias=True)
    point = next(item for item in convert.run(asked) if isinstance(item, convert.PointResult))
    assert point.static["twist_rad"] == pytest.approx(-2.37, abs=0.3)
    assert {row["outcome"] for row in point.tables["frequencies"]} == {"converged"}


def test_slopes_per_degree_are_a_warning_of_the_result_and_a_doubt_of_resolving() -> None:
    line = example("c11-single")
    for row in line["ice"]["aerodynamics"].values():
        row[:] = [value * math.radians(1.0) ** (power + 1) for power, value in enumerate(row)]
    asked = convert.read({"line": line, "analysis": {"loops": [1], "wind_speeds_m_per_s": [5.0]}}).kept()
    (point,) = (item for item in convert.run(asked) if isinstance(item, convert.PointResult))
    assert any("look like slopes per degree" in warning for warning in point.warnings)
    (doubt,) = convert.resolve_document(line)["doubts"]
    assert "look like slopes per degree" in doubt
    assert convert.resolve_document(example("c11-single"))["doubts"] == []
