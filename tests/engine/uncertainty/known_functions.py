"""Functions of independent uniform variables whose Sobol indices are known in closed form."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray
from engine.uncertainty.inputs import Interval
from engine.uncertainty.sampling import Samples, sobol_samples


@dataclass(frozen=True)
class KnownFunction:
    """A function of (samples, inputs) in the unit cube, with its first-order and total indices."""

    of: Callable[[FloatArray], FloatArray]
    first_order: FloatArray
    total: FloatArray

    def samples(self, count: int, seed: int) -> Samples:
        inputs = [Interval(f"x{i:02}", 0.5, 0.0, 1.0) for i in range(self.total.size)]
        return sobol_samples(inputs, count, seed)


def additive(weights: list[float]) -> KnownFunction:
    """Return a weighted sum: the indices are the squares of the weights over their sum."""
    factors = np.array(weights)
    shares = factors**2 / np.sum(factors**2)
    return KnownFunction(lambda unit: unit @ factors, shares, shares)


def ishigami(a: float = 7.0, b: float = 0.1) -> KnownFunction:
    """Return the function of Ishigami and Homma 1990, sin x + a sin^2 y + b z^4 sin x, each variable on (-pi, pi)."""
    alone = (0.5 * (1.0 + b * np.pi**4 / 5.0) ** 2, a**2 / 8.0, 0.0)
    together = b**2 * np.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)
    whole = sum(alone) + together

    def of(unit: FloatArray) -> FloatArray:
        x, y, z = np.pi * (2.0 * unit - 1.0).T
        return np.asarray(np.sin(x) + a * np.sin(y) ** 2 + b * z**4 * np.sin(x))

    first = np.array(alone) / whole
    return KnownFunction(of, first, first + np.array([together, 0.0, together]) / whole)


def sobol_g(a: list[float]) -> KnownFunction:
    """Return the product of (|4 x - 2| + a) / (1 + a): Saltelli and Sobol 1995."""
    offsets = np.array(a)
    own = 1.0 / 3.0 / (1.0 + offsets) ** 2
    whole = np.prod(1.0 + own) - 1.0

    def of(unit: FloatArray) -> FloatArray:
        return np.asarray(np.prod((np.abs(4.0 * unit - 2.0) + offsets) / (1.0 + offsets), axis=1))

    return KnownFunction(of, own / whole, own * np.prod(1.0 + own) / (1.0 + own) / whole)
