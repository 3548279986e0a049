"""The whole analysis: progress, rows, stacks, and answers where nothing gallops or nothing holds."""

import math
from dataclasses import astuple, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from engine.analysis import analyse, analyse_stack
from engine.outcome import InvalidSpec, Outcome, Stability
from engine.progress import Progress, driven
from engine.result import LimitCycleRow, Result
from engine.spec import (
    AerodynamicModel,
    Aerodynamics,
    AirflowSpoiler,
    Analysis,
    BlowOut,
    Closure,
    DetuningPendulum,
    Ice,
    IceSegment,
    Line,
    LongitudinalInertia,
    Model,
    Spacer,
    Span,
    Stretching,
    Support,
    Supports,
    Wind,
)
from tests.builders import ICE_AT_40, random_line, run, source_line, stable_cycles
from tests.engine.motions import free_sections, relative_line

SHORT = Analysis(loops=(1, 2), wind_speeds=(5.0,))


def stacked(lines: list[Line], analysis: Analysis) -> tuple[list[Progress], list[Result]]:
    """Analyse a stack and keep the progress."""
    progress: list[Progress] = []
    results = driven(analyse_stack(lines, analysis), progress.append)
    return progress, results


def rows_of(result: Result) -> list[tuple[Any, ...]]:
    """Return every row as a tuple."""
    rows: list[Any] = [*result.frequencies, *result.critical_wind_speeds, *result.limit_cycles]
    return [astuple(row) for row in rows]


def test_progress_rises_from_0_to_1() -> None:
    progress, _ = stacked([source_line(2)], SHORT)
    fractions = [p.fraction for p in progress]
    assert fractions[0] == 0.0
    assert fractions[-1] == 1.0
    assert fractions == sorted(fractions)
    assert all(p.step for p in progress)


def test_stack_gives_the_rows_of_single_lines() -> None:
    divergent = replace(source_line(1), span=Span(200.0, horizontal_tension=30e3))
    lines = [source_line(2), divergent, source_line(3), source_line(1)]
    _, results = stacked(lines, SHORT)
    for line, together in zip(lines, results, strict=True):
        alone = run(line, SHORT)
        assert len(rows_of(together)) == len(rows_of(alone))
        for one, other in zip(rows_of(together), rows_of(alone), strict=True):
            # Rounding of the elastic stiffness, magnified by the 1:1 resonance; words must be equal.
            assert [x for x in one if not isinstance(x, float)] == [x for x in other if not isinstance(x, float)]
            numbers = [[x for x in row if isinstance(x, float)] for row in (one, other)]
            assert numbers[0] == pytest.approx(numbers[1], rel=1e-5, abs=1e-9)
        assert together.static == alone.static
        assert together.warnings == alone.warnings


def test_stack_of_unequal_meshes_is_refused() -> None:
    other = replace(source_line(2), span=replace(source_line(2).span, elements=12))
    with pytest.raises(InvalidSpec, match=r"span\.elements"):
        stacked([source_line(2), other], SHORT)


def test_line_that_cannot_answer_is_refused_before_anything_is_computed() -> None:
    with pytest.raises(InvalidSpec, match="loops"):
        next(analyse(source_line(2), Analysis(loops=(11,))), None)


def test_every_wind_speed_has_an_equilibrium_row_in_each_model_and_loop() -> None:
    result = run(source_line(1), Analysis(wind_speeds=(1.0, 5.0, 11.0)))
    keys = [(r.model, r.loops, r.wind_speed_m_per_s) for r in result.limit_cycles if r.kind == "equilibrium"]
    expected = [(m, k, w) for m in Model for k in (1, 2) for w in (1.0, 5.0, 11.0)]
    assert sorted(keys) == sorted(expected)


