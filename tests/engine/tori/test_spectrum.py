"""Base lines of a spectrum: two lines of which every other one is a sum of multiples."""

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.tori.spectrum import base_lines
from engine.tori.two_frequency_balance import harmonic_lattice

PAIRS = harmonic_lattice((5, 4)).pairs


def strengths(**lines: float) -> FloatArray:
    found = np.full(len(PAIRS), 1e-9)
    for name, strength in lines.items():
        first, second = (int(number) for number in name[1:].split("_"))
        found[(PAIRS[:, 0] == first) & (PAIRS[:, 1] == second)] = strength
    return found


def test_a_multiple_is_no_base_however_strong() -> None:
    first, second = PAIRS[base_lines(strengths(_2_0=3.0, _1_0=2.0, _4_2=1.5, _1_1=1.0), PAIRS)].tolist()
    assert [first, second] == [[1, 0], [1, 1]]
    # 3 w + 2 W and w + W span all lines, 3 w + 2 W and w + 2 W only every fourth one
    first, second = PAIRS[base_lines(strengths(_3_2=3.0, _1_2=2.0, _1_1=1.0), PAIRS)].tolist()
    assert [first, second] == [[3, 2], [1, 1]]


@pytest.mark.parametrize("seed", range(200))
def test_every_spectrum_has_two_bases_that_span_it(seed: int) -> None:
    generator = np.random.default_rng(seed)
    first, second = generator.integers(1, 8, 2).tolist()
    pairs = harmonic_lattice((first, second)).pairs
    found = pairs[base_lines(generator.lognormal(0.0, 3.0, len(pairs)), pairs)]
    assert abs(round(float(np.linalg.det(found)))) == 1
