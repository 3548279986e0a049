"""Scrambled Sobol samples of everything that is uncertain."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import qmc

from engine.arrays import FloatArray
from engine.uncertainty.inputs import Uncertain


@dataclass(frozen=True, slots=True)
class Samples:
    """Samples of uncertain inputs: unit (samples, inputs), the position of each value in its distribution, 0 to 1."""

    inputs: tuple[Uncertain, ...]
    unit: FloatArray

    def chosen(self) -> list[dict[str, float]]:
        """Return the values of each sample by path."""
        columns = [one.at(self.unit[:, i]).tolist() for i, one in enumerate(self.inputs)]
        paths = [one.path for one in self.inputs]
        return [dict(zip(paths, values, strict=True)) for values in zip(*columns, strict=True)]


def sobol_samples(inputs: Sequence[Uncertain], count: int, seed: int) -> Samples:
    """Return the first samples of a scrambled Sobol sequence, one dimension for each input in the order of their paths.

    They depend on the inputs and the seed alone, and a longer sequence begins with a shorter one.

    Parameters
    ----------
    inputs : sequence of Uncertain
    count : int
        Number of samples; a power of two fills the ranges most evenly.
    seed : int
    """
    ordered = tuple(sorted(inputs, key=lambda one: one.path))
    if not ordered or count < 1:
        return Samples(ordered, np.empty((max(count, 0), len(ordered))))
    sequence = qmc.Sobol(len(ordered), scramble=True, rng=np.random.default_rng(seed))
    power = (count - 1).bit_length()
    return Samples(ordered, np.asarray(sequence.random_base2(power)[:count], dtype=np.float64))
