"""Branches point by point: they begin at rest in a Hopf point and pass through the cycles at the winds asked for."""

from functools import cache
from itertools import groupby

import numpy as np
import pytest

from engine.outcome import Stability
from engine.result import Result
from engine.spec import AmplitudeCurves, Analysis, Model
from tests.builders import only, run, source_line

WINDS = (4.0, 6.0)


@cache
def result() -> Result:
    return run(source_line(2), Analysis(loops=(1,), wind_speeds=WINDS, amplitude_curves=AmplitudeCurves.REPORTED))


def test_a_curve_begins_at_rest_at_an_onset() -> None:
    onsets = [(row.model, row.loops, row.wind_speed_m_per_s) for row in result().critical_wind_speeds]
    starts = [row for row in result().amplitude_curves if row.point == 0 and row.vertical_m == 0.0]
    assert {row.model for row in starts} == {Model.HYBRID, Model.FINITE_ELEMENT}
    for row in starts:
        assert (row.horizontal_m, row.torsional_rad) == (0.0, 0.0)
        assert (row.model, row.loops, row.wind_speed_m_per_s) in onsets


def test_a_curve_passes_through_the_cycles_at_the_winds_asked_for() -> None:
    cycles = [row for row in result().limit_cycles if row.kind == "periodic"]
    assert len(cycles) >= 4
    for cycle in cycles:
        curve = [
            row
            for row in result().amplitude_curves
            if (row.model, row.loops, row.branch, row.curve) == (cycle.model, cycle.loops, cycle.branch, 0)
        ]
        winds, amplitudes = np.array([(row.wind_speed_m_per_s, row.vertical_m) for row in curve]).T
        assert (np.diff(winds) > 0.0).all(), "these branches have no fold"
        assert np.interp(cycle.wind_speed_m_per_s, winds, amplitudes) == pytest.approx(cycle.vertical_m, rel=0.03)
        places = {round(row.observed_at_m, 6) for row in curve}
        assert round(cycle.observed_at_m, 6) in places
        # Three loops may be largest at another antinode at other winds.
        assert len(places) == 1 or cycle.loops == 3


def test_points_are_numbered_along_each_curve() -> None:
    rows = result().amplitude_curves
    for _, curve in groupby(rows, key=lambda row: (row.model, row.loops, row.branch, row.curve)):
        points = [row.point for row in curve]
        assert points == list(range(len(points)))
    assert Stability.STABLE in {row.stability for row in rows}


def test_nothing_is_reported_unless_it_is_asked_for() -> None:
    assert run(source_line(2), only(Model.HYBRID, wind_speeds=(4.0,))).amplitude_curves == ()
