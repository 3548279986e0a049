"""What a sample does is read off its result; what is not known never counts as rest."""

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cache

import pytest

from engine.outcome import Outcome, Stability
from engine.report.verdict import verdict
from engine.result import LimitCycleRow, Result
from engine.spec import Model
from engine.uncertainty.outcomes import SampleOutcome, State, sample_outcome
from tests.builders import only, run
from tests.engine.uncertainty.den_hartog_line import ASKED, WINDS, line_of, onset


@cache
def analysed() -> Result:
    return run(line_of({}), ASKED)


def changed(rest: Mapping[str, object], motion: Mapping[str, object] | None, wind: float) -> SampleOutcome:
    """Return the outcome with other rows at one wind speed: the equilibrium's, and the motions' (None: left out)."""
    rows: list[LimitCycleRow] = []
    for row in analysed().limit_cycles:
        change = rest if row.kind == "equilibrium" else motion
        if row.wind_speed_m_per_s != wind:
            rows.append(row)
        elif change is not None:
            rows.append(replace(row, **change))  # type: ignore[arg-type]
    result = replace(analysed(), limit_cycles=tuple(rows))
    return sample_outcome(replace(result, verdict=(verdict(result, line_of({}), ASKED),)), WINDS)


def test_a_span_rests_below_its_onset_and_gallops_above() -> None:
    found = sample_outcome(analysed(), WINDS)
    assert found.onset == pytest.approx(onset(0.004, 1.2929, 1.0), rel=1e-6)
    assert WINDS[0] < found.onset < WINDS[2]
    assert found.winds[0].state is State.RESTS
    assert found.winds[0].amplitudes == (0.0, 0.0, 0.0)
    assert found.winds[2].state is State.GALLOPS
    (row,) = [r for r in analysed().limit_cycles if r.kind == "periodic" and r.wind_speed_m_per_s == WINDS[2]]
    assert found.winds[2].amplitudes == (row.vertical_m, row.horizontal_m, row.torsional_rad)
    assert found.overall.state is State.GALLOPS
    assert found.overall.amplitudes == found.winds[2].amplitudes


@pytest.mark.parametrize(
    ("rest", "motion"),
    [
        ({"vertical_m": None, "outcome": Outcome.NO_BOUNDED_MOTION}, None),  # integration found no bound
        ({}, None),  # an unstable rest without a stable motion
        ({"vertical_m": None, "outcome": Outcome.NO_CONVERGENCE}, {}),  # another number of loops may move farther
    ],
)
def test_a_size_that_is_not_known_is_larger_than_any(
    rest: Mapping[str, object], motion: Mapping[str, object] | None
) -> None:
    found = changed(rest, motion, WINDS[2])
    assert found.winds[2].state is State.SIZE_UNKNOWN
    assert found.winds[2].amplitudes == (math.inf, math.inf, math.inf)
    assert found.winds[0].state is State.RESTS
    assert found.overall.state is State.SIZE_UNKNOWN
    assert found.overall.amplitudes[0] == math.inf


def test_what_is_not_known_is_no_rest() -> None:
    unknown: list[dict[str, object]] = [
        {"stability": Stability.UNKNOWN},
        {"vertical_m": None, "outcome": Outcome.NO_CONVERGENCE},
    ]
    for rest in unknown:
        found = changed(rest, None, WINDS[0])
        assert found.winds[0].state is State.UNKNOWN
        assert math.isnan(found.winds[0].amplitudes[0])
    # A divergence alone starts no motion, yet the span does not stay where it is.
    found = changed({"stability": Stability.UNSTABLE}, None, WINDS[0])
    assert found.winds[0].state is State.UNKNOWN


def test_a_static_state_that_does_not_stand_has_a_column_of_its_own() -> None:
    rows = tuple(
        replace(row, vertical_m=None, stability=Stability.UNKNOWN, outcome=Outcome.STATICALLY_UNSTABLE)
        for row in analysed().limit_cycles
        if row.kind == "equilibrium"
    )
    result = replace(analysed(), limit_cycles=rows, critical_wind_speeds=())
    found = sample_outcome(replace(result, verdict=(verdict(result, line_of({}), ASKED),)), WINDS)
    assert {wind.state for wind in found.winds} == {State.STATICALLY_UNSTABLE}
    assert found.overall.state is State.STATICALLY_UNSTABLE
    assert math.isnan(found.onset)


def test_motions_beyond_the_data_are_marked() -> None:
    assert not sample_outcome(analysed(), WINDS).overall.beyond_data
    found = changed({}, {"outcome": Outcome.OUTSIDE_FIT}, WINDS[2])
    assert found.winds[2].state is State.GALLOPS
    assert found.winds[2].beyond_data
    assert found.overall.beyond_data


def test_without_wind_speeds_the_onset_alone_decides() -> None:
    found = sample_outcome(run(line_of({}), only(Model.HYBRID, loops=(1,), wind_speeds=())), ())
    assert (found.winds, found.overall.state) == ((), State.SIZE_UNKNOWN)
