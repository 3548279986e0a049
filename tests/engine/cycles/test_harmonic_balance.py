"""Harmonic balance: analytic Jacobian, and equations that are met between the samples as well."""

from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.cycles.first_harmonic import energy_balance_cycles
from engine.cycles.harmonic_balance import (
    Orbits,
    balance,
    basis,
    fourier,
    half_peak_to_peak,
    jacobian,
    linearized,
    oscillation_size,
    residual,
    resized,
    states,
)
from engine.kernels import compiled
from engine.models.reduced_model import ReducedModel, resultant, take
from tests.builders import Oscillators, hand_made, hybrid, source_line
from tests.engine.motions import MODELS, random_orbits


@pytest.mark.parametrize("name", MODELS)
def test_jacobian_is_the_derivative_of_the_residual(name: str) -> None:
    model = take(MODELS[name](), np.zeros(2, dtype=np.intp))
    orbits = random_orbits(model, 3, 2)
    cycles, m, size = orbits.coefficients.shape
    found = jacobian(model, orbits)

    def shifted(column: int, step: float) -> FloatArray:
        coefficients, omega = orbits.coefficients.copy(), orbits.angular_frequency.copy()
        if column == m * size:
            omega += step
        else:
            coefficients.reshape(cycles, -1)[:, column] += step
        return residual(model, Orbits(coefficients, omega, orbits.wind_speed)).reshape(cycles, -1)

    for column in range(m * size + 1):
        # Exact for cubics but for rounding; so the step may be large. Splines change their cubic at every row.
        size_of_step = 1e-4 if "table" in name else 1e-2
        step = size_of_step * (orbits.angular_frequency[0] if column == m * size else np.abs(orbits.coefficients).max())
        first = shifted(column, step) - shifted(column, -step)
        second = shifted(column, 2.0 * step) - shifted(column, -2.0 * step)
        expected = (8.0 * first - second) / (12.0 * step)
        assert found[..., column] == pytest.approx(expected, rel=1e-6, abs=1e-9 * np.abs(found).max())


@pytest.mark.parametrize("name", MODELS)
def test_no_cycles_have_no_slopes(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    model, none = MODELS[name](), np.zeros(0, dtype=np.intp)
    orbits, shapes = Orbits(np.zeros((0, model.mass.shape[-1], 3)), np.zeros(0), np.zeros(0)), []
    for compiled_ones in (compiled.AVAILABLE, False):
        monkeypatch.setattr(compiled, "AVAILABLE", compiled_ones)
        shapes.append([found.shape for found in linearized(model, none, orbits)])
    n = 3 * model.mass.shape[-1]
    assert shapes == [[(0, n), (0, n, n + 2)]] * 2


@pytest.mark.parametrize("name", MODELS)
def test_slopes_by_the_wind_speed_are_derivatives(name: str) -> None:
    model = take(MODELS[name](), np.zeros(2, dtype=np.intp))
    orbits = random_orbits(model, 3, 2)
    step = 1e-3

    def shifted(by: float) -> FloatArray:
        return linearized(model, np.arange(2), replace(orbits, wind_speed=orbits.wind_speed + by))[0]

    first, second = (shifted(n * step) - shifted(-n * step) for n in (1.0, 2.0))
    expected = (8.0 * first - second) / (12.0 * step)
    found = linearized(model, np.arange(2), orbits)[1][..., -1]
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-8 * np.abs(expected).max())


def solved(model: ReducedModel, wind_speed: float, harmonics: int) -> Orbits:
    """Return the cycles that the energy balance leads to."""
    guess = energy_balance_cycles(model, np.array([wind_speed]))
    first = np.stack([guess.mean, guess.amplitude.real, -guess.amplitude.imag], axis=-1)
    start = Orbits(first, guess.angular_frequency, np.full(guess.member.size, wind_speed))
    orbits, solution = balance(model, np.zeros(guess.member.size, dtype=np.intp), resized(start, harmonics))
    assert solution.converged.any()
    good = np.flatnonzero(solution.converged)
    return Orbits(orbits.coefficients[good], orbits.angular_frequency[good], orbits.wind_speed[good])


# Those with tables are at rest at 5 m/s, and two stretched loops under the source's load are too far from the start.
MOVING = [name for name in MODELS if "table" not in name and name != "hybrid, stretching"]


@pytest.mark.parametrize("name", MOVING)
def test_equations_are_met_at_every_instant(name: str) -> None:
    model = MODELS[name]()
    orbits = solved(model, 5.0, 9)
    tau = np.linspace(0.0, 2.0 * np.pi, 101)
    values, slope = fourier(tau, 9), basis(9).derivative
    omega, q = orbits.angular_frequency[:, None, None], orbits.coefficients
    here = take(model, np.zeros(len(q), dtype=np.intp))
    velocity, acceleration = omega * (q @ slope.T), omega**2 * (q @ (slope @ slope).T)
    linear = here.mass @ acceleration + here.damping @ velocity + here.stiffness @ q
    state = np.concatenate([q @ values.T, velocity @ values.T / 5.0], axis=1).swapaxes(-1, -2)
    assert states(orbits, tau) == pytest.approx(state, abs=1e-14)
    load = 25.0 * resultant(here, state, orbits.wind_speed).swapaxes(-1, -2)
    rest = linear @ values.T - load
    # What is left is the load's harmonics beyond the ninth, far below a ten-thousandth of the elastic force.
    assert np.abs(rest).max() < 1e-4 * np.abs(here.stiffness @ q @ values.T).max()


