"""Phases that spacers tie, held to what is known exactly of equal phases."""

from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.assemblies.assembly import Assembly, Joins, assembled, natural_motions
from engine.assemblies.phases import assembled_phases, tied_lines, tied_places
from engine.mechanics.finite_elements import FIELDS, THETA, U, V, W
from engine.models.discretization import discretize
from engine.spec import InterphaseSpacer, Line, Phase, PointDevice
from tests.builders import phases_line, source_line

ALL = (U, V, W, THETA)
MIDDLE = 62.94
MIDDLE_NODE = 10
RIGID = InterphaseSpacer(MIDDLE, 0.0, ("this", "top"))


def alone(line: Line, tied: tuple[float, float] | None = None) -> Assembly:
    """Return a span by itself, its middle held in one direction (y, z) if it is given."""
    matrices = discretize([line]).matrices
    rows = np.zeros((0 if tied is None else 1, matrices.mass.shape[-1]))
    if tied is not None:
        rows[0, FIELDS * MIDDLE_NODE + V], rows[0, FIELDS * MIDDLE_NODE + W] = tied
    none = np.zeros(0)
    return assembled(matrices, matrices.fixed, [Joins(rows, rows[:0], none, none)])


def frequencies(assembly: Assembly, count: int) -> FloatArray:
    return np.sqrt(natural_motions(assembly, ALL)[0][:count])


@pytest.mark.parametrize("place", [(7.0, 0.0), (0.0, -6.0), (3.0, 4.0)], ids=["above", "beside", "oblique"])
def test_equal_phases_move_alike_as_one_or_against_each_other_as_if_held(place: tuple[float, float]) -> None:
    line = source_line(2)
    whole = assembled_phases(phases_line(RIGID, above=Phase("top", *place)))
    axis = np.array(place) / np.hypot(*place)
    expected = np.sort(
        np.concatenate([frequencies(alone(line), 30), frequencies(alone(line, tuple(axis.tolist())), 29)])
    )
    assert frequencies(whole.assembly, 59)[:50] == pytest.approx(expected[:50], rel=1e-8)


def test_half_of_the_mass_moves_with_each_phase() -> None:
    line = source_line(2)
    whole = assembled_phases(phases_line(replace(RIGID, mass=40.0)))
    loaded = frequencies(alone(replace(line, devices=(PointDevice(MIDDLE, 20.0),))), 8)
    found = frequencies(whole.assembly, 40)
    assert [np.abs(found / one - 1.0).min() for one in loaded] == pytest.approx([0.0] * 8, abs=1e-8)
    assert loaded[0] < 0.98 * frequencies(alone(line), 1)[0]


def test_modes_with_nodes_at_the_spacers_keep_their_frequency_in_pairs() -> None:
    # rigid spacers in the middle hold V there: the two-loop vertical mode does not feel them
    untied = frequencies(assembled_phases(phases_line(replace(RIGID, axial_stiffness=1e-9))).assembly, 30)
    tied = frequencies(assembled_phases(phases_line(RIGID)).assembly, 30)
    two_loops = 2.0 * np.pi * 0.89145
    for found in (untied, tied):
        assert (np.abs(found / two_loops - 1.0) < 1e-4).sum() == 2
    one_loop = 2.0 * np.pi * 0.48152
    assert (np.abs(untied / one_loop - 1.0) < 1e-4).sum() == 2
    assert (np.abs(tied / one_loop - 1.0) < 1e-4).sum() == 1


def test_a_very_soft_spacer_leaves_the_phases_alone_and_a_stiff_one_is_rigid() -> None:
    own = frequencies(alone(source_line(2)), 15)
    soft = frequencies(assembled_phases(phases_line(replace(RIGID, axial_stiffness=1e-6))).assembly, 30)
    assert soft == pytest.approx(np.repeat(own, 2), rel=1e-8)
    stiff = frequencies(assembled_phases(phases_line(replace(RIGID, axial_stiffness=1e11))).assembly, 20)
    assert stiff == pytest.approx(frequencies(assembled_phases(phases_line(RIGID)).assembly, 20), rel=1e-6)


def test_three_phases_tied_in_a_row() -> None:
    spacers = RIGID, replace(RIGID, between=("top", "highest"))
    line = replace(source_line(2), phases=(Phase("top", 7.0, 0.0), Phase("highest", 14.0, 0.0)), devices=spacers)
    own, held = frequencies(alone(source_line(2)), 12), frequencies(alone(source_line(2), (1.0, 0.0)), 12)
    # all alike as one; the two motions against each other as if held
    expected = np.sort(np.concatenate([own, held, held]))
    assert frequencies(assembled_phases(line).assembly, 30) == pytest.approx(expected[:30], rel=1e-8)


def test_members_are_the_line_and_the_phases_that_spacers_name() -> None:
    line = replace(phases_line(RIGID), phases=(Phase("far", 20.0, 0.0), Phase("top", 7.0, 1.0)))
    assert tied_places(line) == {"this": (0.0, 0.0), "top": (7.0, 1.0)}
    assert tied_lines(line) == (replace(source_line(2), devices=(PointDevice(MIDDLE, 0.0),)),) * 2


def test_each_phase_has_its_own_ice_and_its_own_line() -> None:
    ice = replace(source_line(2).ice, eccentricity_y=-1e-3)
    slack = replace(source_line(2), span=replace(source_line(2).span, horizontal_tension=25_000.0))
    line = replace(phases_line(RIGID), phases=(Phase("top", 7.0, 0.0, ice=ice), Phase("low", -7.0, 0.0, line=slack)))
    line = replace(line, devices=(RIGID, replace(RIGID, between=("this", "low"))))
    this, top, low = tied_lines(line)
    assert (this.ice, top.ice, low.ice) == (source_line(2).ice, ice, source_line(2).ice)
    assert [own.span.horizontal_tension for own in (this, top, low)] == [30_000.0, 30_000.0, 25_000.0]
    assert [len(own.devices) for own in (this, top, low)] == [2, 1, 1]
