"""All cycles that can be reached: links over the wind, coexisting cycles, and stacks."""

import numpy as np
import pytest

from engine.arrays import ComplexArray, FloatArray
from engine.cycles.harmonic_balance import half_peak_to_peak, residual
from engine.cycles.search import Cycles, find_cycles
from engine.cycles.starts import energy_starts
from engine.models.critical_wind_speeds import Crossings, critical_wind_speeds
from engine.models.reduced_model import ReducedModel, take
from engine.outcome import Stability
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


def test_members_with_wind_speeds_of_their_own_have_the_cycles_that_each_has_alone() -> None:
    pair, winds = take(hybrid(source_line(2), 1), [0, 0]), np.array([[4.0], [6.0]])
    together = found_for(pair, winds)
    alone = [found_for(take(pair, [i]), own) for i, own in enumerate(winds)]
    assert together.member.tolist() == [0, 1]
    assert together.wind.tolist() == [0, 0]
    assert together.orbits.wind_speed.tolist() == [4.0, 6.0]
    for i, own in enumerate(alone):
        assert together.orbits.angular_frequency[i] == pytest.approx(own.orbits.angular_frequency[0], rel=1e-12)
        ends = [cycles.branch_sets[0].orbits.wind_speed for cycles in (together, own)]
        here = together.branch_sets[0].member == i
        assert ends[0][here] == pytest.approx(ends[1], rel=1e-12)


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


# The Stuart-Landau oscillator as an oscillator with inertia, Q = q_1 + i q_2:
# Q'' + c Q' + w_0^2 Q = U^2 (i eta Q + alpha Q'/U - gamma |Q|^2 Q'/U + kappa |Q|^2 Q).
# It does not change if Q turns, so that its cycle is Q = A exp(i w t) exactly, at any distance from the onset.
C, W_0, ETA, ALPHA, GAMMA, KAPPA = 0.02, 1.0, 0.01, 0.02, 0.05, 0.01


def stuart_landau() -> ReducedModel:
    """Return the Stuart-Landau oscillator as a reduced model."""
    terms: dict[tuple[int, tuple[int, ...]], float] = {(0, (1,)): -ETA, (1, (0,)): ETA}
    for i in (0, 1):
        terms |= {(i, (2 + i,)): ALPHA}
        for j in (0, 1):
            terms |= {(i, (j, j, 2 + i)): -GAMMA, (i, tuple(sorted((j, j, i)))): KAPPA}
    return hand_made(Oscillators(np.eye(2), C * np.eye(2), W_0**2 * np.eye(2), terms))


def turning_solution(speed: float) -> tuple[float, float]:
    """Return A and w: w^2 = w_0^2 - U^2 kappa A^2 and (c + U gamma A^2 - U alpha) w = U^2 eta."""
    # The first gives A^2, which makes the second a cubic in w; of its roots, w is the one that begins at w_0.
    slope = GAMMA / (speed * KAPPA)
    roots = np.roots([slope, 0.0, speed * ALPHA - C - slope * W_0**2, speed**2 * ETA])
    w = float(roots[np.abs(roots - W_0).argmin()].real)
    return float(np.sqrt((W_0**2 - w**2) / KAPPA) / speed), w


def turning_multipliers(speed: float, amplitude: float, w: float) -> ComplexArray:
    """Return the exact multipliers: with Q = (A + xi) exp(i w t) the variation xi has constant coefficients."""
    by_rate = C - speed * ALPHA + speed * GAMMA * amplitude**2 + 2j * w
    by_xi = (W_0**2 - w**2 - speed**2 * KAPPA * amplitude**2) + 1j * w * (by_rate - 2j * w) - 1j * speed**2 * ETA
    by_real = 2.0 * amplitude**2 * (1j * w * speed * GAMMA - speed**2 * KAPPA)
    turn = [[[z.real, -z.imag], [z.imag, z.real]] for z in (by_xi, by_rate)]
    stiffness = np.array(turn[0]) + np.array([[by_real.real, 0.0], [by_real.imag, 0.0]])
    matrix = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness, -np.array(turn[1])]])
    return np.exp(np.linalg.eigvals(matrix) * 2.0 * np.pi / w)


def test_stuart_landau_is_exact() -> None:
    model, winds = stuart_landau(), np.array([0.8, 1.0, 1.5, 2.0])
    crossings = critical_wind_speeds(model, 30.0)
    # eta U^2 / w_0 + alpha U = c; the other sense of turning is damped at any wind, since alpha^2 < 4 c eta / w_0.
    assert crossings.wind_speed == pytest.approx([(np.sqrt(ALPHA**2 + 4.0 * C * ETA) - ALPHA) / (2.0 * ETA)], rel=1e-9)
    assert crossings.angular_frequency == pytest.approx([W_0], rel=1e-9)
    cycles = found_for(model, winds, crossings)
    assert cycles.wind.tolist() == [0, 1, 2, 3]
    assert cycles.branch.tolist() == [0, 0, 0, 0]
    assert set(cycles.floquet.stability) == {Stability.STABLE}
    for i, speed in enumerate(winds.tolist()):
        amplitude, w = turning_solution(speed)
        assert cycles.orbits.angular_frequency[i] == pytest.approx(w, rel=1e-8)
        assert half_peak_to_peak(cycles.orbits.coefficients[i]) == pytest.approx([amplitude] * 2, rel=1e-6)
        exact = turning_multipliers(speed, amplitude, w)
        for value in cycles.floquet.multipliers[i]:
            assert np.abs(exact - value).min() < 1e-4
        for value in exact:
            assert np.abs(cycles.floquet.multipliers[i] - value).min() < 1e-4
