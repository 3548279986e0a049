"""Interphase spacers as ties and links between phases."""

import math
from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.assemblies.interphase_spacers import spacer_axis, spacer_joins
from engine.assemblies.phases import tied_lines, tied_places
from engine.mechanics.finite_elements import FIELDS
from engine.mechanics.static_profile import StaticProfile, static_profile
from engine.spec import InterphaseSpacer, Line, Phase
from tests.builders import phases_line

NODES = 21
RIGID = InterphaseSpacer(31.0, 20.0, ("this", "top"))
ELASTIC = replace(RIGID, axial_stiffness=3e3)


def profile_of(line: Line) -> StaticProfile:
    return static_profile(tied_lines(line))


def moved(*fields: tuple[float, float, float, float]) -> FloatArray:
    """Return the displacement in which every node of a member moves alike."""
    return np.concatenate([np.tile(field, NODES) for field in fields])


def test_a_rigid_spacer_ties_what_changes_its_length_and_an_elastic_one_resists_it() -> None:
    line = phases_line(RIGID, ELASTIC, above=Phase("top", 3.0, 4.0))
    joins = spacer_joins(line.interphase_spacers, tied_places(line), profile_of(line), FIELDS * NODES)
    assert joins.stiffness == pytest.approx([3e3])
    assert joins.mass == pytest.approx([0.0])
    for rows in (joins.ties, joins.links):
        assert rows.shape == (1, 2 * FIELDS * NODES)
        # the axis is (0.6, 0.8) in (Y, Z); neither U nor Theta stretches it, nor do equal motions
        assert rows @ moved((0, 0, 0, 0), (0, 1, 0, 0)) == pytest.approx(0.6)
        assert rows @ moved((0, 0, 0, 0), (0, 0, 1, 0)) == pytest.approx(0.8)
        assert rows @ moved((0, 0, 1, 0), (0, 0, 0, 0)) == pytest.approx(-0.8)
        assert rows @ moved((1, 0, 0, 5), (-1, 0, 0, 7)) == pytest.approx(0.0)
        assert rows @ moved((0, 1, 2, 0), (0, 1, 2, 0)) == pytest.approx(0.0, abs=1e-14)


def test_it_acts_where_it_is_mounted() -> None:
    line = phases_line(RIGID)
    profile = profile_of(line)
    ties = spacer_joins(line.interphase_spacers, tied_places(line), profile, FIELDS * NODES).ties
    # a quadratic of the arc length is exact within an element: c sinh((x - x_0)/c) + c sinh(x_0/c) at x = 31 m
    c, low = profile.catenary_parameter[0], profile.low_point[0]
    arc = c * (math.sinh((31.0 - low) / c) + math.sinh(low / c))
    field = np.zeros((NODES, FIELDS))
    field[:, 1] = np.linspace(0.0, profile.arc_length[0], NODES) ** 2
    assert ties @ np.concatenate([field.ravel() * 0.0, field.ravel()]) == pytest.approx(arc**2)


def test_the_axis_is_that_of_phases_as_they_hang() -> None:
    own = replace(phases_line().phases[0], y=0.0, z=6.0)
    slack = replace(phases_line(), phases=())
    slack = replace(slack, span=replace(slack.span, horizontal_tension=20_000.0))
    line = phases_line(replace(RIGID, position=62.94), above=replace(own, line=slack))
    profile = profile_of(line)
    lower = profile.sag[1] - profile.sag[0]
    axis = spacer_axis(line.interphase_spacers[0], tied_places(line), profile)
    assert axis == pytest.approx(np.array([-lower, 6.0]) / math.hypot(lower, 6.0))
