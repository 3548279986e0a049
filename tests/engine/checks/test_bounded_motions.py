"""Motions that stay bounded are told from those that diverge, against equations whose end is known."""

import numpy as np
import pytest

from engine.checks.bounded_motions import bounded_motions
from engine.cycles.harmonic_balance import half_peak_to_peak
from engine.models.reduced_model import ReducedModel, take
from tests.builders import Oscillators, hand_made

GROWTH = 0.02
WINDS = np.array([1.0, 2.0])


def van_der_pol(sign: float) -> ReducedModel:
    terms: dict[tuple[int, tuple[int, ...]], float] = {(0, (2,)): GROWTH, (0, (0, 0, 2)): sign * GROWTH}
    return hand_made(Oscillators(np.eye(2), np.diag([0.0, 0.1]), np.diag([1.0, 2.0]), terms))


def test_of_two_wind_speeds_one_has_a_cycle_and_one_has_none() -> None:
    # q'' + q = mu U (1 -+ q^2) q': van der Pol's cycle of amplitude 2, or growth without end. A second oscillator
    # beside it is damped and comes to rest.
    bounded, unbounded = (van_der_pol(sign) for sign in (-1.0, 1.0))
    place = np.zeros(1, dtype=np.intp)
    settled = bounded_motions(bounded, WINDS, 5, place, place)
    assert settled.unbounded.shape == (0, 2)
    assert set(settled.starts.member.tolist()) == {0}
    assert set(settled.starts.wind.tolist()) == {0}
    assert half_peak_to_peak(settled.starts.orbits.coefficients)[:, 0] == pytest.approx(2.0, rel=1e-3)
    diverged = bounded_motions(unbounded, WINDS, 5, place, place + 1)
    assert diverged.unbounded.tolist() == [[0, 1]]
    assert diverged.starts.member.size == 0


def test_a_place_has_the_same_starts_alone_and_among_others() -> None:
    bounded, place = van_der_pol(-1.0), np.zeros(1, dtype=np.intp)
    alone = bounded_motions(bounded, WINDS, 5, place, place)
    three = np.zeros(3, dtype=np.intp)
    stack = take(bounded, three)
    among = bounded_motions(stack, WINDS, 5, np.array([0, 1, 2]), np.array([1, 1, 0]))
    last = among.starts.member == 2
    assert among.starts.orbits.coefficients[last].tolist() == alone.starts.orbits.coefficients.tolist()
