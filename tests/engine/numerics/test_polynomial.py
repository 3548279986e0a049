"""Tables of cubic polynomials against direct evaluation."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.arrays import FloatArray
from engine.numerics.polynomial import count, monomials, powers, slopes, substitute
from tests.builders import sorted_products

SIZES = st.integers(1, 6)
SEEDS = st.integers(0, 10**6)


def direct(x: FloatArray) -> FloatArray:
    """Multiply out every monomial at one point."""
    return np.array([np.prod(x[list(product)]) for product in sorted_products(x.size)])


@pytest.mark.parametrize("variables", [1, 2, 3, 6])
def test_monomials_stand_in_the_documented_order(variables: int) -> None:
    assert list(monomials(variables)) == sorted_products(variables)
    assert [count(variables, d) for d in (1, 2, 3)] == [
        sum(len(m) == d for m in sorted_products(variables)) for d in (1, 2, 3)
    ]


@settings(max_examples=30)
@given(SIZES, SEEDS)
def test_powers_are_the_products(variables: int, seed: int) -> None:
    x = np.random.default_rng(seed).normal(size=(2, 3, variables))
    assert powers(x)[1, 2] == pytest.approx(direct(x[1, 2]), rel=1e-13)
    lower = sum(count(variables, d) for d in (1, 2))
    assert powers(x, 2)[0, 1] == pytest.approx(direct(x[0, 1])[:lower], rel=1e-13)


@settings(max_examples=30)
@given(SIZES, SEEDS)
def test_slopes_are_the_derivatives(variables: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    table, x = rng.normal(size=(2, len(sorted_products(variables)))), rng.normal(size=variables)
    lower = np.concatenate([[1.0], powers(x, 2)])
    found = slopes(table) @ lower
    step = 1e-3
    for i in range(variables):
        e = step * np.eye(variables)[i]
        # Central differences of four points are exact for cubics.
        difference = 8.0 * (direct(x + e) - direct(x - e)) - (direct(x + 2.0 * e) - direct(x - 2.0 * e))
        assert found[:, i] == pytest.approx(table @ difference / (12.0 * step), rel=1e-9, abs=1e-9)


@settings(max_examples=30)
@given(st.integers(1, 3), SIZES, SEEDS)
def test_substitution_is_evaluation_at_the_forms(local: int, variables: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    table = rng.normal(size=(2, 4, 3, len(sorted_products(local))))
    forms = rng.normal(size=(2, 4, local, variables))
    x = rng.normal(size=variables)
    found = substitute(table, forms)
    assert found.shape == (2, 3, len(sorted_products(variables)))
    for member in range(2):
        expected = sum(table[member, p] @ direct(forms[member, p] @ x) for p in range(4))
        assert found[member] @ direct(x) == pytest.approx(expected, rel=1e-10, abs=1e-10)