def test_single_conductor_gallops_between_onset_and_restabilization_only() -> None:
    analysis = Analysis(loops=(1,), models=(Model.HYBRID,), wind_speeds=(2.0, 5.0, 10.0, 11.0))
    result = run(source_line(1), analysis)
    stability = {r.wind_speed_m_per_s: r.stability for r in result.limit_cycles if r.kind == "equilibrium"}
    assert stability == {
        2.0: Stability.STABLE,
        5.0: Stability.UNSTABLE,
        10.0: Stability.UNSTABLE,
        11.0: Stability.STABLE,
    }
    assert [len(stable_cycles(result, loops=1, wind_speed=w)) for w in (2.0, 5.0)] == [0, 1]


def test_wind_without_galloping_is_an_answer() -> None:
    result = run(source_line(2), Analysis(wind_speeds=(0.5, 1.0)))
    assert {r.kind for r in result.limit_cycles} == {"equilibrium"}
    assert {r.stability for r in result.limit_cycles} == {Stability.STABLE}
    assert {r.outcome for r in result.limit_cycles} == {Outcome.CONVERGED}
    assert result.orbits == ()


def test_frequencies_do_not_depend_on_wind_or_closure() -> None:
    base = run(source_line(3), SHORT).frequencies
    assert run(source_line(3), replace(SHORT, wind_speeds=(9.0,), closure=Closure.PUBLISHED)).frequencies == base


def test_long_lists_of_winds_hold_the_rows_of_short_ones() -> None:
    analysis = Analysis(loops=(1,), models=(Model.HYBRID,), wind_speeds=(4.0, 4.5, 5.0, 5.5, 6.0))
    many = run(source_line(2), analysis)
    few = run(source_line(2), replace(analysis, wind_speeds=(6.0, 4.0, 6.0)))
    assert sorted({r.wind_speed_m_per_s for r in few.limit_cycles}) == [4.0, 6.0]
    for wind_speed in (4.0, 6.0):
        (one,), (other,) = (stable_cycles(x, loops=1, wind_speed=wind_speed) for x in (many, few))
        assert one.vertical_m == pytest.approx(other.vertical_m, rel=1e-6)


CHOICES = st.builds(
    Analysis,
    loops=st.sampled_from([(1,), (2,), (1, 2), (2, 3)]),
    models=st.sampled_from([(Model.HYBRID,), (Model.HYBRID, Model.FINITE_ELEMENT), (Model.FINITE_ELEMENT,)]),
    wind_speeds=st.lists(st.floats(0.5, 14.0), max_size=2).map(tuple),
    closure=st.sampled_from(list(Closure)),
    longitudinal_inertia=st.sampled_from(list(LongitudinalInertia)),
    harmonics=st.integers(1, 6),
    finite_element_loops=st.sampled_from([(1,), (1, 2), (1, 2, 3)]),
)


@settings(max_examples=50, suppress_health_check=[HealthCheck.too_slow])
@given(st.integers(0, 10**6), CHOICES)
def test_random_lines_always_get_plausible_rows(seed: int, analysis: Analysis) -> None:
    result = run(random_line(np.random.default_rng(seed)), analysis)
    plausible(result, analysis)


def plausible(result: Result, analysis: Analysis) -> None:
    """Check what holds for the rows of any line."""
    for row in rows_of(result):
        assert all(math.isfinite(x) for x in row if isinstance(x, float))
    for wind_speed in analysis.wind_speeds:
        assert {r.model for r in result.limit_cycles if r.wind_speed_m_per_s == wind_speed} == set(analysis.models)
    for cycle in result.limit_cycles:
        if cycle.kind == "periodic" and cycle.outcome is Outcome.CONVERGED:
            positive(cycle)
    for critical in result.critical_wind_speeds:
        assert 0.0 < critical.wind_speed_m_per_s <= analysis.critical_wind_limit
        assert (critical.frequency_hz > 0.0) == (critical.type == "oscillation")
        assert critical.unstable_pairs_after >= (1 if critical.crossing == "onset" else 0)
    for frequency in result.frequencies:
        if frequency.outcome is Outcome.CONVERGED:
            assert (
                min(frequency.vertical_hz or 0.0, frequency.horizontal_hz or 0.0, frequency.torsional_hz or 0.0) > 0.0
            )


