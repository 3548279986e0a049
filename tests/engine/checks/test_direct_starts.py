"""Cycles are found from where direct integration arrives, without any branch or formula."""

from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.checks.direct_starts import WINDS, direct_starts
from engine.cycles import search
from engine.cycles.harmonic_balance import Orbits, half_peak_to_peak, select
from engine.cycles.known_cycles import Starts, solve_starts
from engine.cycles.resolution import resolved_stability
from engine.cycles.search import Cycles, DirectIntegration, find_cycles
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel, take
from engine.outcome import Stability
from engine.spec import Check, Model
from tests.builders import hybrid, only, run, source_line

TRIPLE = source_line(3, torsional_ratio=0.0308)
WIND = np.array([12.0])


def reached(model: ReducedModel, winds: FloatArray) -> Orbits:
    """Return the stable cycles that Newton's method finds from where direct integration arrives."""
    starts, good = solve_starts(model, direct_starts(model, winds, 5))
    member, orbits = starts.member[good], select(starts.orbits, np.flatnonzero(good))
    orbits, judged, kept, _ = resolved_stability(model, member, orbits)
    return select(orbits, np.flatnonzero(kept & (judged.stability == Stability.STABLE)))


def test_what_is_reached_are_the_coexisting_cycles() -> None:
    found = half_peak_to_peak(reached(hybrid(TRIPLE, 2), WIND).coefficients)[:, 1]
    result = run(TRIPLE, only(Model.HYBRID, loops=(2,), wind_speeds=(12.0,)))
    expected = np.array([row.horizontal_m for row in result.limit_cycles if row.stability == Stability.STABLE])
    assert expected.size == 2
    assert found.size >= 3
    # The largest amplitude of a shape is not quite 1 where it is observed.
    assert np.abs(found[:, None] / expected - 1.0).min(axis=1).max() < 0.01


def test_only_a_few_wind_speeds_are_tried_and_what_comes_to_rest_is_no_guess() -> None:
    winds = np.array([1.0, 1.2, 1.4, 1.6, 1.8, 6.0])
    starts = direct_starts(hybrid(source_line(2)), winds, 5)
    assert 0 < np.unique(starts.wind).size <= WINDS
    judged = reached(hybrid(source_line(2)), winds)
    assert set(judged.wind_speed.tolist()) == {6.0}


def test_no_wind_speeds_and_no_stable_models_give_no_guesses() -> None:
    model = hybrid(TRIPLE)
    assert direct_starts(model, np.zeros(0), 5).member.size == 0
    unstable = replace(model, statically_unstable=np.ones(1, dtype=np.bool_))
    assert direct_starts(unstable, WIND, 5).member.size == 0


def test_a_statically_unstable_model_of_the_stack_changes_nothing() -> None:
    alone = hybrid(source_line(2))
    pair = take(alone, np.zeros(2, dtype=np.intp))
    stiffness = pair.stiffness.copy()
    stiffness[0] *= -1.0
    pair = replace(pair, stiffness=stiffness, statically_unstable=np.array([True, False]))
    found, expected = (direct_starts(model, np.array([6.0]), 3) for model in (pair, alone))
    assert set(found.member.tolist()) == {1}
    assert found.orbits.coefficients == pytest.approx(expected.orbits.coefficients, abs=1e-9)


def test_a_cycle_that_nothing_else_leads_to_is_found_and_followed(monkeypatch: pytest.MonkeyPatch) -> None:
    model, winds = hybrid(TRIPLE, 2), np.array([10.0, 11.0, 12.0])
    nothing = Starts(
        np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp), Orbits(np.zeros((0, 3, 11)), winds[:0], winds[:0])
    )
    none = critical_wind_speeds(model, 0.1)
    monkeypatch.setattr(search, "energy_starts", lambda *_: nothing)

    def found(integrated: Starts | None) -> Cycles:
        return find_cycles(model, none, winds, nothing, 5, DirectIntegration(integrated))

    assert found(None).member.size == 0
    alone = found(direct_starts(model, winds, 5))
    assert "direct_integration" in alone.found_by
    assert set(alone.wind[alone.floquet.stability == Stability.STABLE].tolist()) == {0, 1, 2}
    unfollowed = solve_starts(model, direct_starts(model, winds, 5))[1].sum()
    assert len(alone.branch_sets) >= 2, "the branches of what was found were not followed"
    assert unfollowed > alone.found_by.count("direct_integration"), "equal cycles were not taken for one"


def test_a_checked_analysis_has_the_rows_of_an_unchecked_one() -> None:
    asked = only(Model.HYBRID, loops=(1,), wind_speeds=(4.0, 6.0))
    plain, checked = (run(source_line(3), replace(asked, check=check)) for check in Check)
    assert [replace(row, direct_difference=None) for row in checked.limit_cycles] == list(plain.limit_cycles)
    differences = [row.direct_difference for row in checked.limit_cycles if row.kind == "periodic"]
    assert len(differences) == 2
    assert all(value is not None and abs(value) < 1e-3 for value in differences)
