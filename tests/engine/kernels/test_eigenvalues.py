"""The kernel for eigenvalues against LAPACK, and by its own error: how near a matrix is that has them exactly."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.linalg import eig, svdvals

from engine.arrays import ComplexArray, FloatArray
from engine.kernels import compiled
from engine.kernels.eigenvalues import eigenvalues

pytestmark = pytest.mark.skipif(not compiled.AVAILABLE, reason="the kernels were not built")

SIZES = (1, 2, 3, 4, 5, 6, 8, 11, 16)
COUNT = 60
ROUNDING = float(np.finfo(np.float64).eps)


def random(n: int, draw: np.random.Generator) -> FloatArray:
    return draw.normal(size=(n, n))


def defective(n: int, draw: np.random.Generator) -> FloatArray:
    """Return a matrix with one eigenvalue and one eigenvector, in a random basis."""
    turn = np.linalg.qr(random(n, draw))[0]
    return np.asarray(turn @ (0.7 * np.eye(n) + np.eye(n, k=1)) @ turn.T)


def nearly_multiple(n: int, draw: np.random.Generator) -> FloatArray:
    turn = np.linalg.qr(random(n, draw))[0]
    return np.asarray(turn @ (np.diag(1.0 + 1e-9 * draw.normal(size=n)) + 1e-3 * np.eye(n, k=1)) @ turn.T)


def multiple(n: int, draw: np.random.Generator) -> FloatArray:
    """Return a symmetric matrix whose eigenvalues are 1 and -1."""
    turn = np.linalg.qr(random(n, draw))[0]
    return np.asarray(turn @ np.diag(np.where(np.arange(n) % 2, 1.0, -1.0)) @ turn.T)


def graded(n: int, draw: np.random.Generator) -> FloatArray:
    """Return a matrix like that of a period: one multiplier near 1, others down to 1e-12."""
    basis = random(n, draw)
    return np.asarray(basis @ np.diag(np.logspace(0.0, -12.0, n)) @ np.linalg.inv(basis))


def badly_scaled(n: int, draw: np.random.Generator) -> FloatArray:
    scale = 10.0 ** draw.uniform(-8.0, 8.0, n)
    return np.asarray(scale[:, None] * random(n, draw) / scale)


def sparse(n: int, draw: np.random.Generator) -> FloatArray:
    return np.where(draw.uniform(size=(n, n)) < 0.6, 0.0, random(n, draw))


def turning(n: int, draw: np.random.Generator) -> FloatArray:
    """Return a shift of all coordinates: its eigenvalues, on the unit circle, need shifts that are no eigenvalues."""
    return np.asarray(np.roll(np.eye(n), 1, axis=0) * draw.choice([0.5, 1.0, 2.0]))


KINDS = (random, defective, nearly_multiple, multiple, graded, badly_scaled, sparse, turning)


def stack(kind: Callable[[int, np.random.Generator], FloatArray], n: int) -> FloatArray:
    draw = np.random.default_rng(n)
    return np.stack([kind(n, draw) for _ in range(COUNT)])


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("n", SIZES)
def test_a_matrix_nearby_has_these_eigenvalues(kind: Callable[..., FloatArray], n: int) -> None:
    matrices = stack(kind, n)
    found = compiled.small_eigenvalues(matrices)
    for matrix, values in zip(matrices, found, strict=True):
        if np.isnan(values).any():  # refused
            assert not matrix.any()
            continue
        size = float(np.linalg.norm(matrix, 2))
        for value in values:
            distance = svdvals(matrix - value * np.eye(n))[-1]  # of the nearest matrix that has this eigenvalue
            assert distance <= 4.0 * n * ROUNDING * size
        assert values.sum() == pytest.approx(np.trace(matrix), abs=4.0 * n**2 * ROUNDING * size)


@pytest.mark.parametrize("kind", [random, graded, badly_scaled], ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("n", [2, 3, 6, 8])
def test_they_are_those_of_lapack_as_far_as_each_is_conditioned(kind: Callable[..., FloatArray], n: int) -> None:
    matrices = stack(kind, n)
    for matrix, values in zip(matrices, compiled.small_eigenvalues(matrices), strict=True):
        expected, left, right = eig(matrix, left=True)
        condition = 1.0 / np.abs(np.einsum("ij,ij->j", left.conj(), right))
        mine = matched(values, expected)
        assert (np.abs(mine - expected) <= 100.0 * ROUNDING * condition * np.linalg.norm(matrix, 2)).all()


def matched(values: ComplexArray, to: ComplexArray) -> ComplexArray:
    """Return the values in the order of others: each is the nearest that is left."""
    left = values.tolist()
    return np.array([left.pop(int(np.abs(np.array(left) - value).argmin())) for value in to])


def test_balancing_keeps_the_digits_of_small_eigenvalues() -> None:
    """Of a matrix whose basis vectors differ by 1e12 in length, norms alone would leave the small ones no digit."""
    scale = 2.0 ** np.array([0.0, 20.0, -20.0, 10.0, -10.0, 5.0])
    plain = stack(random, 6)
    found = compiled.small_eigenvalues(scale[:, None] * plain / scale)
    for values, expected in zip(found, compiled.small_eigenvalues(plain), strict=True):
        assert matched(values, expected) == pytest.approx(expected, rel=1e-9)


def test_pairs_are_conjugate_to_the_bit() -> None:
    values = compiled.small_eigenvalues(stack(random, 6))
    assert (values.imag > 0.0).any()
    for one in values:
        upper, lower = one[one.imag > 0.0], one[one.imag < 0.0]
        assert sorted(upper.conj().tolist(), key=str) == sorted(lower.tolist(), key=str)


@pytest.mark.parametrize("odd", [np.nan, np.inf, -np.inf, 1e200, 1e-200])
def test_what_the_method_cannot_do_is_left_to_the_caller(odd: float) -> None:
    matrices = stack(random, 6)[:3]
    matrices[1] *= odd
    found = compiled.small_eigenvalues(matrices)
    assert np.isnan(found[1]).all()
    assert np.isfinite(found[[0, 2]]).all()


def test_a_stack_may_be_empty_or_a_part_of_another() -> None:
    matrices = stack(random, 6)
    assert compiled.small_eigenvalues(matrices[:0]).shape == (0, 6)
    assert (compiled.small_eigenvalues(matrices[::2]) == compiled.small_eigenvalues(matrices)[::2]).all()


@pytest.mark.parametrize("available", [True, False])
def test_lapack_finds_those_that_the_kernel_refuses(available: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled, "AVAILABLE", available and compiled.AVAILABLE)
    matrices = np.diag([3.0, 2.0, 1.0, 0.5]) * np.array([1.0, 1e200, 1e-200, 0.0])[:, None, None]
    found = np.sort(eigenvalues(matrices).real, axis=-1)
    assert found == pytest.approx(np.sort(np.diagonal(matrices, axis1=1, axis2=2), axis=-1), rel=1e-15)


def test_matrices_of_any_size_have_eigenvalues() -> None:
    """Critical wind speeds of tied phases are eigenvalues of more than a thousand rows."""
    triangular = np.triu(np.ones((1, 1001, 1001)), 990) + np.diag(np.arange(1.0, 1002.0))
    assert np.sort(eigenvalues(triangular)[0].real) == pytest.approx(np.arange(1.0, 1002.0), rel=1e-12)
