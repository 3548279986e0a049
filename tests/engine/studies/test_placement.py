"""The search for places against a scan by brute force, and what it does at its limits."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from engine.outcome import InvalidSpec
from engine.progress import Progress, driven
from engine.result import Result
from engine.spec import (
    Aerodynamics,
    AirflowSpoiler,
    Analysis,
    DetuningPendulum,
    DeviceEffect,
    Ice,
    Line,
    Model,
    Objective,
    PendulumChoice,
    Placement,
    Spacer,
    SpoilerChoice,
)
from engine.studies.placement import place
from tests.builders import ICE_AT_40, only, run, source_line, stable_cycles
from tests.engine.uncertainty.den_hartog_line import line_of as den_hartog_line

ONSET = only(Model.HYBRID, wind_speeds=(), loops=(1, 2))
CALM = Aerodynamics((0.0, 0.0, 0.0), (0.9, 0.0, 0.0), (0.0, 0.0, 0.0))


def placed(line: Line, analysis: Analysis, placement: Placement) -> tuple[Result, list[Progress]]:
    """Return the result of a search, and its progress."""
    progress: list[Progress] = []
    result = driven(place(line, analysis, placement), progress.append)
    return result, progress


def onset(line: Line, analysis: Analysis) -> float:
    """Return the lowest onset over all loops."""
    return min(r.wind_speed_m_per_s for r in run(line, analysis).critical_wind_speeds if r.crossing == "onset")


def test_a_pendulum_is_placed_as_well_as_a_scan_of_the_span_can() -> None:
    line = source_line(2)
    choice = PendulumChoice(1, (5.0, 120.0), (15.0, 15.0), (0.4, 0.4))
    result, _ = placed(line, ONSET, Placement(choice, generations=12, population=10))
    scan = [
        onset(replace(line, devices=(DetuningPendulum(float(x), 15.0, 0.4),)), ONSET)
        for x in np.linspace(5.0, 120.0, 16)
    ]
    (row,) = result.placements
    assert row.objective_value is not None
    assert row.objective_value >= max(scan) - 1e-3
    assert (row.mass_kg, row.arm_m, row.device) == (15.0, 0.4, 0)
    assert row.position_m is not None
    assert 5.0 <= row.position_m <= 120.0


def test_the_value_of_the_objective_is_that_of_the_line_with_the_devices() -> None:
    line = replace(source_line(2), devices=(Spacer(30.0, 4.0, 0.3),))
    choice = PendulumChoice(2, (10.0, 110.0), (2.0, 20.0), (0.2, 0.5), 0.1)
    result, _ = placed(line, ONSET, Placement(choice, generations=3, population=8, seed=5))
    first, second = result.placements
    assert [first.device, second.device] == [1, 2]
    assert (first.position_m or 0.0) <= (second.position_m or 0.0)
    pendulums = tuple(
        DetuningPendulum(r.position_m or 0.0, r.mass_kg or 0.0, r.arm_m or 0.0, 0.1) for r in result.placements
    )
    fitted = replace(line, devices=(*line.devices, *pendulums))
    assert first.objective_value == pytest.approx(onset(fitted, ONSET), rel=1e-9)
    effects = {row.loops: row for row in result.device_effects}
    assert min(e.critical_wind_speed_with_m_per_s or 0.0 for e in effects.values()) == first.objective_value
    assert min(e.critical_wind_speed_without_m_per_s or 0.0 for e in effects.values()) == pytest.approx(
        onset(line, ONSET), rel=1e-9
    )


def test_the_lowest_amplitude_is_sought_at_the_wind_speeds_asked_for() -> None:
    asked = only(Model.HYBRID, wind_speeds=(4.0,), loops=(2,))
    choice = PendulumChoice(1, (20.0, 50.0), (5.0, 20.0), (0.2, 0.5))
    result, _ = placed(source_line(2), asked, Placement(choice, Objective.LOWEST_AMPLITUDE, 4, 8))
    (row,) = result.placements
    sizes = [
        math.hypot(r.vertical_m or 0.0, r.horizontal_m or 0.0) for r in stable_cycles(result, loops=2, wind_speed=4.0)
    ]
    assert row.objective_value == pytest.approx(max(sizes), rel=1e-6)
    (effect,) = result.device_effects
    assert effect.amplitude_with_m == pytest.approx(sizes[0])
    assert effect.amplitude_without_m is not None
    assert row.objective_value is not None
    assert row.objective_value < 0.5 * effect.amplitude_without_m


def test_a_spoiler_goes_where_one_loop_moves_most() -> None:
    asked = only(Model.HYBRID, wind_speeds=(), loops=(1,))
    choice = SpoilerChoice(40.0, (0.0, 125.88), CALM)
    result, _ = placed(source_line(2), asked, Placement(choice, generations=10, population=8))
    (row,) = result.placements
    assert row.from_m is not None
    assert row.to_m == pytest.approx(row.from_m + 40.0)
    assert 0.5 * (row.from_m + (row.to_m or 0.0)) == pytest.approx(62.94, abs=5.0)


def test_progress_rises_and_the_same_seed_finds_the_same() -> None:
    choice = PendulumChoice(1, (5.0, 120.0), (5.0, 20.0), (0.4, 0.4))
    search = Placement(choice, generations=3, population=6, seed=7)
    first, progress = placed(source_line(1), ONSET, search)
    fractions = [step.fraction for step in progress]
    assert fractions == sorted(fractions)
    assert fractions[-1] == pytest.approx(1.0)
    assert sum("generation" in step.step for step in progress) >= 2
    assert placed(source_line(1), ONSET, search)[0].placements == first.placements


def test_where_no_candidate_is_statically_stable_no_device_is_placed() -> None:
    line = source_line(1)
    line = replace(line, span=replace(line.span, length=400.0), ice=Ice(ICE_AT_40, 4e-3, 0.0))
    choice = PendulumChoice(1, (1.0, 2.0), (0.1, 0.2), (0.1, 0.1))
    result, _ = placed(line, ONSET, Placement(choice, generations=2, population=5))
    assert result.placements == ()
    assert any("No improvement found" in warning for warning in result.warnings)


@pytest.mark.parametrize(
    ("line", "analysis", "placement", "field"),
    [
        (source_line(1), ONSET, Placement(PendulumChoice(1, (0.0, 130.0), (1.0, 2.0), (0.1, 0.2))), "choice.position"),
        (
            replace(source_line(1), devices=(AirflowSpoiler(1.0, 2.0, CALM),)),
            ONSET,
            Placement(SpoilerChoice(5.0, (0.0, 50.0), CALM)),
            "choice",
        ),
        (
            source_line(1),
            ONSET,
            Placement(PendulumChoice(1, (0.0, 100.0), (1.0, 2.0), (0.1, 0.2)), Objective.LOWEST_AMPLITUDE),
            "objective",
        ),
    ],
)
def test_what_does_not_fit_together_is_refused(
    line: Line, analysis: Analysis, placement: Placement, field: str
) -> None:
    with pytest.raises(InvalidSpec) as caught:
        next(place(line, analysis, placement), None)
    assert [fault.field.removesuffix(".highest") for fault in caught.value.faults] == [field]


def test_rules_of_choices() -> None:
    with pytest.raises(InvalidSpec, match=r"mass\.highest .* lowest \(3\.0\)"):
        PendulumChoice(1, (0.0, 1.0), (3.0, 2.0), (0.1, 0.1))
    with pytest.raises(InvalidSpec, match="count"):
        PendulumChoice(0, (0.0, 1.0), (1.0, 2.0), (0.1, 0.1))
    with pytest.raises(InvalidSpec, match="fit into"):
        SpoilerChoice(5.0, (0.0, 4.0), CALM)
    with pytest.raises(InvalidSpec, match="population"):
        Placement(PendulumChoice(1, (0.0, 1.0), (1.0, 2.0), (0.1, 0.1)), population=4)


def test_effect_of_devices_is_that_of_two_analyses() -> None:
    fitted = replace(source_line(2), devices=(DetuningPendulum(40.0, 15.0, 0.4),))
    asked = Analysis(wind_speeds=(2.3, 4.0), finite_element_loops=(1, 2))
    with_devices = run(fitted, replace(asked, device_effect=DeviceEffect.REPORTED))
    bare = run(source_line(2), asked)
    assert with_devices.limit_cycles == run(fitted, asked).limit_cycles
    rows = {(r.model, r.loops, r.wind_speed_m_per_s): r for r in with_devices.device_effects}
    assert len(rows) == 8
    row = rows[Model.HYBRID, 2, 4.0]
    (alone,) = stable_cycles(bare, loops=2, wind_speed=4.0)
    assert row.amplitude_without_m == pytest.approx(math.hypot(alone.vertical_m or 0.0, alone.horizontal_m or 0.0))
    assert row.critical_wind_speed_without_m_per_s == pytest.approx(2.2498, rel=1e-3)
    assert row.critical_wind_speed_with_m_per_s == min(
        r.wind_speed_m_per_s
        for r in with_devices.critical_wind_speeds
        if (r.model, r.loops, r.crossing) == (Model.HYBRID, 2, "onset")
    )
    assert rows[Model.HYBRID, 1, 2.3].amplitude_without_m == 0.0  # below the onset at 2.403 m/s the line rests
    assert run(fitted, asked).device_effects == ()


def test_four_pendulums_keep_apart_and_do_not_enlarge_the_motion() -> None:
    """The search once put four of them within 13 m of one tower, and raised the amplitude by a fifth."""
    asked = only(Model.HYBRID, wind_speeds=(6.0,), loops=(2,))
    choice = PendulumChoice(4, (0.0, 125.88), (5.0, 20.0), (0.2, 0.5))
    result, _ = placed(source_line(2), asked, Placement(choice, generations=2, population=12))
    places = [row.position_m or 0.0 for row in result.placements]
    assert len(places) == 4
    assert all(right - left >= 125.88 / 20 - 1e-9 for left, right in pairwise(places))
    (effect,) = result.device_effects
    assert (effect.amplitude_with_m or 0.0) <= 1.01 * (effect.amplitude_without_m or 0.0)
    assert (effect.critical_wind_speed_with_m_per_s or 0.0) > (effect.critical_wind_speed_without_m_per_s or 0.0)


def test_where_nothing_helps_nothing_is_placed() -> None:
    """A spoiler whose lift falls twice as steeply as that of the ice feeds Den Hartog's mechanism wherever it is."""
    asked = only(Model.HYBRID, wind_speeds=(8.0,), loops=(1,))
    choice = SpoilerChoice(40.0, (0.0, 125.88), Aerodynamics((-1.8, 0.0, 8.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    line = den_hartog_line({})
    result, _ = placed(line, asked, Placement(choice, generations=1, population=6))
    assert result.placements == ()
    assert result.device_effects == ()
    assert result.limit_cycles == run(line, asked).limit_cycles
    assert any(warning.startswith("No improvement found") for warning in result.warnings)


def test_placed_devices_keep_away_from_those_of_the_line() -> None:
    line = replace(source_line(2), devices=(DetuningPendulum(62.94, 15.0, 0.4),))
    choice = PendulumChoice(1, (50.0, 75.0), (15.0, 15.0), (0.4, 0.4))
    result, _ = placed(line, ONSET, Placement(choice, generations=2, population=8, separation=5.0))
    assert all(abs((row.position_m or 0.0) - 62.94) >= 5.0 for row in result.placements)


def test_devices_without_room_are_refused() -> None:
    choice = PendulumChoice(4, (10.0, 20.0), (5.0, 20.0), (0.2, 0.5))
    with pytest.raises(InvalidSpec, match=r"separation must leave room: 4 devices 5 m apart need 15 m"):
        next(place(source_line(2), ONSET, Placement(choice, separation=5.0)), None)