def test_more_harmonics_do_not_change_a_resolved_orbit() -> None:
    model = hybrid(source_line(2), 1)
    coarse, fine = (solved(model, 5.0, h) for h in (5, 9))
    amplitudes = [half_peak_to_peak(o.coefficients) for o in (coarse, fine)]
    assert amplitudes[0][0] == pytest.approx(amplitudes[1][0], rel=1e-5)
    assert coarse.angular_frequency[0] == pytest.approx(fine.angular_frequency[0], rel=1e-9)


def test_derivative_of_the_basis() -> None:
    tau = np.linspace(0.0, 6.0, 13)
    rng = np.random.default_rng(0)
    a = rng.normal(size=7)
    k = np.arange(1, 4)
    waves = np.outer(tau, k)
    expected = (-np.sin(waves) * k) @ a[1::2] + (np.cos(waves) * k) @ a[2::2]
    assert fourier(tau, 3) @ (basis(3).derivative @ a) == pytest.approx(expected, rel=1e-12, abs=1e-12)
    assert fourier(tau, 3) @ a == pytest.approx(a[0] + np.cos(waves) @ a[1::2] + np.sin(waves) @ a[2::2], rel=1e-12)


def test_projection_of_a_cubic_has_no_aliasing() -> None:
    discretization = basis(3)
    rng = np.random.default_rng(1)
    a = rng.normal(size=7)
    cube = (discretization.values @ a) ** 3
    fine = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
    exact = (fourier(fine, 3).T @ (fourier(fine, 3) @ a) ** 3) * np.array([1.0] + [2.0] * 6) / 400.0
    assert discretization.projection @ cube == pytest.approx(exact, rel=1e-12, abs=1e-12)


def test_half_peak_to_peak_of_sums_of_waves() -> None:
    series = np.array([[5.0, 3.0, 4.0, 0.0, 0.0], [0.0, 0.0, 2.0, 1.0, 0.0], [1.0, 0.0, 0.0, 0.0, 0.0]])
    fine = fourier(np.linspace(0.0, 2.0 * np.pi, 100_001), 2) @ series.T
    assert half_peak_to_peak(series) == pytest.approx(0.5 * np.ptp(fine, axis=0), rel=1e-4, abs=1e-12)
    assert half_peak_to_peak(series)[0] == pytest.approx(5.0, rel=1e-5)
    padded = np.pad(series, ((0, 0), (0, 24 - 2 * (series.shape[-1] // 2))))
    assert half_peak_to_peak(padded) == pytest.approx(half_peak_to_peak(series), rel=1e-14)


def test_resizing_keeps_the_lower_harmonics() -> None:
    orbits = Orbits(np.arange(10.0).reshape(1, 2, 5), np.ones(1), np.ones(1))
    assert resized(orbits, 1).coefficients.tolist() == [[[0.0, 1.0, 2.0], [5.0, 6.0, 7.0]]]
    assert resized(orbits, 3).coefficients[0, 1].tolist() == [5.0, 6.0, 7.0, 8.0, 9.0, 0.0, 0.0]


def test_oscillation_size_leaves_out_the_mean() -> None:
    model = hybrid(source_line(2), 1)
    coefficients = np.zeros((1, 3, 5))
    coefficients[0, :, 0] = 7.0
    coefficients[0, 1, 1:3] = (3.0, 4.0)
    found = oscillation_size(model, np.zeros(1, dtype=np.intp), Orbits(coefficients, np.ones(1), np.ones(1)))
    assert found == pytest.approx([5.0 * np.sqrt(model.mass[0, 1, 1])], rel=1e-14)


def test_start_that_is_not_a_number_does_not_converge_and_spoils_no_other() -> None:
    model = hybrid(source_line(2), 1)
    good = resized(solved(model, 5.0, 5), 5)
    both = Orbits(
        np.stack([np.full_like(good.coefficients[0], np.nan), good.coefficients[0]]),
        np.array([1.0, good.angular_frequency[0]]),
        np.array([5.0, 5.0]),
    )
    _, solution = balance(model, np.zeros(2, dtype=np.intp), both)
    assert solution.converged.tolist() == [False, True]


def test_balance_of_a_single_co_ordinate() -> None:
    # q'' + q = mu (1 - q^2 - q'^2) q' has q = cos t.
    one = np.ones((1, 1))
    model = hand_made(Oscillators(one, 0.0 * one, one, {(0, (1,)): 0.1, (0, (0, 0, 1)): -0.1, (0, (1, 1, 1)): -0.1}))
    start = Orbits(np.array([[[0.0, 0.9, 0.0]]]), np.array([1.05]), np.array([1.0]))
    orbits, solution = balance(model, np.zeros(1, dtype=np.intp), start)
    assert solution.converged.all()
    assert np.hypot(*orbits.coefficients[0, 0, 1:]) == pytest.approx(1.0, rel=1e-10)
