import copy
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from app import convert
from app.convert import PointResult, ranking_figures
from app.convert.run import specification_of_point
from app.reference.source_lines import example
from engine.analysis import analyse
from engine.outcome import Stability
from engine.progress import finished
from tests.app.lines import changed

TWIN = example("c11-twin")
WIDTH = 2.0 * 0.2355


def found(line: dict[str, Any], winds: list[float], loops: list[int] | None = None) -> PointResult:
    analysis = {"loops": loops or [1], "models": ["hybrid"], "wind_speeds_m_per_s": winds}
    request = convert.read({"line": line, "analysis": analysis}).model_dump(mode="json", by_alias=True)
    (point,) = (item for item in convert.run(request) if isinstance(item, PointResult))
    return point


def test_peaks_are_those_of_the_motions_that_last() -> None:
    point = found(TWIN, [4.0, 6.0], [1, 2])
    stable = [(i, row) for i, row in enumerate(point.tables["limit_cycles"]) if row["stability"] == "stable"]
    assert point.ranking_figures["largest_vertical_m"] == max(row["vertical_m"] for _, row in stable)
    winds = [row["wind_speed_m_per_s"] for row in point.tables["critical_wind_speeds"]]
    assert point.ranking_figures["lowest_critical_wind_speed_m_per_s"] == min(winds)
    assert len(stable) < len(point.tables["limit_cycles"])


