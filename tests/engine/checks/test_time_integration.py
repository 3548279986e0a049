"""Direct integration reaches the orbits of harmonic balance, and linear motion is exact."""

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.checks.time_integration import integrate
from engine.cycles.harmonic_balance import half_peak_to_peak, states
from engine.models.reduced_model import ReducedModel, take
from engine.outcome import Outcome
from tests.builders import Oscillators, hand_made, hybrid, source_line
from tests.engine.motions import orbit_of

WIND_SPEED = 6.0


def disturbed(model: ReducedModel, factor: float) -> tuple[FloatArray, FloatArray]:
    """Return a state near the orbit at 6 m/s, and the amplitudes of the orbit."""
    orbit = orbit_of(model, WIND_SPEED)
    state = factor * states(orbit, np.zeros(1))[0, 0]
    state[3:] *= WIND_SPEED
    return state, half_peak_to_peak(orbit.coefficients[0])


@pytest.mark.parametrize("subconductors", [2, 3])
def test_settles_on_the_orbit_of_one_loop_from_beside_it(subconductors: int) -> None:
    model = hybrid(source_line(subconductors), 1)
    state, expected = disturbed(model, 1.02)
    settled = integrate(take(model, 0), WIND_SPEED, state, change=4e-4, longest=600)
    assert settled.outcome is Outcome.CONVERGED
    # It approaches by a tenth a block or more, so a block that moves by 4e-4 is within 4e-3 of the end.
    assert settled.amplitude == pytest.approx(expected, rel=5e-3)


def test_stays_on_the_orbit_of_two_loops() -> None:
    # The 1:1 resonance settles over thousands of cycles; on the orbit nothing may move.
    model = hybrid(source_line(2), 2)
    state, expected = disturbed(model, 1.0)
    settled = integrate(take(model, 0), WIND_SPEED, state, change=0.0, longest=100)
    assert settled.outcome is Outcome.LIMIT_REACHED
    assert settled.cycles == 100
    # 64 samples a cycle miss a peak by at most 1 - cos(pi/64) = 1.2e-3.
    assert settled.amplitude == pytest.approx(expected, rel=2e-3)


def test_free_motion_decays_as_its_damping_says() -> None:
    rate, omega = 0.004, 2.0
    damping = np.diag([2.0 * rate, 1.0])
    model = hand_made(Oscillators(np.eye(2), damping, np.diag([omega**2 + rate**2, 9.0]), {}))
    settled = integrate(take(model, 0), 1.0, np.array([1.0, 0.0, -rate, 0.0]), change=0.0, longest=50)
    time = 50 * 2.0 * np.pi / np.sqrt(omega**2 + rate**2)  # cycles of the undamped frequency
    expected = np.exp(-rate * time) * np.cos(omega * time)
    assert settled.state[0] == pytest.approx(expected, abs=1e-6)
    assert settled.extremes[0, 1] == pytest.approx(1.0, abs=1e-12)


def test_unstable_equilibrium_is_left_and_stable_one_is_reached() -> None:
    start = np.array([1e-3, 0.0, 0.0, 0.0, 0.0, 0.0])
    model = take(hybrid(source_line(2), 1), 0)
    below, above = (integrate(model, speed, start, change=0.0, longest=100) for speed in (1.5, 5.0))
    assert below.amplitude[0] < 1e-3
    assert above.amplitude[0] > 1.02e-3
