"""Phases that spacers tie, from the line to the result: what is known of them without the assembly."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.coupled_spans import Spring, middle_motion
from engine.outcome import InvalidSpec
from engine.result import LimitCycleRow, Result
from engine.spec import (
    AerodynamicModel,
    Aerodynamics,
    Analysis,
    Closure,
    DeviceEffect,
    Ice,
    InterphaseSpacer,
    LoopCompetition,
    Model,
    Phase,
    Stretching,
    check_compatible,
)
from tests.builders import ICE_AT_40, only, phases_line, run, source_line

RIGID = InterphaseSpacer(62.94, 0.0, ("this", "top"))
ONE_LOOP = Analysis(loops=(1,), finite_element_loops=(1,), wind_speeds=(6.0,))


def calm_ice(slope: float) -> Ice:
    """Return ice whose lift does not feed vertical motion where the slope is positive."""
    return replace(source_line(2).ice, aerodynamics=replace(ICE_AT_40, vertical=(slope, *ICE_AT_40.vertical[1:])))


def alone(analysis: Analysis) -> Result:
    return run(source_line(2), replace(analysis, models=(Model.FINITE_ELEMENT,)))


def of_one_loop(result: Result) -> LimitCycleRow:
    (row,) = (r for r in result.limit_cycles if r.loops == 1 and r.kind == "periodic" and r.stability == "stable")
    return row


@pytest.mark.parametrize("stretching", [Stretching.NEGLECTED, Stretching.INCLUDED])
def test_equal_phases_gallop_together_as_one_does_alone(stretching: Stretching) -> None:
    asked = replace(ONE_LOOP, stretching=stretching)
    tied, single = run(phases_line(RIGID), asked), alone(asked)
    found, own = of_one_loop(tied), of_one_loop(single)
    for name in ("vertical_m", "horizontal_m", "torsional_rad", "frequency_hz", "observed_at_m", "vertical_ratio"):
        assert getattr(found, name) == pytest.approx(getattr(own, name), rel=1e-6)
    assert (found.phase, found.phase_shares, found.span) == ("this", "0.5000 0.5000", None)
    assert tied.critical_wind_speeds[0].wind_speed_m_per_s == pytest.approx(
        single.critical_wind_speeds[0].wind_speed_m_per_s, rel=1e-6
    )
    pulled = [row for row in tied.tensions if row.branch == found.branch]
    assert [row.phase for row in pulled] == (["this", "top"] if stretching is Stretching.INCLUDED else [])
    for row in pulled:
        assert row.largest_at_support_n == pytest.approx(single.tensions[0].largest_at_support_n, rel=1e-6)


def test_a_very_soft_spacer_leaves_each_phase_its_own_motion() -> None:
    line = phases_line(replace(RIGID, axial_stiffness=1e-6), above=Phase("top", 7.0, 0.0, ice=calm_ice(0.3)))
    found = of_one_loop(run(line, ONE_LOOP))
    assert found.vertical_m == pytest.approx(of_one_loop(alone(ONE_LOOP)).vertical_m, rel=1e-6)
    assert (found.phase, found.phase_shares) == ("this", "1.0000 0.0000")


def test_a_spacer_to_a_phase_with_calm_ice_raises_the_onset() -> None:
    line = phases_line(replace(RIGID, axial_stiffness=500.0), above=Phase("top", 7.0, 0.0, ice=calm_ice(0.1)))
    result = run(line, replace(ONE_LOOP, wind_speeds=(6.0, 14.0)))
    onset = min(row.wind_speed_m_per_s for row in result.critical_wind_speeds)
    # half of the wind's feed of -0.1667 and 0.1 is left: zeta = -U rho d a/(4 m omega), with other shapes than sines
    single = alone(ONE_LOOP).critical_wind_speeds[0].wind_speed_m_per_s
    assert onset == pytest.approx(single * 0.1667 / (0.5 * 0.0667), rel=0.03)
    assert {row.kind for row in result.limit_cycles if row.wind_speed_m_per_s == 6.0} == {"equilibrium"}
    assert {row.kind for row in result.limit_cycles if row.wind_speed_m_per_s == 14.0} == {"equilibrium", "periodic"}
    assert result.warnings[0].startswith("Phases that spacers tie are analysed by the finite element model only")
    named = run(line, replace(ONE_LOOP, models=(Model.FINITE_ELEMENT,), wind_speeds=()))
    assert not any("hybrid" in warning for warning in named.warnings)


STIFFNESS, PLACE, WIND = 2e3, 50.0, 8.0


def test_the_cycle_of_unequal_phases_is_that_of_two_spans_with_a_spring_integrated_in_time() -> None:
    ice = calm_ice(0.2)
    spacer = InterphaseSpacer(PLACE, 0.0, ("this", "top"), STIFFNESS)
    line = phases_line(spacer, above=Phase("top", 3.0, 4.0, ice=ice))
    found = of_one_loop(run(line, replace(ONE_LOOP, wind_speeds=(WIND,))))
    assert found.observed_at_m == pytest.approx(62.94, abs=3.0)  # the spring moves the crest, by 0.2 % of its height
    spans = source_line(2), replace(source_line(2), ice=ice)
    start = (1.15, -1.15)  # against each other, as in the cycle
    series, step = middle_motion(spans, Spring(PLACE, (0.6, 0.8), STIFFNESS), 5, WIND, (start, 700.0))
    amplitude = 0.5 * np.ptp(series, axis=0)
    # modes of single spans approach the kink at the spring slowly: 1.180, 1.188, 1.192 m with 3, 5 and 7 loops
    assert found.vertical_m == pytest.approx(amplitude[0], rel=0.012)
    assert amplitude[1] < amplitude[0]
    crossed = np.flatnonzero((series[:-1, 0] < 0.0) & (series[1:, 0] >= 0.0))
    assert found.frequency_hz == pytest.approx((crossed.size - 1) / ((crossed[-1] - crossed[0]) * step), rel=3e-3)


@pytest.mark.parametrize(
    ("changes", "field", "word"),
    [
        ({"models": (Model.HYBRID,)}, "models", "must hold finite_element"),
        ({"closure": Closure.PUBLISHED}, "closure", "must not be published"),
        ({"aerodynamic_model": AerodynamicModel.TABLE}, "aerodynamic_model", "must not be table"),
        ({"loop_competition": LoopCompetition.CHECKED}, "loop_competition", "must not be checked"),
        ({"device_effect": DeviceEffect.REPORTED}, "device_effect", "must not be reported"),
    ],
)
def test_what_tied_phases_do_not_have_is_refused(changes: dict[str, object], field: str, word: str) -> None:
    with pytest.raises(InvalidSpec) as caught:
        check_compatible(phases_line(RIGID), replace(Analysis(), **changes))  # type: ignore[arg-type]
    assert any(fault.field == field and word in fault.rule for fault in caught.value.faults)


def test_a_line_whose_phases_are_not_tied_is_a_single_span() -> None:
    beside = replace(source_line(2), phases=(Phase("top", 7.0, 0.0),))
    asked = only(Model.HYBRID, wind_speeds=(6.0,), loops=(1,))
    found, single = run(beside, asked), run(source_line(2), asked)
    assert found.limit_cycles == single.limit_cycles
    assert single.clearances == ()
    assert {row.method for row in found.clearances} == {"computed", "davison", "toye", "cigre", "aeso"}


def test_no_galloping_without_wind_that_feeds_it() -> None:
    still = Aerodynamics((0.5, 0.0, 0.0), (0.5, 0.0, 0.0), (0.0, 0.0, 0.0))
    line = phases_line(RIGID)
    line = replace(line, ice=replace(line.ice, aerodynamics=still))
    result = run(line, ONE_LOOP)
    assert result.critical_wind_speeds == ()
    assert (result.verdict[0].gallops, result.verdict[0].clearance_ok) == ("no", None)
