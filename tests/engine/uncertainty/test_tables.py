"""Rows from outcomes that are made up."""

import math

import numpy as np
import pytest

from engine.spec import Analysis, Uncertainty
from engine.uncertainty.inputs import Choice, Interval
from engine.uncertainty.outcomes import AtWind, SampleOutcome, State, without_answer
from engine.uncertainty.sampling import sobol_samples
from engine.uncertainty.tables import ends, sensitivity_rows, uncertainty_rows

ASKED = Uncertainty(64, 7)
INPUTS = (Choice("b.shape", 1.0, (1.0, 1.0, 1.0)), Interval("a", 1.5, 1.0, 4.0))


def galloping(onset: float, size: float, state: State = State.GALLOPS) -> SampleOutcome:
    wind = AtWind(state, (size, 0.1 * size, 0.01 * size))
    return SampleOutcome(onset, (wind,), wind)


REST = SampleOutcome(math.inf, (AtWind(State.RESTS, (0.0, 0.0, 0.0)),), AtWind(State.RESTS, (0.0, 0.0, 0.0)))


def test_every_sample_is_in_one_column() -> None:
    outcomes = [
        galloping(3.0, 1.0),
        galloping(4.0, 2.0),
        galloping(2.0, math.inf, State.SIZE_UNKNOWN),
        REST,
        *(without_answer(state, 1) for state in (State.UNKNOWN, State.STATICALLY_UNSTABLE, State.IMPOSSIBLE)),
    ]
    overall, at_wind = uncertainty_rows(outcomes, (8.0,), Uncertainty(7, 3))
    assert (overall.wind_speed_m_per_s, at_wind.wind_speed_m_per_s) == (None, 8.0)
    for row in (overall, at_wind):
        counts = (row.gallops, row.size_unknown, row.rests, row.unknown, row.statically_unstable, row.impossible)
        assert counts == (2, 1, 1, 1, 1, 1)
        assert (row.samples, row.seed) == (7, 3)
        assert row.probability == 0.75
        assert row.onset_p50_m_per_s == 3.5  # of 2, 3, 4 and none
        assert row.onset_p95_m_per_s is None
        assert row.vertical_p50_m == 1.5  # of 0, 1, 2 and without bound
        assert row.horizontal_p50_m == pytest.approx(0.15)
        assert row.torsional_p50_rad == pytest.approx(0.015)
        assert row.vertical_p95_m is None


def test_the_ends_of_a_choice_are_all_its_possibilities() -> None:
    assert ends(INPUTS) == [[{"b.shape": 0.0}, {"b.shape": 1.0}, {"b.shape": 2.0}], [{"a": 1.0}, {"a": 4.0}]]


def test_indices_are_those_of_the_logarithm_of_the_onset_and_of_the_amplitude() -> None:
    samples = sobol_samples(INPUTS, 64, 1)
    outcomes = [galloping(2.0 * values["a"], 1.0 + values["b.shape"]) for values in samples.chosen()]
    at_ends = [galloping(2.0, 1.5), galloping(8.0, 1.4), *(galloping(3.0, size) for size in (2.0, math.nan, 1.0))]
    number, shape = sensitivity_rows(samples, outcomes, at_ends, Analysis(), ASKED)
    assert (number.path, number.distribution, number.lowest, number.highest) == ("a", "log_uniform", 1.0, 4.0)
    assert (shape.path, shape.distribution, shape.lowest, shape.highest) == ("b.shape", "choice", None, None)
    assert number.onset_total == pytest.approx(1.0, abs=1e-9)
    assert number.amplitude_total == pytest.approx(0.0, abs=1e-9)
    assert shape.amplitude_first_order == pytest.approx(1.0, abs=1e-9)
    assert (number.onset_at_lowest_m_per_s, number.onset_at_highest_m_per_s) == (2.0, 8.0)
    assert (number.vertical_at_lowest_m, number.vertical_at_highest_m) == (1.5, 1.4)
    assert (shape.vertical_at_lowest_m, shape.vertical_at_highest_m) == (1.0, 2.0)
    assert (number.onset_samples, number.amplitude_samples) == (64, 64)


def test_indices_that_the_samples_do_not_tell_are_null() -> None:
    samples = sobol_samples(INPUTS, 64, 1)
    noise = np.random.default_rng(1).uniform(1.0, 9.0, 64)
    outcomes = [galloping(onset, 1.0) for onset in noise]
    for row in sensitivity_rows(samples, outcomes, [galloping(1.0, 1.0)] * 5, Analysis(), ASKED):
        assert row.onset_explained is not None
        assert row.onset_explained < 0.5
        assert (row.onset_first_order, row.onset_total, row.onset_total_lowest) == (None, None, None)
        assert (row.amplitude_total, row.amplitude_explained) == (None, None)  # all of one size: nothing to share


def test_samples_without_a_number_leave_the_indices() -> None:
    samples = sobol_samples(INPUTS, 64, 1)
    outcomes = [
        galloping(2.0 * values["a"], math.inf, State.SIZE_UNKNOWN) if i % 4 == 0 else galloping(2.0 * values["a"], 1.0)
        for i, values in enumerate(samples.chosen())
    ]
    outcomes[5] = without_answer(State.UNKNOWN, 1)
    outcomes[6] = REST  # its onset counts as the limit
    row, _ = sensitivity_rows(samples, outcomes, [galloping(1.0, 1.0)] * 5, Analysis(critical_wind_limit=40.0), ASKED)
    assert (row.onset_samples, row.amplitude_samples) == (63, 47)