def test_height_and_width_are_of_all_sub_conductors_over_the_whole_orbit() -> None:
    """Against points laid densely on the orbits by eq. (3), sub-conductor by sub-conductor."""
    point = found(TWIN, [4.0, 6.0], [1, 2])
    tau = np.linspace(0.0, 2.0 * math.pi, 20_001)
    height = width = 0.0
    for orbit in point.orbits:
        if point.tables["limit_cycles"][orbit["cycle"]]["stability"] != "stable":
            continue
        order = np.arange(1, len(orbit["vertical"]) // 2 + 1)[:, None]
        v, w, theta = (
            c[0] + np.array(c[1::2]) @ np.cos(order * tau) + np.array(c[2::2]) @ np.sin(order * tau)
            for c in (orbit["vertical"], orbit["horizontal"], orbit["torsional"])
        )
        y = np.concatenate([v - z * theta for z in (0.2355, -0.2355)])
        z = np.concatenate([z + w for z in (0.2355, -0.2355)])
        height, width = max(height, float(np.ptp(y))), max(width, float(np.ptp(z)))
    assert point.ranking_figures["largest_height_m"] == pytest.approx(height, rel=1e-3)
    assert point.ranking_figures["largest_width_m"] == pytest.approx(width, rel=1e-3)
    assert width > WIDTH + 0.9  # two loops at 6 m/s move sideways by 0.94 m


def test_a_line_at_rest_is_as_wide_as_its_bundle() -> None:
    point = found(TWIN, [1.0])
    assert point.ranking_figures["largest_vertical_m"] == 0.0
    assert point.ranking_figures["largest_height_m"] == pytest.approx(0.0, abs=1e-12)
    assert point.ranking_figures["largest_width_m"] == pytest.approx(WIDTH)


def test_a_line_that_is_unstable_without_wind_has_the_critical_wind_speed_0() -> None:
    line = changed("span.length_m", 400.0, example("c11-single"))
    point = found(line, [4.0])
    assert point.tables["frequencies"][0]["outcome"] == "statically_unstable"
    assert point.ranking_figures["lowest_critical_wind_speed_m_per_s"] == 0.0
    assert point.ranking_figures["largest_vertical_m"] == math.inf
    assert point.ranking_figures["largest_height_m"] == math.inf


def test_a_motion_that_nothing_bounds_outweighs_the_known_ones() -> None:
    """The source's twin with a vertical cubic of the wrong sign: at rest at 1 m/s, unbounded at 4 m/s."""
    line = copy.deepcopy(TWIN)
    line["ice"]["aerodynamics"]["vertical"][2] = -8.3581
    calm = found(line, [1.0]).ranking_figures
    assert calm["largest_vertical_m"] == 0.0
    point = found(line, [1.0, 4.0])
    outcomes = {row["outcome"] for row in point.tables["limit_cycles"] if row["wind_speed_m_per_s"] == 4.0}
    assert outcomes - {"converged"}
    assert point.ranking_figures["largest_vertical_m"] == math.inf
    assert point.ranking_figures["largest_width_m"] == math.inf


def test_lines_side_by_side_have_the_peaks_that_each_has_alone() -> None:
    """Bundles of one, two and four sub-conductors, and a line of which nothing is known."""
    unknown = changed("span.length_m", 400.0, example("c11-single"))
    others = example("c11-single"), example("c11-quad"), changed("span.horizontal_tension_n", 38000.0, TWIN)
    lines = [TWIN, unknown, *others]
    analysis = {"loops": [1, 2], "models": ["hybrid"], "wind_speeds_m_per_s": [4.0, 6.0]}
    numbered = [convert.NumberedLine(number, line) for number, line in enumerate(lines)]
    points = [item for item in convert.run_stack(analysis, numbered) if isinstance(item, PointResult)]
    assert [point.point for point in points] == list(range(len(lines)))
    for line, point in zip(lines, points, strict=True):
        alone = found(line, [4.0, 6.0], [1, 2]).ranking_figures
        for name, value in alone.items():
            assert point.ranking_figures[name] == (None if value is None else pytest.approx(value, rel=1e-6, abs=1e-12))
    widths = [point.ranking_figures["largest_width_m"] for point in points]
    assert widths[1] == math.inf
    assert len(set(widths)) == len(widths)


def test_many_orbits_are_followed_in_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    together = found(TWIN, [4.0, 6.0], [1, 2]).ranking_figures
    monkeypatch.setattr(ranking_figures, "_ORBITS_AT_ONCE", 1)
    assert found(TWIN, [4.0, 6.0], [1, 2]).ranking_figures == together


def test_hours_of_galloping_hold_those_of_which_nothing_is_known() -> None:
    sector = {"direction_deg": 0.0, "width_deg": 0.0, "share": 1.0, "weibull_shape": 2.0, "weibull_scale_m_per_s": 6.0}
    climate = {"line_azimuth_deg": 90.0, "sectors": [sector], "icing": [{"kind": "glaze", "hours_a_year": 40.0}]}
    point = found({**TWIN, "climate": climate}, [4.0])
    onset = min(row["wind_speed_m_per_s"] for row in point.tables["critical_wind_speeds"])
    expected = 40.0 * math.exp(-((onset / 6.0) ** 2))  # above 30 m/s nothing is known
    assert point.ranking_figures["galloping_hours_a_year"] == pytest.approx(expected, rel=1e-12)
    assert found(TWIN, [4.0]).ranking_figures["galloping_hours_a_year"] is None


def test_full_modes_whose_first_loops_are_not_asked_for_rank_an_unbounded_motion_first() -> None:
    line = copy.deepcopy(TWIN)
    line["ice"]["aerodynamics"]["vertical"][2] = -8.3581
    asked = {
        "models": ["finite_element"],
        "loops": [2],
        "finite_element_loops": [1, 2],
        "wind_speeds_m_per_s": [1.0, 4.0],
    }
    (point,) = (i for i in convert.run({"line": line, "analysis": asked}) if isinstance(i, PointResult))
    unknown = [row for row in point.tables["limit_cycles"] if row["vertical_m"] is None]
    assert [(row["loops"], row["wind_speed_m_per_s"], row["outcome"]) for row in unknown] == [
        (2, 4.0, "no_bounded_motion")
    ]
    assert point.ranking_figures["largest_vertical_m"] == math.inf
    assert "nothing in the equations bounds the motion" in point.tables["verdict"][0]["sentence"]


@pytest.mark.parametrize("lasting", [Stability.STABLE, Stability.UNKNOWN])
def test_what_is_not_known_to_be_stable_is_not_taken_for_safe(lasting: Stability) -> None:
    document = {"line": TWIN, "analysis": {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [4.0]}}
    line, analysis = specification_of_point(document, 0)
    result = finished(analyse(line, analysis))
    rows = [replace(row, stability=lasting) if row.kind == "periodic" else row for row in result.limit_cycles]
    (resting,) = (i for i, row in enumerate(rows) if row.kind == "equilibrium")
    (figures,) = ranking_figures.ranking_figures([line], [replace(result, limit_cycles=tuple(rows))])
    largest = max(row.vertical_m or 0.0 for row in rows)
    assert figures["largest_vertical_m"] == (largest if lasting is Stability.STABLE else math.inf)
    # A span that rests for sure may also move: what is known of its size counts.
    rows[resting] = replace(rows[resting], stability=Stability.STABLE)
    (figures,) = ranking_figures.ranking_figures([line], [replace(result, limit_cycles=tuple(rows))])
    assert figures["largest_vertical_m"] == largest
