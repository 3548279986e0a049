"""Cycles that a few harmonics do not resolve are solved again with more, and only those."""

from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest

from engine.cycles.branches import follow_from_cycles
from engine.cycles.floquet import floquet
from engine.cycles.harmonic_balance import Orbits, balance, half_peak_to_peak, resized, select
from engine.cycles.resolution import (
    LARGEST_TAIL,
    MOST_HARMONICS,
    harmonics_needed,
    resolved_stability,
    unresolved_members,
)
from engine.models.reduced_model import ReducedModel
from engine.outcome import Stability
from tests.builders import Oscillators, hand_made, hybrid, source_line

SPEED = np.array([1.0])
ONE = np.zeros(1, dtype=np.intp)


def van_der_pol(mu: float) -> ReducedModel:
    terms: dict[tuple[int, tuple[int, ...]], float] = {(0, (1,)): mu, (0, (0, 0, 1)): -mu}
    return hand_made(Oscillators(np.eye(1), np.zeros((1, 1)), np.eye(1), terms))


def cycle(model: ReducedModel, harmonics: int) -> Orbits:
    start = Orbits(np.array([[[0.0, 2.0, 0.0]]]), np.ones(1), SPEED)
    orbits, solution = balance(model, ONE, resized(start, harmonics))
    assert solution.converged.all()
    return orbits


def test_a_smooth_cycle_keeps_its_harmonics_and_a_sharp_one_gets_more() -> None:
    smooth, sharp = (van_der_pol(mu) for mu in (0.01, 0.5))
    orbits, judged, resolved, harmonics = resolved_stability(smooth, ONE, cycle(smooth, 5))
    assert (harmonics.tolist(), resolved.tolist(), judged.stability.tolist()) == ([5], [True], [Stability.STABLE])
    assert orbits.coefficients.shape[-1] == 11
    orbits, judged, resolved, harmonics = resolved_stability(sharp, ONE, cycle(sharp, 3))
    assert (harmonics.tolist(), resolved.tolist()) == ([MOST_HARMONICS], [True])
    exact = cycle(sharp, 30)
    assert np.abs(half_peak_to_peak(orbits.coefficients) / half_peak_to_peak(exact.coefficients) - 1.0).max() < 1e-5
    finest = floquet(sharp, ONE, exact, 8)
    assert np.abs(judged.multipliers - finest.multipliers).max() < LARGEST_TAIL


def test_a_cycle_that_more_harmonics_do_not_resolve_either_is_said_to_be_unresolved() -> None:
    model = van_der_pol(6.0)
    start = select(cycle(van_der_pol(2.0), 8), ONE)
    for mu in (3.0, 4.0, 5.0, 6.0):
        start, _ = balance(van_der_pol(mu), ONE, start)
    _, _, resolved, _ = resolved_stability(model, ONE, start)
    assert resolved.tolist() == [False]


def test_harmonics_follow_the_resonance_of_a_lightly_damped_mode_and_nothing_else() -> None:
    winds = np.array([4.0, 12.0])
    strongly, lightly, bundle = (
        hybrid(line, 2)
        for line in (source_line(1), source_line(1, torsional_ratio=0.01), source_line(2, torsional_ratio=0.01))
    )
    # Torsion meets five times the lowest frequency, 0.892 Hz, and is damped by 10 % or 0.3 % of it at two loops.
    assert np.sqrt(lightly.uncoupled_squares / lightly.uncoupled_squares.min()).max() == pytest.approx(4.41, abs=0.01)
    assert [harmonics_needed(model, winds, 5).tolist() for model in (strongly, lightly, bundle)] == [[5], [7], [5]]
    assert harmonics_needed(lightly, winds, 9).tolist() == [9]


def test_branches_whose_last_harmonics_do_not_fall_off_are_told_from_smooth_ones() -> None:
    smooth, sharp = (van_der_pol(mu) for mu in (0.01, 2.0))
    coarse = []
    for model in (smooth, sharp):
        start = cycle(van_der_pol(0.5), 3) if model is sharp else cycle(model, 3)
        for mu in (1.0, 1.5, 2.0) if model is sharp else ():
            start, _ = balance(van_der_pol(mu), ONE, start)
        branch_set = follow_from_cycles(model, ONE, start, np.array([1.0, 1.1]))
        coarse.append(unresolved_members(model, [branch_set]).tolist())
    assert coarse == [[False], [True]]


@pytest.mark.parametrize(("size", "coarse"), [(1e-200, False), (np.inf, True)])
def test_points_whose_size_is_no_number_are_judged_without_a_warning(size: float, coarse: bool) -> None:
    """Squares of 1e-200 vanish: such a point does not move; one beyond all numbers is not resolved."""
    model = van_der_pol(0.01)
    followed = follow_from_cycles(model, ONE, cycle(model, 3), np.array([1.0, 1.1]))
    count = followed.points.branch.size
    sizes = np.full(followed.orbits.coefficients.shape, size)
    orbits = Orbits(sizes, followed.orbits.angular_frequency, followed.orbits.wind_speed)
    uneven = replace(followed.floquet, trivial_error=np.full(count, 1.0))
    with patch.object(type(followed), "orbits", orbits):
        found = unresolved_members(model, [replace(followed, floquet=uneven)])
    assert found.tolist() == [coarse]
