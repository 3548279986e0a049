"""Estimates hold their value within their range."""

import math

import pytest

from engine.known.estimate import Estimate
from engine.outcome import InvalidSpec


@pytest.mark.parametrize(("lowest", "highest"), [(2.0, 3.0), (0.0, 0.5), (math.nan, 2.0), (0.0, math.inf)])
def test_a_value_outside_its_range_is_refused(lowest: float, highest: float) -> None:
    with pytest.raises(InvalidSpec, match=r"value must lie between the lowest and the highest .* got 1\.0"):
        Estimate(1.0, "m", lowest, highest, "assumed")
