"""Branches between two Hopf points of which the second lies beyond the wind speeds asked for."""

from dataclasses import fields
from functools import cache

import numpy as np
import pytest

from engine.arrays import BoolArray, FloatArray
from engine.cycles.bifurcations import bifurcations
from engine.cycles.branches import wind_limits
from engine.cycles.harmonic_balance import half_peak_to_peak
from engine.cycles.hopf_branches import branches_in_groups
from engine.cycles.search import Cycles, find_cycles
from engine.cycles.starts import energy_starts
from engine.models.critical_wind_speeds import Crossings, critical_wind_speeds
from engine.models.reduced_model import ReducedModel, take
from tests.builders import hybrid, source_line

NARROW, WIDE = np.array([4.0, 6.0]), np.array([4.0, 6.0, 12.0])
FIVE = np.array([5])


@cache
def single() -> tuple[ReducedModel, Crossings]:
    """Return a model whose only branch joins the Hopf points at 2.400 and 10.286 m/s."""
    model = take(hybrid(source_line(1), 1), [0])
    return model, critical_wind_speeds(model, 30.0)


def some_of(crossings: Crossings, index: BoolArray) -> Crossings:
    return Crossings(*(getattr(crossings, field.name)[index] for field in fields(Crossings)))


def cycles_at(winds: FloatArray, crossings: Crossings) -> Cycles:
    model, _ = single()
    return find_cycles(model, crossings, winds, energy_starts(model, winds, 5), 5)


def test_a_branch_from_beyond_ends_where_it_meets_one_that_left_the_range() -> None:
    model, crossings = single()
    assert crossings.wind_speed == pytest.approx([2.400, 10.286], abs=2e-3)
    (first, second), joints = branches_in_groups(model, crossings, NARROW, FIVE)
    assert joints == [(0, 1)]
    highest = wind_limits(first.problem, NARROW)[1][0]
    assert first.orbits.wind_speed[-1] > highest
    assert second.orbits.wind_speed[0] == crossings.wind_speed[1]
    assert (second.orbits.wind_speed[:-1] > highest).all()
    assert second.orbits.wind_speed[-1] < highest


def test_both_hopf_points_belong_to_one_family_whatever_wind_speeds_are_asked_for() -> None:
    model, crossings = single()
    narrow, wide = (cycles_at(winds, crossings) for winds in (NARROW, WIDE))
    assert half_peak_to_peak(narrow.orbits.coefficients) == pytest.approx(
        half_peak_to_peak(wide.orbits.coefficients), rel=1e-7
    )
    for cycles in (narrow, wide):
        found = bifurcations(cycles.branch_sets, cycles.followed, model, crossings)
        assert found.parameter == pytest.approx(crossings.wind_speed)
        assert {*found.branch.tolist(), *cycles.branch.tolist()} == {0}


def test_a_branch_from_beyond_that_meets_none_is_followed_through_the_range() -> None:
    model, crossings = single()
    alone = some_of(crossings, crossings.wind_speed > NARROW[-1])
    branch_sets, joints = branches_in_groups(model, alone, NARROW, FIVE)
    assert joints == []
    assert branch_sets[1].ended_at_equilibrium.all()
    assert crossings.wind_speed[0] < branch_sets[1].orbits.wind_speed.min() < NARROW[0]
    cycles = cycles_at(NARROW, alone)
    assert cycles.wind.tolist() == [0, 1]
    assert set(cycles.found_by) == {"hopf_branch"}
