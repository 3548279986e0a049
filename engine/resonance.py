"""Internal resonance: how near frequencies are to small whole ratios, and how motions divide between directions.

The source: "an internal resonance occurs when the ratio of at least two of the natural frequencies is close to a ratio
of two positive integers" (paper section 5.1).
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import combinations
from math import log

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.result import FrequencyRow, InternalResonanceRow

LARGEST_INTEGER = 3  # a cubic load excites no ratio of a higher order by itself
_RATIOS = sorted({Fraction(p, q) for p in range(1, LARGEST_INTEGER + 1) for q in range(1, LARGEST_INTEGER + 1)})


def resonance_rows(frequencies: Sequence[FrequencyRow]) -> tuple[InternalResonanceRow, ...]:
    """Write the ratios of the three frequencies of each model and number of loops, as far as they exist.

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
    named = (("vertical", row.vertical_hz), ("horizontal", row.horizontal_hz), ("torsional", row.torsional_hz))
    for (lower, below), (upper, above) in combinations(named, 2):
        if below is not None and above is not None:
            ratio = above / below
            nearest = nearest_ratio(ratio)
            yield InternalResonanceRow(
                model=row.model,
                loops=row.loops,
                directions=f"{upper}:{lower}",
                frequency_ratio=ratio,
                nearest_ratio=f"{nearest.numerator}:{nearest.denominator}",
                detuning=ratio / float(nearest) - 1.0,
            )


def nearest_ratio(ratio: float) -> Fraction:
    """Return the ratio of integers up to `LARGEST_INTEGER` that differs least from a positive number, relatively."""
    return min(_RATIOS, key=lambda candidate: abs(log(ratio / float(candidate))))


def motion_shares(mass: FloatArray, coefficients: FloatArray, direction: IntArray) -> FloatArray:
    """Divide the mean kinetic energy of cycles between the directions.

    Parameters
    ----------
    mass : (cycles, m)
        Diagonal of the mass matrix: what eccentric ice couples belongs to no direction and is left out.
    coefficients : (cycles, m, 2 H + 1)
        Fourier series of the co-ordinates: mean, cos 1, sin 1, ...
    direction : (m,)
        0 vertical, 1 horizontal, 2 torsional.

    Returns
    -------
    (cycles, 3)
        Vertical, horizontal and torsional share; they add up to 1.
    """
    order = np.repeat(np.arange(1, coefficients.shape[-1] // 2 + 1), 2)
    energy = mass * ((order * coefficients[..., 1:]) ** 2).sum(axis=-1)
    by_direction = energy @ np.eye(3)[direction]
    return np.asarray(by_direction / by_direction.sum(axis=-1, keepdims=True))
