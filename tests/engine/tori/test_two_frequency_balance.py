"""Two-frequency balance against exact tori, finite differences, finer grids and direct integration."""

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.checks.time_integration import integrate
from engine.models.reduced_model import take
from engine.tori.two_frequency_balance import (
    Tori,
    balance,
    harmonic_lattice,
    linearized,
    phasors,
    points_of,
    resized,
    states,
    tori_of,
)
from tests.builders import Oscillators, hand_made, hybrid, source_line
from tests.engine.coupled_circles import FREQUENCIES, circle_radii, coupled_circles, two_lines

ONE = np.zeros(1, dtype=np.intp)


def strengths(torus: Tori, *pairs: list[int]) -> FloatArray:
    """Return the amplitudes of some pairs of harmonics of one torus: (m, pairs)."""
    known = harmonic_lattice(torus.order).pairs.tolist()
    return np.asarray(np.abs(phasors(torus.coefficients[0]))[:, [known.index(pair) for pair in pairs]])


def random_tori(seed: int) -> Tori:
    generator = np.random.default_rng(seed)
    coefficients = 0.05 * generator.normal(size=(2, 3, 2 * len(harmonic_lattice((3, 2)).pairs) - 1))
    return Tori(coefficients, np.array([[5.6, 0.3], [5.5, 0.2]]), np.array([8.0, 9.0]), (3, 2))


@pytest.mark.parametrize("coupling", [(0.5, 0.5), (0.4, 0.8), (1.5, 1.6)])
def test_exact_torus_is_met_from_a_start_beside_it(coupling: tuple[float, float]) -> None:
    radii = circle_radii(coupling)
    start = two_lines((1.1 * radii[0], 0.9 * radii[1]), (1.01, 1.36), (3, 2))
    found, solution = balance(coupled_circles(coupling), ONE, start)
    assert solution.converged.all()
    assert found.angular_frequency.sum(axis=-1) == pytest.approx([FREQUENCIES[1]], abs=1e-9)
    assert found.angular_frequency[0, 0] == pytest.approx(FREQUENCIES[0], abs=1e-9)
    assert strengths(found, [1, 0], [1, 1]) == pytest.approx(np.diag(radii), abs=1e-9)


def test_two_van_der_pol_oscillators_keep_amplitude_two_and_their_frequencies() -> None:
    # Each alone: amplitude 2 + O(mu^2), frequency w (1 - (mu/w)^2 / 16) (Lindstedt).
    mu, first, second = 0.1, 1.0, 1.37
    terms: dict[tuple[int, tuple[int, ...]], float] = {}
    for i in (0, 1):
        terms |= {(i, (2 + i,)): mu, (i, (i, i, 2 + i)): -mu}
    model = hand_made(Oscillators(np.eye(2), np.zeros((2, 2)), np.diag([first**2, second**2]), terms))
    found, solution = balance(model, ONE, two_lines((1.8, 2.2), (first, second), (5, 5)))
    assert solution.converged.all()
    assert np.diag(strengths(found, [1, 0], [1, 1])) == pytest.approx([2.0, 2.0], rel=mu**2 / 8.0)
    own = np.array([found.angular_frequency[0, 0], found.angular_frequency[0].sum()])
    expected = [w * (1.0 - (mu / w) ** 2 / 16.0) for w in (first, second)]
    assert own == pytest.approx(expected, abs=mu**4)


def test_slopes_are_those_of_finite_differences() -> None:
    model, tori = take(hybrid(source_line(1), 2), [0, 0]), random_tori(0)
    _, slopes = linearized(model, tori)
    z = points_of(tori)
    for i in range(z.shape[1]):
        step = np.zeros_like(z)
        step[:, i] = 1e-6 * np.maximum(1.0, np.abs(z[:, i]))
        above, below = (linearized(model, tori_of(point, 3, tori.order))[0] for point in (z + step, z - step))
        numeric = (above - below) / (2.0 * step[:, [i]])
        assert slopes[..., i] == pytest.approx(numeric, rel=1e-6, abs=1e-9 * np.abs(slopes[..., i]).max() + 1e-6)


def test_the_grid_does_not_alias() -> None:
    model, tori = take(hybrid(source_line(2), 1), [0, 0]), random_tori(1)
    rest, _ = linearized(model, tori)
    finer = resized(tori, (6, 5))
    longer = Tori(linearized(model, finer)[0].reshape(2, 3, -1), tori.angular_frequency, tori.wind_speed, (6, 5))
    kept = resized(longer, tori.order).coefficients.reshape(2, -1)
    assert rest == pytest.approx(kept, rel=1e-9, abs=1e-9 * np.abs(kept).max())


def test_a_stable_torus_is_where_direct_integration_ends() -> None:
    model = coupled_circles((0.5, 0.5))
    radii = circle_radii((0.5, 0.5))
    settled = integrate(take(model, 0), 1.0, np.array([0.75, 0.9, 0.0, 0.0]), change=1e-6, longest=200)
    assert settled.amplitude == pytest.approx(radii, rel=2e-3)  # 64 samples a cycle
    found, _ = balance(model, ONE, two_lines(radii, FREQUENCIES, (2, 2)))
    energy = settled.state[:2] ** 2 + (settled.state[2:] / FREQUENCIES) ** 2
    here = states(found, np.array([[0.3, 2.0]]))[0, 0]
    assert here[:2] ** 2 + (here[2:] / FREQUENCIES) ** 2 == pytest.approx(energy, rel=1e-4)
