"""Extremes between the samples of a period against those of known waves."""

import numpy as np
import pytest

from engine.numerics.extremes import extremes

TAU = 2.0 * np.pi * np.arange(64) / 64


def test_extremes_lie_between_the_samples() -> None:
    phases = np.linspace(0.0, 0.1, 6).reshape(2, 3, 1)
    smallest, largest = extremes(3.0 + 0.5 * np.cos(TAU - phases))
    assert smallest == pytest.approx(np.full((2, 3), 2.5), abs=1e-6)
    assert largest == pytest.approx(np.full((2, 3), 3.5), abs=1e-6)


def test_the_period_closes() -> None:
    values = np.cos(TAU - 0.03)
    for turned, plain in zip(extremes(np.roll(values, 1)), extremes(values), strict=True):
        assert turned == pytest.approx(plain, rel=1e-15)


def test_what_is_constant_has_one_extreme() -> None:
    smallest, largest = extremes(np.full((2, 8), 0.1))
    assert (smallest == 0.1).all()
    assert (largest == 0.1).all()