def positive(row: LimitCycleRow) -> None:
    """Check that a cycle moves, and has a frequency, a branch and a place."""
    assert row.vertical_m is not None
    assert row.horizontal_m is not None
    assert row.torsional_rad is not None
    assert max(row.vertical_m, row.horizontal_m, row.torsional_rad) > 0.0
    assert min(row.vertical_m, row.horizontal_m, row.torsional_rad) >= 0.0
    assert row.frequency_hz is not None
    assert row.frequency_hz > 0.0
    assert row.branch is not None
    assert row.observed_at_m > 0.0


def everything() -> Line:
    """Return a line that uses every field of the specification at once."""
    at_rest = replace(ICE_AT_40, at_rest=(0.05, 1.0, 0.02), fitted_range=0.6)
    line = source_line(4)
    return replace(
        line,
        conductor=replace(line.conductor, axial_torsional_coupling=500.0),
        span=Span(140.0, sag=2.0, elements=12, level_difference=4.0),
        supports=Supports(
            left=Support(dead_end=True),
            right=Support(adjacent_span=220.0, insulator_length=1.5, insulator_weight=300.0),
        ),
        ice=Ice(at_rest, 1e-3, -1e-3, (IceSegment(5.0, 31.0, at_rest, 2e-3, 0.0, 2.6), IceSegment(31.0, 33.0))),
        wind=Wind(1.2, ((0.0, 0.7), (140.0, 1.3)), BlowOut(10.0, 1.0), yaw=0.3),
        devices=(
            Spacer(35.0, 6.0, 0.4),
            DetuningPendulum(70.0, 8.0, 0.3, 0.1),
            AirflowSpoiler(
                80.0, 100.0, Aerodynamics((0.5, 0.0, 1.0), (0.8, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0))
            ),
        ),
    )


@pytest.mark.parametrize("model", [AerodynamicModel.PUBLISHED, AerodynamicModel.RELATIVE_WIND])
def test_line_with_every_part_gets_plausible_rows(model: AerodynamicModel) -> None:
    analysis = Analysis(wind_speeds=(4.0, 8.0), aerodynamic_model=model)
    result = run(everything(), analysis)
    plausible(result, analysis)
    assert 2.0 < result.static.sag_m < 2.01  # given for still air; the wind stretches the span
    assert len(result.frequencies) == 4


def test_finite_element_model_gives_frequencies_alone() -> None:
    result = run(source_line(2), replace(Analysis(), finite_element_loops=()))
    assert {row.model for row in result.frequencies} == {Model.HYBRID, Model.FINITE_ELEMENT}
    assert {row.model for row in result.limit_cycles} == {Model.HYBRID}


def test_both_models_agree_on_two_stretched_loops_alone() -> None:
    """Neither has the vertical motion of one loop, so both need the relief coordinate."""
    line = relative_line(2)
    asked = Analysis(loops=(2,), finite_element_loops=(2,), wind_speeds=(10.0,))
    asked = replace(asked, aerodynamic_model=AerodynamicModel.RELATIVE_WIND, stretching=Stretching.INCLUDED)
    asked = replace(asked, longitudinal_inertia=LongitudinalInertia.CONDENSED)
    result = run(free_sections(line), asked)
    (hybrid,), (full,) = (stable_cycles(result, loops=2, wind_speed=10.0, model=model) for model in Model)
    for name in ("vertical_m", "horizontal_m", "torsional_rad", "frequency_hz"):
        assert getattr(full, name) == pytest.approx(getattr(hybrid, name), rel=1e-3)
    tensions = [(row.smallest_horizontal_n, row.largest_horizontal_n) for row in result.tensions]
    assert tensions[1] == pytest.approx(tensions[0], rel=1e-4)
