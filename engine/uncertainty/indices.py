"""Sobol indices: the share of each uncertain input in the variance of a result."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.uncertainty.inputs import Uncertain
from engine.uncertainty.surrogate import Surrogate, surrogate

RESAMPLES = 200
INTERVAL = (0.025, 0.975)
RIDGE = 1e-9  # keeps a resample solvable in which too few samples differ


@dataclass(frozen=True, slots=True)
class Indices:
    """First-order and total indices of each input, each (inputs,), with the ends of their 95 % intervals (2, inputs).

    explained: share of the variance that the expansion behind them predicts at samples that it has not seen.
    """

    first_order: FloatArray
    total: FloatArray
    first_order_interval: FloatArray
    total_interval: FloatArray
    explained: float


def sobol_indices(inputs: Sequence[Uncertain], unit: FloatArray, values: FloatArray, seed: int) -> Indices | None:
    """Return the indices of a result that was computed at samples, None if it does not vary or the samples are few.

    They follow from the squares of the coefficients of a sparse expansion (Sudret 2008, Global sensitivity analysis
    using polynomial chaos expansions), so the samples at hand suffice. Their intervals come from resamples (bootstrap)
    with the terms held, and are widened by what the expansion does not explain: that variance may belong to any input,
    or to none.

    Parameters
    ----------
    inputs : sequence of Uncertain
    unit : (samples, inputs)
    values : (samples,)
    seed : int
        Of the resamples.
    """
    found = surrogate(inputs, unit, values)
    if found is None:
        return None
    first, total = _shares(found.terms, found.coefficients)
    resampled = _shares(found.terms, _resampled(found, values, np.random.default_rng(seed)))
    explained = min(max(found.explained, 0.0), 1.0)
    intervals = [_interval(one, many, explained) for one, many in zip((first, total), resampled, strict=True)]
    return Indices(first, total, intervals[0], intervals[1], found.explained)


def _shares(terms: IntArray, coefficients: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return first-order and total shares (..., inputs) of the variance of an expansion; 0 of one that is constant."""
    active = terms > 0
    alone = active & (active.sum(axis=1, keepdims=True) == 1)
    variance = np.where(active.any(axis=1), coefficients**2, 0.0)
    whole = variance.sum(axis=-1, keepdims=True)
    whole = np.where(whole > 0.0, whole, 1.0)
    return variance @ alone / whole, variance @ active / whole


def _resampled(found: Surrogate, values: FloatArray, generator: np.random.Generator) -> FloatArray:
    """Return the coefficients (resamples, terms) that samples drawn with repetition give."""
    count, terms = found.matrix.shape
    weights = generator.multinomial(count, np.full(count, 1.0 / count), RESAMPLES) / count
    coefficients = np.empty((RESAMPLES, terms))
    for i, weight in enumerate(weights):
        weighted = found.matrix.T * weight
        system = weighted @ found.matrix + RIDGE * np.eye(terms)
        coefficients[i] = np.linalg.solve(system, weighted @ values)
    return coefficients


def _interval(share: FloatArray, resampled: FloatArray, explained: float) -> FloatArray:
    low, high = np.quantile(resampled, INTERVAL, axis=0)
    low, high = np.minimum(low, share), np.maximum(high, share)
    return np.array([explained * low, np.minimum(explained * high + (1.0 - explained), 1.0)])
