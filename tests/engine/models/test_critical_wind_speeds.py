"""Critical wind speeds against eigenvalues and a dense scan of the wind."""

from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.kernels import compiled
from engine.models.critical_wind_speeds import (
    Crossings,
    at_wind,
    bialternate_sum,
    critical_wind_speeds,
    state_matrices,
    unstable_pairs,
)
from engine.models.reduced_model import ReducedModel
from tests.builders import Oscillators, finite_element, hand_made, hybrid, random_line, source_line

LIMIT = 30.0


def companion(model: ReducedModel, wind_speed: float) -> FloatArray:
    """Return y' = A y of the linearized equations, the load's slopes read from its table by finite differences."""
    m = model.mass.shape[-1]
    forms, table = model.load.forms[0], model.load.table[0]
    local = forms.shape[-2]
    # The linear terms are the first columns of the table.
    slope = np.einsum("pol,plx->ox", table[..., :local], forms)
    inverse = np.linalg.inv(model.mass[0])
    matrix = np.zeros((2 * m, 2 * m))
    matrix[:m, m:] = np.eye(m)
    matrix[m:, :m] = -inverse @ (model.stiffness[0] - wind_speed**2 * slope[:, :m])
    matrix[m:, m:] = -inverse @ (model.damping[0] - wind_speed * slope[:, m:])
    return matrix


def count(model: ReducedModel, wind_speed: float) -> int:
    """Count unstable pairs, a real eigenvalue as one."""
    values = np.linalg.eigvals(companion(model, wind_speed))
    return int(((values.real > 0.0) & (values.imag >= 0.0)).sum())


@pytest.mark.parametrize("size", [2, 4, 6])
def test_bialternate_sum_has_the_sums_of_pairs_as_eigenvalues(size: int) -> None:
    matrix = np.random.default_rng(size).normal(size=(size, size))
    values = np.linalg.eigvals(matrix)
    sums = np.array([a + b for a, b in combinations(values, 2)])
    found = np.linalg.eigvals(bialternate_sum(matrix))
    distance = np.abs(sums[:, None] - found)
    assert distance.min(axis=0).max() < 1e-10
    assert distance.min(axis=1).max() < 1e-10
    assert found.sum() == pytest.approx((size - 1) * np.trace(matrix), abs=1e-10)


def test_state_matrices_are_similar_to_the_companion_matrix() -> None:
    model = hybrid(source_line(3), 2)
    found = at_wind(state_matrices(model), np.array([7.3]))[0]
    expected = np.sort_complex(np.linalg.eigvals(companion(model, 7.3)))
    assert np.sort_complex(np.linalg.eigvals(found)) == pytest.approx(expected, abs=1e-9)


def test_unstable_pairs_counts_a_real_eigenvalue_and_a_pair_once_each() -> None:
    values = np.array([[0.1 + 2.0j, 0.1 - 2.0j, 0.3, -0.5], [-0.1 + 1j, -0.1 - 1j, -1.0, -2.0]])
    assert unstable_pairs(values).tolist() == [2, 0]


def models() -> list[ReducedModel]:
    """Return hybrid models of 30 random lines, one and two loops in turn, that are statically stable."""
    made = [hybrid(random_line(np.random.default_rng(seed)), 1 + seed % 2) for seed in range(30)]
    stable = [model for model in made if not model.statically_unstable[0]]
    assert len(stable) > 20
    return stable


def confirmed(model: ReducedModel, found: Crossings) -> None:
    """Check each crossing by the eigenvalues just below and above it."""
    for i, speed in enumerate(found.wind_speed):
        gap = min([abs(speed - other) for j, other in enumerate(found.wind_speed) if j != i], default=speed)
        step = min(1e-4 * speed, 0.3 * gap)
        below, above = count(model, speed - step), count(model, speed + step)
        assert above - below == (1 if found.onset[i] else -1)
        assert found.unstable_after[i] == above
        values = np.linalg.eigvals(companion(model, speed))
        size = np.abs(values).max()
        at = values[np.abs(values - 1j * found.angular_frequency[i]).argmin()]
        # Imaginary to a part in 1e8 of its own frequency, which is what a crossing is.
        assert abs(at - 1j * found.angular_frequency[i]) < 1e-7 * size
        assert bool(found.angular_frequency[i] > 0.0) == bool(found.oscillation[i])


def test_every_crossing_is_confirmed_by_eigenvalues_on_both_sides() -> None:
    total = 0
    for model in models():
        found = critical_wind_speeds(model, LIMIT)
        confirmed(model, found)
        total += found.wind_speed.size
    assert total > 20


def test_a_dense_scan_finds_the_same_crossings() -> None:
    grid = np.linspace(1e-3, LIMIT, 3001)
    for model in models():
        counts = [count(model, speed) for speed in grid.tolist()]
        found = critical_wind_speeds(model, LIMIT)
        inside = np.histogram(found.wind_speed, grid)[0]
        change = np.where(found.onset, 1, -1)
        jump = np.histogram(found.wind_speed, grid, weights=change)[0]
        scanned = np.array([b - a for a, b in pairwise(counts)])
        assert jump.tolist() == scanned.tolist()
        assert (inside >= np.abs(scanned)).all()


