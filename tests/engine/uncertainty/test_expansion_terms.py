"""Terms are orthonormal under the distributions of their inputs."""

import numpy as np

from engine.uncertainty.expansion_terms import design, terms_up_to
from engine.uncertainty.inputs import Choice, Interval

INPUTS = (Interval("a", 0.5, 0.0, 1.0), Choice("b", 0.0, (1.0, 2.0, 5.0)), Interval("c", 0.5, 0.0, 1.0))


def test_terms_are_orthonormal() -> None:
    terms = terms_up_to(INPUTS, 4)
    points, weights = np.polynomial.legendre.leggauss(12)
    unit, weight = (points + 1.0) / 2.0, weights / 2.0
    shares = np.array([1.0, 2.0, 5.0]) / 8.0
    middles = np.cumsum(shares) - shares / 2.0
    grid = np.stack(np.meshgrid(unit, middles, unit, indexing="ij"), axis=-1).reshape(-1, 3)
    of_grid = np.einsum("i,j,k->ijk", weight, shares, weight).ravel()
    matrix = design(INPUTS, grid, terms)
    np.testing.assert_allclose((matrix.T * of_grid) @ matrix, np.eye(terms.shape[0]), atol=1e-12)


def test_the_constant_is_the_first_term_and_none_comes_twice() -> None:
    terms = terms_up_to(INPUTS, 5)
    assert not terms[0].any()
    assert len({tuple(term) for term in terms.tolist()}) == terms.shape[0]
    assert ((terms > 0).sum(axis=1) <= 2).all()


def test_contrasts_have_degree_one_and_mixed_terms_need_a_higher_one() -> None:
    first = {tuple(term) for term in terms_up_to(INPUTS, 1).tolist()}
    assert first == {(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 2, 0), (0, 0, 1)}
    # (1 + 1)^(1/0.75) is 2.52
    assert (1, 1, 0) not in {tuple(term) for term in terms_up_to(INPUTS, 2).tolist()}
    assert (1, 2, 0) in {tuple(term) for term in terms_up_to(INPUTS, 3).tolist()}
