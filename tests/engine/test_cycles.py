"""All cycles that can be reached: links over the wind, coexisting cycles, and stacks."""

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.cycles import Cycles, energy_starts, find_cycles
from engine.harmonic import half_peak_to_peak, residual
from engine.hybrid import ReducedModel, take
from engine.outcome import Stability
from engine.stability import Crossings, critical_wind_speeds
from tests.builders import Oscillators, hand_made, hybrid, source_line

WINDS = np.array([4.0, 5.0, 6.0])


def found_for(model: ReducedModel, winds: FloatArray, crossings: Crossings | None = None) -> Cycles:
    """Find the cycles without the explicit formula."""
    crossings = crossings or critical_wind_speeds(model, 30.0)
    return find_cycles(model, crossings, winds, energy_starts(model, winds, 5), 5)


def test_every_cycle_solves_its_equations() -> None:
    model = hybrid(source_line(3), 2)
    cycles = found_for(model, WINDS)
    rest = residual(take(model, cycles.member), cycles.orbits)
    elastic = np.abs(model.stiffness[cycles.member] @ cycles.orbits.coefficients).max(axis=(1, 2))
    assert (np.abs(rest).max(axis=(1, 2)) < 1e-6 * elastic).all()
    assert cycles.orbits.wind_speed == pytest.approx(WINDS[cycles.wind])


def test_branch_is_one_family_over_the_wind() -> None:
    cycles = found_for(hybrid(source_line(2), 1), WINDS)
    assert cycles.wind.tolist() == [0, 1, 2]
    assert cycles.branch.tolist() == [0, 0, 0]
    assert cycles.dropped.tolist() == [0]
    assert (np.diff(half_peak_to_peak(cycles.orbits.coefficients)[:, 0]) > 0.0).all()


def test_members_without_galloping_have_no_cycles() -> None:
    cycles = found_for(hybrid(source_line(2), 1), np.array([1.0, 2.0]))
    assert cycles.member.size == 0
    assert cycles.dropped.tolist() == [0]


def test_two_oscillators_each_have_their_cycle_and_the_right_stability() -> None:
    # Two circular oscillators that do not touch: q'' + w^2 q = mu (1 - q^2 - q'^2/w^2) q' has q = cos(w t). Each cycle
    # with the other at rest is unstable, since rest is unstable; the incommensurate pair of both is no periodic motion.
    mu, speed, rates = 0.02, 4.0, (2.0, 3.1)
    terms: dict[tuple[int, tuple[int, ...]], float] = {}
    for i, w in enumerate(rates):
        terms |= {(i, (2 + i,)): mu / speed, (i, (i, i, 2 + i)): -mu / speed}
        terms[(i, (2 + i, 2 + i, 2 + i))] = -mu * speed / w**2
    model = hand_made(Oscillators(np.eye(2), np.zeros((2, 2)), np.diag(np.square(rates)), terms))
    # Without damping rest is unstable from no wind on: there is no crossing from which a branch could be followed.
    none = np.zeros(0, dtype=np.intp)
    empty, no = np.zeros(0), np.zeros(0, dtype=np.bool_)
    cycles = found_for(model, np.array([speed]), Crossings(none, empty, empty, no, no, none, none))
    assert np.sort(cycles.orbits.angular_frequency) == pytest.approx(rates, rel=1e-9)
    assert cycles.floquet.stability.tolist() == [Stability.UNSTABLE, Stability.UNSTABLE]
    amplitudes = half_peak_to_peak(cycles.orbits.coefficients)
    assert np.sort(amplitudes.ravel()) == pytest.approx([0.0, 0.0, 1.0, 1.0], abs=1e-5)


def test_stack_of_members_holds_the_cycles_of_each() -> None:
    lines = (source_line(2), source_line(3))
    models = [hybrid(line, 1) for line in lines]
    twice = found_for(take(models[0], np.zeros(2, dtype=np.intp)), WINDS)
    alone = found_for(models[0], WINDS)
    assert twice.member.tolist() == [0] * alone.member.size + [1] * alone.member.size
    assert twice.orbits.coefficients[3:] == pytest.approx(twice.orbits.coefficients[:3], abs=1e-12)
    assert not np.allclose(found_for(models[1], WINDS).orbits.coefficients, alone.orbits.coefficients, atol=1e-5)
