"""Floquet multipliers against brute-force integration of the variational equations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine.arrays import FloatArray
from engine.cycles.floquet import floquet, monodromy, stability_verdicts
from engine.cycles.harmonic_balance import Orbits, states
from engine.models.aerodynamic_load import force_gradient
from engine.models.reduced_model import ReducedModel
from engine.outcome import Stability
from tests.builders import finite_element, hybrid, source_line
from tests.engine.motions import orbit_of

ALONE = np.array([0])


def by_integration(model: ReducedModel, orbit: Orbits) -> FloatArray:
    """Integrate M x'' + (C - U f_v) x' + (K - U^2 f_q) x = 0 in time over one period, all columns at once."""
    m = model.mass.shape[-1]
    omega, speed = float(orbit.angular_frequency[0]), float(orbit.wind_speed[0])
    inverse = np.linalg.inv(model.mass[0])

    def rate(t: float, y: FloatArray) -> FloatArray:
        x = y.reshape(2 * m, 2 * m)
        gradient = force_gradient(model.load, states(orbit, np.array([omega * t])))[0, 0]
        stiffness = model.stiffness[0] - speed**2 * gradient[:, :m]
        damping = model.damping[0] - speed * gradient[:, m:]
        return np.concatenate([x[m:], -inverse @ (stiffness @ x[:m] + damping @ x[m:])]).ravel()

    run = solve_ivp(rate, (0.0, 2.0 * np.pi / omega), np.eye(2 * m).ravel(), method="DOP853", rtol=1e-9, atol=1e-11)
    return np.asarray(run.y[:, -1].reshape(2 * m, 2 * m))


@pytest.mark.parametrize(
    ("subconductors", "loops", "wind_speed"), [(1, 1, 6.0), (1, 2, 6.0), (2, 1, 4.0), (2, 2, 6.0), (3, 2, 5.0)]
)
def test_multipliers_of_the_hybrid_model(subconductors: int, loops: int, wind_speed: float) -> None:
    model = hybrid(source_line(subconductors), loops)
    compare(model, orbit_of(model, wind_speed))


def test_multipliers_of_the_finite_element_model() -> None:
    model = finite_element(source_line(2), (1, 2))
    compare(model, orbit_of(model, 5.0))


def compare(model: ReducedModel, orbit: Orbits) -> None:
    """Compare monodromy matrices, trivial multiplier and judgement."""
    m = model.mass.shape[-1]
    brute = by_integration(model, orbit)
    # The engine's velocities are by phase, x'/w: a similarity by the frequency.
    scale = np.repeat([1.0, 1.0 / float(orbit.angular_frequency[0])], m)
    found = monodromy(model, ALONE, orbit)[0]
    # Magnus' method of fourth order; what it leaves must stay below the 1e-4 that the trivial multiplier may be off.
    assert found == pytest.approx(scale[:, None] * brute / scale, abs=1e-4 * np.abs(found).max())
    result = floquet(model, ALONE, orbit)
    values = np.linalg.eigvals(brute)
    trivial = np.abs(values - 1.0).argmin()
    assert abs(values[trivial] - 1.0) < 1e-5  # the orbit itself is periodic
    assert result.trivial_error[0] == pytest.approx(abs(result.multipliers[0, 0] - 1.0))
    assert result.trivial_error[0] < 1e-4
    others = np.sort(np.abs(np.delete(values, trivial)))
    assert np.sort(np.abs(result.multipliers[0, 1:])) == pytest.approx(others, abs=2e-4)
    if abs(others[-1] - 1.0) > 1e-3:
        assert result.stability[0] is (Stability.STABLE if others[-1] < 1.0 else Stability.UNSTABLE)


def test_trivial_direction_is_the_velocity_of_the_orbit() -> None:
    model = hybrid(source_line(2), 2)
    orbit = orbit_of(model, 5.0)
    speed = float(orbit.wind_speed[0] / orbit.angular_frequency[0])
    step = 1e-5
    around = states(orbit, np.array([-step, step]))[0]
    tangent = (around[1] - around[0]) / (2.0 * step) * np.repeat([1.0, speed], 3)
    assert monodromy(model, ALONE, orbit)[0] @ tangent == pytest.approx(tangent, abs=1e-4 * np.abs(tangent).max())


def test_stack_is_judged_as_its_members() -> None:
    one, other = hybrid(source_line(2), 1), hybrid(source_line(2), 2)
    first, second = orbit_of(one, 5.0), orbit_of(one, 6.0)
    both = Orbits(
        np.concatenate([first.coefficients, second.coefficients]),
        np.concatenate([first.angular_frequency, second.angular_frequency]),
        np.array([5.0, 6.0]),
    )
    together = monodromy(one, np.zeros(2, dtype=np.intp), both)
    assert together[1] == pytest.approx(monodromy(one, ALONE, second)[0], abs=1e-6)
    assert not np.allclose(together[1], monodromy(other, ALONE, second)[0], atol=1e-3)


def test_what_the_error_does_not_decide_is_unknown() -> None:
    largest = np.array([0.9, 1.1, 0.9999, 1.0001, 1.0 - 1e-9, np.nan])
    error = np.array([1e-9, 1e-9, 1e-3, 1e-3, 0.0, 1e-9])
    expected = [Stability.STABLE, Stability.UNSTABLE, *[Stability.UNKNOWN] * 4]
    assert stability_verdicts(largest, error).tolist() == expected
