"""An expansion finds the terms that there are, and says how well it predicts what it has not seen."""

import numpy as np
import pytest

from engine.uncertainty.expansion_terms import design
from engine.uncertainty.surrogate import surrogate
from tests.engine.uncertainty.known_functions import additive, ishigami


def test_a_polynomial_comes_back_term_by_term() -> None:
    samples = additive([1.0] * 6).samples(64, 1)
    terms = np.array([[0, 0, 0, 0, 0, 0], [1, 0, 0, 0, 0, 0], [0, 3, 0, 0, 0, 0], [1, 0, 1, 0, 0, 0]])
    values = design(samples.inputs, samples.unit, terms) @ np.array([5.0, 2.0, -1.0, 0.5])
    found = surrogate(samples.inputs, samples.unit, values)
    assert found is not None
    assert found.explained == pytest.approx(1.0, abs=1e-9)
    sizes = {tuple(term): c for term, c in zip(found.terms.tolist(), found.coefficients.tolist(), strict=True)}
    for term, size in zip(terms.tolist(), [5.0, 2.0, -1.0, 0.5], strict=True):
        assert sizes.pop(tuple(term)) == pytest.approx(size, abs=1e-9)
    assert max(map(abs, sizes.values()), default=0.0) < 1e-9


def test_what_it_claims_to_explain_holds_at_other_points() -> None:
    function = ishigami()
    samples, others = function.samples(48, 4), function.samples(4096, 5)
    values, truth = function.of(samples.unit), function.of(others.unit)
    found = surrogate(samples.inputs, samples.unit, values)
    assert found is not None
    predicted = design(samples.inputs, others.unit, found.terms) @ found.coefficients
    explained = 1.0 - np.mean((predicted - truth) ** 2) / np.var(truth)
    assert found.explained < 1.0
    assert found.explained == pytest.approx(explained, abs=0.15)


def test_noise_explains_nothing() -> None:
    samples = additive([1.0] * 8).samples(64, 1)
    found = surrogate(samples.inputs, samples.unit, np.random.default_rng(1).normal(size=64))
    assert found is not None
    assert found.explained < 0.2


def test_equal_values_and_few_samples_have_no_expansion() -> None:
    samples = additive([1.0, 1.0]).samples(64, 1)
    assert surrogate(samples.inputs, samples.unit, np.full(64, 3.0)) is None
    assert surrogate(samples.inputs, samples.unit[:15], samples.unit[:15, 0]) is None
