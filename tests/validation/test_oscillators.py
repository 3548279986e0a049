"""Oscillators with known limit cycles, theory section 11, through harmonic balance, Floquet and the critical speeds."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine.arrays import FloatArray
from engine.checks.time_integration import integrate
from engine.cycles.floquet import Floquet, floquet
from engine.cycles.harmonic_balance import Orbits, balance, fourier, half_peak_to_peak
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel, take
from engine.outcome import Stability
from tests.builders import Oscillators, hand_made


def oscillator(terms: dict[tuple[int, tuple[int, ...]], float], copies: int = 1, **values: float) -> ReducedModel:
    """Return m q'' + c q' + k q = U^2 f(q, q'/U) beside a damped oscillator that nothing drives.

    The terms name q as 0 and q'/U as 2.
    """
    mass, damping, stiffness = (
        np.diag([values.get(name, default), idle])
        for name, default, idle in (("mass", 1.0, 1.0), ("damping", 0.0, 0.3), ("stiffness", 1.0, 2.3))
    )
    return hand_made(Oscillators(mass, damping, stiffness, terms), copies)


def exponent(judged: Floquet, orbit: Orbits) -> float:
    """Return the Floquet exponent of the one multiplier that is real and not the trivial one."""
    values = judged.multipliers[0, 1:]
    (real,) = values[np.abs(values.imag) < 1e-9].real
    return float(np.log(real) * orbit.angular_frequency[0] / (2.0 * np.pi))


def start(amplitude: float, frequency: float, wind_speed: float, harmonics: int) -> Orbits:
    """Return q = amplitude cos(w t) as a stack of one orbit."""
    coefficients = np.zeros((1, 2, 2 * harmonics + 1))
    coefficients[0, 0, 1] = amplitude
    return Orbits(coefficients, np.array([frequency]), np.array([wind_speed]))


def solved(model: ReducedModel, guess: Orbits) -> Orbits:
    """Balance one start and insist that it converged."""
    orbits, solution = balance(model, np.zeros(1, dtype=np.intp), guess)
    assert solution.converged.all()
    return orbits


def van_der_pol(mu: float, wind_speed: float) -> ReducedModel:
    """Return q'' + q = mu (1 - q^2) q'; the load is counted per U^2 in q and q'/U."""
    return oscillator({(0, (2,)): mu / wind_speed, (0, (0, 0, 2)): -mu / wind_speed})


@pytest.mark.parametrize(("mu", "wind_speed"), [(0.01, 1.0), (0.05, 1.0), (0.05, 7.0), (0.1, 0.3)])
def test_section_11_van_der_pol_at_small_mu(mu: float, wind_speed: float) -> None:
    model = van_der_pol(mu, wind_speed)
    orbit = solved(model, start(1.7, 1.1, wind_speed, 11))
    # Lindstedt: w = 1 - mu^2/16 + 17 mu^4/3072, amplitude 2 + mu^2/96 - 1033 mu^4/552960, both + O(mu^6).
    assert orbit.angular_frequency[0] == pytest.approx(1.0 - mu**2 / 16.0 + 17.0 * mu**4 / 3072.0, rel=mu**6 + 1e-12)
    wave = fourier(np.linspace(0.0, 2.0 * np.pi, 20_000), 11) @ orbit.coefficients[0, 0]
    amplitude = 2.0 + mu**2 / 96.0 - 1033.0 * mu**4 / 552960.0
    assert wave.max() == pytest.approx(amplitude, abs=1e-4 * mu**6 + 3e-8)  # the samples miss the peak by 2.5e-8
    assert half_peak_to_peak(orbit.coefficients[0, 0]) == pytest.approx(wave.max(), rel=1e-5)
    judged = floquet(model, np.array([0]), orbit)
    # -mu + O(mu^3) by Liouville's formula; Magnus' method adds less than a thousandth.
    assert exponent(judged, orbit) == pytest.approx(-mu, rel=mu**2 + 1e-3)
    assert judged.stability[0] is Stability.STABLE


def test_section_11_van_der_pol_at_mu_1_against_direct_integration() -> None:
    orbit = solved(van_der_pol(1.0, 1.0), start(2.0, 0.95, 1.0, 20))

    def rate(_: float, y: FloatArray) -> list[float]:
        return [y[1], (1.0 - y[0] ** 2) * y[1] - y[0]]

    def rising(_: float, y: FloatArray) -> float:
        return float(y[0])

    rising.direction = 1.0  # type: ignore[attr-defined]
    run = solve_ivp(rate, (0.0, 60.0), [2.0, 0.0], events=rising, rtol=1e-11, atol=1e-12, method="DOP853")
    assert run.t_events is not None
    period = float(np.diff(run.t_events[0])[-1])
    # 20 harmonics of this motion fall below 1e-9.
    assert 2.0 * np.pi / orbit.angular_frequency[0] == pytest.approx(period, rel=1e-8)


def circular(mu: float, wind_speed: float, copies: int = 1) -> ReducedModel:
    """Return q'' + q = mu (1 - q^2 - q'^2) q', whose cycle is q = cos t exactly, with the exponent -mu, for any mu."""
    terms = {(0, (2,)): mu / wind_speed, (0, (0, 0, 2)): -mu / wind_speed, (0, (2, 2, 2)): -mu * wind_speed}
    return oscillator(terms, copies)


@pytest.mark.parametrize("mu", [0.1, 0.8, -0.3])
@pytest.mark.parametrize("wind_speed", [1.0, 6.0])
def test_section_11_circular_cycle_is_exact(mu: float, wind_speed: float) -> None:
    model = circular(mu, wind_speed)
    orbit = solved(model, start(0.9, 1.05, wind_speed, 3))
    assert orbit.angular_frequency[0] == pytest.approx(1.0, rel=1e-12)
    assert np.hypot(*orbit.coefficients[0, 0, 1:3]) == pytest.approx(1.0, rel=1e-12)
    assert np.abs(orbit.coefficients[0, 0, [0, 3, 4, 5, 6]]).max() < 1e-12
    judged = floquet(model, np.array([0]), orbit)
    # Magnus' method of fourth order with 24 steps or more: its error goes with the fourth power of the step.
    assert exponent(judged, orbit) == pytest.approx(-mu, rel=1e-3)
    assert judged.trivial_error[0] < 3e-3 * abs(mu)
    assert judged.stability[0] is (Stability.STABLE if mu > 0.0 else Stability.UNSTABLE)


def test_section_11_circular_cycle_is_reached_by_direct_integration() -> None:
    settled = integrate(take(circular(0.1, 6.0), 0), 6.0, np.array([0.1, 0.0, 0.0, 0.0]), change=1e-6)
    # 64 samples a cycle miss the peak by at most 1 - cos(pi/64) = 1.2e-3; the energy at the end is exact.
    assert settled.amplitude[0] == pytest.approx(1.0, rel=1.3e-3)
    assert np.hypot(*settled.state[[0, 2]]) == pytest.approx(1.0, rel=1e-6)


MASS, FREQUENCY, RATIO, DENSITY, DIAMETER, A1, A3 = 3.0, 4.0, 0.01, 1.2929, 0.4, 2.7, 31.0


def one_degree_of_freedom() -> ReducedModel:
    """Return m (y'' + 2 zeta w y' + w^2 y) = 1/2 rho U^2 D (a1 y'/U - a3 (y'/U)^3)."""
    strength = 0.5 * DENSITY * DIAMETER
    terms = {(0, (2,)): strength * A1, (0, (2, 2, 2)): -strength * A3}
    damping = 2.0 * MASS * RATIO * FREQUENCY
    return oscillator(terms, mass=MASS, damping=damping, stiffness=MASS * FREQUENCY**2)


def test_section_11_critical_speed_of_one_degree_of_freedom() -> None:
    found = critical_wind_speeds(one_degree_of_freedom(), 30.0)
    assert found.wind_speed == pytest.approx([4.0 * MASS * RATIO * FREQUENCY / (DENSITY * DIAMETER * A1)], rel=1e-12)
    assert found.angular_frequency == pytest.approx([FREQUENCY], rel=1e-12)  # the load has no stiffness
    assert found.onset.tolist() == [True]
    assert found.unstable_after.tolist() == [1]
    assert found.oscillation.tolist() == [True]


@pytest.mark.parametrize("wind_speed", [0.5, 2.0, 12.0])
def test_section_11_amplitude_of_one_degree_of_freedom(wind_speed: float) -> None:
    model = one_degree_of_freedom()
    gain = A1 - 4.0 * RATIO * FREQUENCY * MASS / (DENSITY * wind_speed * DIAMETER)
    expected = wind_speed / FREQUENCY * np.sqrt(4.0 / (3.0 * A3) * gain)
    orbit = solved(model, start(0.8 * expected, 1.02 * FREQUENCY, wind_speed, 1))
    # With one harmonic the formula is exact: the cubic of a cosine has 3/4 of it at the first harmonic.
    assert np.hypot(*orbit.coefficients[0, 0, 1:]) == pytest.approx(expected, rel=1e-10)
    assert orbit.angular_frequency[0] == pytest.approx(FREQUENCY, rel=1e-10)


def test_section_11_a_stack_is_solved_as_its_members_are() -> None:
    # Two oscillators of different frequency and U in one stack: amplitude 1 and frequency 1 whatever the wind.
    model = circular(0.3, 2.0)
    stack = circular(0.3, 2.0, 2)
    first, second = start(0.9, 1.05, 2.0, 3), start(0.7, 0.9, 2.0, 3)
    both = Orbits(
        np.concatenate([first.coefficients, second.coefficients]), np.array([1.05, 0.9]), np.array([2.0, 2.0])
    )
    together, solution = balance(stack, np.array([0, 1]), both)
    assert solution.converged.all()
    alone = [solved(model, guess) for guess in (first, second)]
    assert together.coefficients == pytest.approx(np.concatenate([a.coefficients for a in alone]), abs=1e-13)
