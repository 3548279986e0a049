"""The table of internal resonances, and the division of motions between the directions.

The source: "an internal resonance occurs when the ratio of at least two of the natural frequencies is close to a ratio
of two positive integers" (paper section 5.1).
"""

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import gcd, sqrt

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.result import FrequencyRow, InternalResonanceRow

LARGEST_INTEGER = 3  # a cubic load by itself excites no ratio of higher order
_INTEGERS = range(1, LARGEST_INTEGER + 1)
_RATIOS = sorted(((p, q) for p in _INTEGERS for q in _INTEGERS if gcd(p, q) == 1), key=lambda pair: pair[0] / pair[1])
# The limit between neighbouring ratios is their geometric mean, which differs from both by the same factor.
_LIMITS = [sqrt(p * r / (q * s)) for (p, q), (r, s) in pairwise(_RATIOS)]


def internal_resonance_rows(frequencies: Sequence[FrequencyRow]) -> tuple[InternalResonanceRow, ...]:
    """Return the ratios of the three frequencies of each model and number of loops, as far as they exist.

    Parameters
    ----------
    frequencies : sequence of FrequencyRow
        Of one line.

    Returns
    -------
    tuple of InternalResonanceRow
        Three for each row of frequencies: horizontal to vertical, torsional to vertical, torsional to horizontal.
    """
    return tuple(row for frequency in frequencies for row in _pairs(frequency))


def _pairs(row: FrequencyRow) -> Iterator[InternalResonanceRow]:
    vertical, horizontal, torsional = row.vertical_hz, row.horizontal_hz, row.torsional_hz
    for directions, above, below in (
        ("horizontal:vertical", horizontal, vertical),
        ("torsional:vertical", torsional, vertical),
        ("torsional:horizontal", torsional, horizontal),
    ):
        if below is not None and above is not None:
            ratio = above / below
            p, q = nearest_ratio(ratio)
            yield InternalResonanceRow(row.model, row.loops, directions, ratio, f"{p}:{q}", ratio * q / p - 1.0)


def nearest_ratio(ratio: float) -> tuple[int, int]:
    """Return the p and q up to `LARGEST_INTEGER` whose ratio p/q differs least from a positive number, relatively."""
    return _RATIOS[bisect_left(_LIMITS, ratio)]


def motion_shares(mass: FloatArray, coefficients: FloatArray, direction: IntArray) -> FloatArray:
    """Return the shares of the directions in the mean kinetic energy of cycles.

    Parameters
    ----------
    mass : (cycles, m)
        Diagonal of the mass matrix: coupling by eccentric ice belongs to no direction and is left out.
    coefficients : (cycles, m, 2 H + 1)
        Fourier series of the coordinates: mean, cos 1, sin 1, ...
    direction : (m,)
        0 vertical, 1 horizontal, 2 torsional.

    Returns
    -------
    (cycles, 3)
        Vertical, horizontal and torsional share; they add up to 1.
    """
    order = np.repeat(np.arange(1, coefficients.shape[-1] // 2 + 1), 2)
    return divide_by_direction(mass * ((order * coefficients[..., 1:]) ** 2).sum(axis=-1), direction)


def divide_by_direction(energy: FloatArray, direction: IntArray) -> FloatArray:
    """Return the shares of the directions in the energy of coordinates (motions, m): (motions, 3), adding up to 1."""
    by_direction = energy @ np.eye(3)[direction]
    return np.asarray(by_direction / by_direction.sum(axis=-1, keepdims=True))
