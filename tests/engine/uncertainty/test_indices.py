"""Sobol indices of functions whose indices are known, from the samples at hand."""

import numpy as np
import pytest

from engine.uncertainty.indices import Indices, sobol_indices
from engine.uncertainty.inputs import Choice, Interval
from engine.uncertainty.sampling import sobol_samples
from tests.engine.uncertainty.known_functions import KnownFunction, additive, ishigami, sobol_g

LINEAR = additive([5.0, 3.0, 2.0, 1.0, *[0.1] * 8])
G = sobol_g([0.0, 1.0, 4.5, 9.0, 99.0, 99.0, 99.0, 99.0])


def estimated(function: KnownFunction, count: int, seed: int) -> Indices:
    samples = function.samples(count, seed)
    found = sobol_indices(samples.inputs, samples.unit, function.of(samples.unit), seed)
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("function", "count", "error"),
    [(LINEAR, 64, 1e-9), (ishigami(), 64, 0.03), (ishigami(), 256, 0.001), (G, 64, 0.08), (G, 256, 0.02)],
)
def test_indices_are_those_known(function: KnownFunction, count: int, error: float) -> None:
    for seed in (0, 1, 2):
        found = estimated(function, count, seed)
        np.testing.assert_allclose(found.first_order, function.first_order, atol=error)
        np.testing.assert_allclose(found.total, function.total, atol=error)


def test_intervals_hold_the_known_indices_nearly_always() -> None:
    inside = []
    for seed in range(6):
        found = estimated(G, 64, seed)
        low, high = found.total_interval
        inside.append((low - 1e-3 <= G.total) & (G.total <= high + 1e-3))
        assert (low <= found.total).all()
        assert (found.total <= high + 1e-12).all()
        assert (high - low)[0] < 0.4  # and tell something
    assert np.mean(inside) > 0.8


def test_what_is_not_explained_may_belong_to_any_input() -> None:
    samples = LINEAR.samples(64, 1)
    noise = np.random.default_rng(2).normal(size=64)
    found = sobol_indices(samples.inputs, samples.unit, noise, 1)
    assert found is not None
    assert found.explained < 0.2
    assert (found.total_interval[0] < 0.2).all()
    assert (found.total_interval[1] > 0.8).all()


def test_a_choice_has_its_index() -> None:
    # the effect of the shape and a uniform value add up, and so do their variances
    inputs = (Choice("shape", 0.0, (1.0, 1.0, 1.0)), Interval("x", 0.5, 0.0, 1.0))
    samples = sobol_samples(inputs, 64, 1)
    effect = np.array([0.0, 1.0, 4.0])
    number = inputs[0].number(samples.unit[:, 0])
    found = sobol_indices(samples.inputs, samples.unit, effect[number] + samples.unit[:, 1], 1)
    assert found is not None
    of_shape = float(np.var(effect))
    whole = of_shape + 1.0 / 12.0
    np.testing.assert_allclose(found.total, [of_shape / whole, 1.0 / 12.0 / whole], atol=1e-9)


def test_a_constant_has_no_indices() -> None:
    samples = LINEAR.samples(64, 1)
    assert sobol_indices(samples.inputs, samples.unit, np.zeros(64), 1) is None
