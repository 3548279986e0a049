"""The extremes of samples over one period, between the samples too."""

import numpy as np

from engine.arrays import FloatArray, IntArray


def extremes(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the smallest and the largest of samples (..., samples) over one period, by parabolas: (...) each."""
    flat = values.reshape(-1, values.shape[-1])
    smallest, largest = _vertices(flat, flat.argmin(axis=-1)), _vertices(flat, flat.argmax(axis=-1))
    return smallest.reshape(values.shape[:-1]), largest.reshape(values.shape[:-1])


def _vertices(values: FloatArray, at: IntArray) -> FloatArray:
    """Return the vertex of the parabola through a sample (k,), an extreme one, and its neighbours: (k,)."""
    every, samples = np.arange(at.size), values.shape[-1]
    left, middle, right = (values[every, (at + shift) % samples] for shift in (-1, 0, 1))
    bend = left - 2.0 * middle + right
    return np.asarray(middle - np.where(bend == 0.0, 0.0, (right - left) ** 2 / np.where(bend == 0.0, 1.0, 8.0 * bend)))
