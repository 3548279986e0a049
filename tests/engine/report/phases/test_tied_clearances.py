"""Distances of phases that move together."""

import numpy as np
import pytest

from engine.assemblies.phases import assembled_phases
from engine.report.phases.tied_clearances import HungPhase, hung_phases, smallest_distance
from engine.spec import Analysis, InterphaseSpacer, Phase
from tests.builders import phases_line, run

TAU = 2.0 * np.pi * np.arange(240) / 240


def hung(name: str, place: tuple[float, float], motion: tuple[float, float, float]) -> HungPhase:
    """Return a twin at two places along the span, which moves by V, W and Theta at the second one."""
    shapes = np.zeros((1, 3, 2))
    shapes[0, :, 1] = motion
    return HungPhase(name, np.array([place, place]), shapes, np.array([[0.0, 0.2], [0.0, -0.2]]))


def test_phases_against_each_other_come_nearer_and_phases_alike_do_not() -> None:
    q = np.cos(TAU)[:, None]
    still = hung("this", (0.0, 0.0), (0.5, 0.0, 0.0))
    against, alike = (hung("top", (7.0, 0.0), (v, 0.0, 0.0)) for v in (-0.5, 0.5))
    assert smallest_distance(still, against, q) == pytest.approx((6.0, 1))
    assert smallest_distance(still, alike, q) == pytest.approx((7.0, 0))


def test_sub_conductors_count_and_they_turn() -> None:
    # beside each other: 5 m less 0.2 m of both bundles; turned by 90 degrees to first order, theirs go up and down
    beside = hung("top", (0.0, 5.0), (0.0, 0.0, 0.0))
    assert smallest_distance(hung("this", (0.0, 0.0), (0.0, 0.0, 0.0)), beside, np.ones((1, 1)))[0] == pytest.approx(
        4.6
    )
    above = hung("top", (7.0, 0.0), (0.0, 0.0, 0.5))
    # V of a sub-conductor is -z Theta: 0.1 m down at z = 0.2, where the other twin hangs straight below
    assert smallest_distance(hung("this", (0.0, 0.0), (0.0, 0.0, 0.0)), above, np.ones((1, 1)))[0] == pytest.approx(6.9)


def test_phases_hang_where_they_are_attached_with_their_sag() -> None:
    whole = assembled_phases(phases_line(InterphaseSpacer(62.94, 0.0, ("this", "top")), above=Phase("top", 5.0, 4.0)))
    wave = np.sin(np.pi * np.linspace(0.0, 1.0, 21))
    shapes = np.zeros((1, 3, 42))
    shapes[0, 0, 21:] = wave
    low, top = hung_phases(whole, shapes, np.array([0.0, 62.94, 125.88]))
    sag = whole.members.profile.sag[0]
    assert low.rest == pytest.approx(np.array([[0.0, 0.0], [-sag, 0.0], [0.0, 0.0]]), abs=1e-9)
    assert top.rest == pytest.approx(np.array([[5.0, 4.0], [5.0 - sag, 4.0], [5.0, 4.0]]), abs=1e-9)
    assert low.shapes == pytest.approx(np.zeros((1, 3, 3)))
    assert top.shapes[0, 0] == pytest.approx([0.0, 1.0, 0.0], abs=1e-12)


def test_the_table_has_every_motion_and_pair() -> None:
    line = phases_line(InterphaseSpacer(62.94, 0.0, ("this", "top")), above=Phase("top", 7.0, 0.0, 6.9))
    result = run(line, Analysis(loops=(1,), finite_element_loops=(1,), wind_speeds=(6.0,)))
    alike, against = (row for row in result.clearances if row.method == "computed")
    assert (alike.phase, alike.other_phase, alike.together, alike.loops) == ("this", "top", "in time", 1)
    assert alike.distance_m == pytest.approx(7.0, abs=1e-6)
    cycle = next(r for r in result.limit_cycles if r.branch == against.branch)
    assert against.loops == cycle.loops == 2
    # vertical modes against each other: twice the amplitude, less a little for what the bundles turn
    assert against.distance_m == pytest.approx(7.0 - 2.0 * (cycle.vertical_m or 0.0), abs=2e-3)
    assert (against.required_m, against.ok) == (6.9, False)
    assert against.margin_m == pytest.approx((against.distance_m or 0.0) - 6.9)
    assert result.verdict[0].clearance_m == against.distance_m
    assert result.verdict[0].clearance_ok is False
    assert "of the next phase, nearer than required" in result.verdict[0].sentence