def test_crossings_are_those_without_the_kernel(monkeypatch: pytest.MonkeyPatch) -> None:
    found = [critical_wind_speeds(model, LIMIT) for model in models()]
    monkeypatch.setattr(compiled, "AVAILABLE", False)
    for model, mine in zip(models(), found, strict=True):
        expected = critical_wind_speeds(model, LIMIT)
        assert mine.wind_speed == pytest.approx(expected.wind_speed, rel=1e-9)
        assert mine.coordinate.tolist() == expected.coordinate.tolist()
        assert mine.unstable_after.tolist() == expected.unstable_after.tolist()


def test_finite_element_crossings_are_confirmed_too() -> None:
    for n in (1, 2):
        model = finite_element(source_line(n))
        found = critical_wind_speeds(model, LIMIT)
        assert found.wind_speed.size >= 4
        confirmed(model, found)


def test_divergence_of_torsion_by_hand() -> None:
    # k - U^2 a = 0 for one coordinate; the other is damped and idle.
    stiffness, slope = 5.0, 0.03
    model = hand_made(
        Oscillators(np.eye(2), 0.4 * np.eye(2), np.diag([stiffness, 9.0]), {(0, (0,)): slope, (0, (0, 0, 0)): -1.0})
    )
    found = critical_wind_speeds(model, LIMIT)
    assert found.wind_speed == pytest.approx([np.sqrt(stiffness / slope)], rel=1e-12)
    assert found.oscillation.tolist() == [False]
    assert found.onset.tolist() == [True]
    assert found.angular_frequency.tolist() == [0.0]
    assert found.coordinate.tolist() == [0]
    assert found.unstable_after.tolist() == [1]


def test_two_pairs_that_cross_on_their_own_are_both_reported() -> None:
    # c - U a = 0 for each; the second begins to grow where the first already does.
    model = hand_made(
        Oscillators(np.diag([1.0, 2.0]), np.diag([0.2, 0.9]), np.diag([4.0, 18.0]), {(0, (2,)): 0.05, (1, (3,)): 0.06})
    )
    found = critical_wind_speeds(model, LIMIT)
    assert found.wind_speed == pytest.approx([4.0, 15.0], rel=1e-12)
    assert found.angular_frequency == pytest.approx([2.0, 3.0], rel=1e-12)
    assert found.coordinate.tolist() == [0, 1]
    assert found.unstable_after.tolist() == [1, 2]


def test_classical_flutter_by_routh_and_hurwitz() -> None:
    # Two coordinates coupled by U^2 in the stiffness, equal damping c: imaginary pair where
    # (k_2 - k_1)^2 - 4 U^4 b^2 = -2 c^2 (k_1 + k_2), from s = i w with w^2 = (k_1 + k_2)/2.
    k_1, k_2, b, c = 4.0, 9.0, 0.05, 0.3
    coupled: dict[tuple[int, tuple[int, ...]], float] = {(0, (1,)): b, (1, (0,)): -b}
    model = hand_made(Oscillators(np.eye(2), c * np.eye(2), np.diag([k_1, k_2]), coupled))
    found = critical_wind_speeds(model, LIMIT)
    expected = (((k_2 - k_1) ** 2 + 2.0 * c**2 * (k_1 + k_2)) / (4.0 * b**2)) ** 0.25
    assert found.wind_speed == pytest.approx([expected], rel=1e-10)
    assert found.angular_frequency == pytest.approx([np.sqrt(0.5 * (k_1 + k_2))], rel=1e-10)


def test_limit_cuts_and_members_are_kept_apart() -> None:
    one = hybrid(source_line(1), 1)
    assert critical_wind_speeds(one, 5.0).wind_speed.size == 1
    assert critical_wind_speeds(one, 2.0).wind_speed.size == 0
    divergent = hybrid(replace(source_line(1), span=replace(source_line(1).span, length=200.0)), 1)
    assert divergent.statically_unstable[0]
    assert critical_wind_speeds(divergent, LIMIT).wind_speed.size == 0


def test_neutral_saddles_are_no_crossings() -> None:
    # One oscillator crosses at U = 4 and one coordinate diverges at 5; its growing real
    # eigenvalue then passes the mirror images of the two decaying ones of an overdamped third: sums that vanish without
    # an imaginary pair.
    stiffness, damping = np.diag([4.0, 1.0, 2.2165]), np.diag([0.2, 0.1, 3.0])
    model = hand_made(Oscillators(np.eye(3), damping, stiffness, {(0, (3,)): 0.05, (1, (1,)): 0.04}))
    found = critical_wind_speeds(model, 30.0)
    assert found.wind_speed == pytest.approx([4.0, 5.0], rel=1e-10)
    assert found.unstable_after.tolist() == [1, 2]
