"""Distributions of assumed values."""

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.outcome import InvalidSpec
from engine.uncertainty.inputs import Choice, Interval

EVEN: FloatArray = np.linspace(0.0005, 0.9995, 1000)


def test_values_are_uniform_over_a_narrow_range() -> None:
    one = Interval("wind.air_density", 1.3, 1.05, 1.4)
    assert not one.logarithmic
    np.testing.assert_allclose(one.at(np.array([0.0, 0.5, 1.0])), [1.05, 1.225, 1.4])
    assert np.var(one.at(EVEN)) == pytest.approx(0.35**2 / 12.0, rel=1e-5)


def test_logarithms_are_uniform_where_the_range_spans_a_factor_of_two() -> None:
    one = Interval("damping.vertical_ratio", 0.001, 0.0005, 0.005)
    assert one.logarithmic
    np.testing.assert_allclose(one.at(np.array([0.0, 0.5, 1.0])), np.array([0.0005, 0.0005 * 10.0**0.5, 0.005]))
    assert Interval("a", 1.5, 1.0, 2.0).logarithmic
    assert not Interval("a", 1.5, 1.0, 1.999).logarithmic


def test_what_may_be_negative_or_has_no_factors_is_uniform() -> None:
    assert not Interval("ice.aerodynamics_at_rest.vertical", 0.0, -0.3, 0.3).logarithmic
    assert not Interval("span.everyday.temperature", 15.0, 5.0, 25.0, has_factors=False).logarithmic


def test_values_never_leave_their_range_by_rounding() -> None:
    one = Interval("a", 0.3, 0.1, 0.7)
    assert one.at(np.array([1.0])).item() == 0.7
    assert one.at(np.array([0.0])).item() == 0.1


@pytest.mark.parametrize(("value", "lowest", "highest"), [(2.0, 0.0, 1.0), (1.0, 1.0, 1.0), (0.5, 1.0, 0.0)])
def test_a_range_holds_its_value_and_is_not_empty(value: float, lowest: float, highest: float) -> None:
    with pytest.raises(InvalidSpec, match="must lie between"):
        Interval("a", value, lowest, highest)


def test_choices_come_as_often_as_their_weights_say() -> None:
    one = Choice("ice.shape", 0.0, (1.0, 2.0, 1.0))
    assert np.bincount(one.number(EVEN)).tolist() == [250, 500, 250]
    assert one.shares == (0.25, 0.5, 0.25)
    assert one.at(np.array([0.0, 0.24, 0.26, 1.0])).tolist() == [0.0, 0.0, 1.0, 2.0]


def test_a_choice_has_two_possibilities_with_positive_weights_and_one_that_holds() -> None:
    with pytest.raises(InvalidSpec, match="two possibilities"):
        Choice("a", 0.0, (1.0,))
    with pytest.raises(InvalidSpec, match="must be positive"):
        Choice("a", 0.0, (1.0, 0.0))
    with pytest.raises(InvalidSpec, match="must be one of"):
        Choice("a", 2.0, (1.0, 1.0))
