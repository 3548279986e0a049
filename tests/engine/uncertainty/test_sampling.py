"""Samples depend on the inputs and the seed, and fill the ranges evenly."""

import numpy as np

from engine.uncertainty.inputs import Choice, Interval
from engine.uncertainty.sampling import sobol_samples

INPUTS = (Interval("b", 1.0, 0.5, 2.0), Choice("c", 0.0, (1.0, 1.0)), Interval("a", 0.0, -1.0, 1.0))


def test_samples_repeat_for_a_seed_and_differ_for_another() -> None:
    first = sobol_samples(INPUTS, 64, 1)
    assert sobol_samples(INPUTS, 64, 1).chosen() == first.chosen()
    assert sobol_samples(INPUTS, 64, 2).chosen() != first.chosen()


def test_the_order_of_the_inputs_changes_nothing() -> None:
    assert sobol_samples(tuple(reversed(INPUTS)), 16, 1).chosen() == sobol_samples(INPUTS, 16, 1).chosen()


def test_more_samples_begin_with_the_same_ones() -> None:
    assert sobol_samples(INPUTS, 100, 1).chosen()[:40] == sobol_samples(INPUTS, 40, 1).chosen()


def test_a_power_of_two_puts_one_sample_into_each_interval_of_every_input() -> None:
    unit = sobol_samples(INPUTS, 64, 3).unit
    for column in unit.T:
        assert sorted(np.floor(64.0 * column).astype(int).tolist()) == list(range(64))


def test_chosen_values_lie_in_their_ranges() -> None:
    for values in sobol_samples(INPUTS, 33, 1).chosen():
        assert set(values) == {"a", "b", "c"}
        assert -1.0 <= values["a"] <= 1.0
        assert 0.5 <= values["b"] <= 2.0
        assert values["c"] in (0.0, 1.0)


def test_nothing_to_sample_gives_no_values() -> None:
    assert sobol_samples((), 3, 1).chosen() == []
    assert sobol_samples(INPUTS, 0, 1).chosen() == []
