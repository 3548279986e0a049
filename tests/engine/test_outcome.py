"""How points of an analysis end: what fails has its row and its reason, and stops nothing else."""

from dataclasses import replace

import pytest

from engine.outcome import Outcome, Stability
from engine.spec import Aerodynamics, Analysis, Line
from tests.builders import run, source_line

BOTH = Analysis(loops=(1, 2), wind_speeds=(2.0, 4.0, 6.0), finite_element_loops=(1, 2))


def linear_line() -> Line:
    """Return the twin bundle under a load without quadratic and cubic terms: what grows grows without end."""
    line = source_line(2)
    load = Aerodynamics((-0.1667, 0.0, 0.0), (0.8605, 0.0, 0.0), (-0.7272, 0.0, 0.0))
    return replace(line, ice=replace(line.ice, aerodynamics=load))


def test_every_outcome_has_its_word_and_its_sentence() -> None:
    words = ["converged", "no_convergence", "statically_unstable", "outside_fit", "beyond_data", "no_bounded_motion"]
    words += ["slack", "limit_reached"]
    assert [outcome.value for outcome in Outcome] == words
    sentences = [outcome.sentence for outcome in Outcome]
    assert len(set(sentences)) == len(Outcome)
    assert all(len(sentence.split()) > 3 and sentence.endswith(".") for sentence in sentences)


def test_a_wind_speed_without_bounded_motion_has_its_row_and_stops_no_other() -> None:
    result = run(linear_line(), BOTH)
    rows = result.limit_cycles
    lost = [row for row in rows if row.outcome is Outcome.NO_BOUNDED_MOTION]
    assert any("no motion is bounded" in warning for warning in result.warnings)
    assert {row.wind_speed_m_per_s for row in lost} == {4.0, 6.0}
    assert {row.model for row in lost} == set(BOTH.models)
    assert {row.stability for row in lost} == {Stability.UNKNOWN}
    assert {(row.vertical_m, row.frequency_hz, row.vertical_share) for row in lost} == {(None, None, None)}
    for model in BOTH.models:
        for loops in BOTH.loops:
            rest = [r for r in rows if (r.model, r.loops, r.kind) == (model, loops, "equilibrium")]
            assert [r.wind_speed_m_per_s for r in rest] == [2.0, 4.0, 6.0]
            assert [r.stability for r in rest] == [Stability.STABLE, Stability.UNSTABLE, Stability.UNSTABLE]
            assert {r.outcome for r in rest} == {Outcome.CONVERGED}


def test_the_critical_speeds_stand_though_no_cycle_does() -> None:
    linear, cubic = (run(line, BOTH).critical_wind_speeds for line in (linear_line(), source_line(2)))
    assert [row.wind_speed_m_per_s for row in linear] == pytest.approx([row.wind_speed_m_per_s for row in cubic])
