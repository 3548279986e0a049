"""Change of state against limits with closed forms, itself and its rules."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.known.change_of_state import HungSpan, LoadState, change_of_state, hung_state, tension_of_sag
from engine.outcome import InvalidSpec

SPAN = HungSpan(300.0, 32.6e6, 18.8e-6)
EVERYDAY = LoadState(15.0, 16.0)
ICED = LoadState(-5.0, 30.0, 10.0)
TENSION = 28e3


def test_the_same_state_keeps_the_tension() -> None:
    assert change_of_state(SPAN, TENSION, EVERYDAY, EVERYDAY).horizontal_tension == pytest.approx(TENSION, rel=1e-10)


@given(
    st.floats(-150.0, 150.0),
    st.floats(12e3, 60e3),
    st.floats(-40.0, 80.0),
    st.floats(10.0, 60.0),
    st.floats(0.0, 30.0),
    st.sampled_from([None, 250.0, 420.0]),
)
def test_the_way_back_leads_to_the_start(
    rise: float, tension: float, temperature: float, weight: float, drag: float, ruling: float | None
) -> None:
    span = replace(SPAN, level_difference=rise, ruling_span=ruling)
    other = LoadState(temperature, weight, drag)
    there = change_of_state(span, tension, EVERYDAY, other).horizontal_tension
    back = change_of_state(span, there, other, EVERYDAY).horizontal_tension
    # The strains of temperature multiply: (1 + a)(1 - a) is not quite 1.
    assert back == pytest.approx(tension, rel=2e-3)


def test_a_taut_wire_loses_the_thermal_strain_times_its_rigidity() -> None:
    span, weightless = HungSpan(10.0, 1e6, 2e-5), LoadState(20.0, 1e-3)
    warmer = change_of_state(span, 5e3, weightless, replace(weightless, temperature=30.0))
    # H = EA e: 1 + e = (1 + e_0)/(1 + a dT).
    expected = 1e6 * ((1.0 + 5e-3) / (1.0 + 2e-4) - 1.0)
    assert warmer.horizontal_tension == pytest.approx(expected, rel=1e-9)


def test_flat_spans_follow_the_cubic_of_the_parabola() -> None:
    # H^2 (H - H_0 + EA a dT + EA (w_0 L)^2/(24 H_0^2)) = EA (w L)^2/24, the textbook's form.
    span = HungSpan(200.0, 32.6e6, 18.8e-6)
    found = change_of_state(span, TENSION, EVERYDAY, LoadState(-20.0, 24.0)).horizontal_tension
    rest = -TENSION + 32.6e6 * (18.8e-6 * -35.0 + (16.0 * 200.0 / TENSION) ** 2 / 24.0)
    roots = np.roots([1.0, rest, 0.0, -32.6e6 * (24.0 * 200.0) ** 2 / 24.0])
    (real,) = roots[np.abs(roots.imag) < 1e-6].real
    assert found == pytest.approx(real, rel=5e-4)


def test_ice_pulls_and_warmth_slackens() -> None:
    warm = change_of_state(SPAN, TENSION, EVERYDAY, replace(EVERYDAY, temperature=50.0))
    cold = change_of_state(SPAN, TENSION, EVERYDAY, replace(EVERYDAY, temperature=-20.0))
    iced = change_of_state(SPAN, TENSION, EVERYDAY, replace(ICED, drag=0.0))
    windy = change_of_state(SPAN, TENSION, EVERYDAY, ICED)
    extra = change_of_state(SPAN, TENSION, EVERYDAY, replace(ICED, constant=4.0))
    order = [state.horizontal_tension for state in (warm, cold, iced, windy, extra)]
    assert order == sorted(order)
    assert warm.sag > cold.sag
    assert warm.unstressed_length > cold.unstressed_length


def test_the_unstressed_length_grows_with_temperature_only() -> None:
    before = hung_state(SPAN, TENSION, EVERYDAY).unstressed_length
    after = change_of_state(SPAN, TENSION, EVERYDAY, ICED).unstressed_length
    assert after / before == pytest.approx(1.0 - 18.8e-6 * 20.0, rel=1e-12)


def test_the_section_changes_as_its_ruling_span() -> None:
    ruled = change_of_state(replace(SPAN, ruling_span=420.0), TENSION, EVERYDAY, ICED)
    alone = change_of_state(replace(SPAN, length=420.0), TENSION, EVERYDAY, ICED)
    assert ruled.horizontal_tension == pytest.approx(alone.horizontal_tension, rel=1e-12)
    assert ruled.sag < alone.sag
    itself = change_of_state(replace(SPAN, ruling_span=300.0), TENSION, EVERYDAY, ICED)
    assert itself == change_of_state(SPAN, TENSION, EVERYDAY, ICED)


def test_the_largest_tension_is_at_the_higher_support() -> None:
    level = hung_state(SPAN, TENSION, EVERYDAY)
    assert level.largest_tension == pytest.approx(math.hypot(TENSION, 16.0 * 0.5 * level_arc()), rel=1e-12)
    steep = hung_state(replace(SPAN, level_difference=60.0), TENSION, EVERYDAY)
    # In a catenary the tension differs between two points by the weight times their difference in height.
    lower = hung_state(replace(SPAN, level_difference=-60.0), TENSION, EVERYDAY)
    assert steep.largest_tension == pytest.approx(lower.largest_tension, rel=1e-12)
    assert steep.largest_tension > level.largest_tension + 16.0 * 25.0


def level_arc() -> float:
    catenary = TENSION / 16.0
    return 2.0 * catenary * math.sinh(150.0 / catenary)


@pytest.mark.parametrize("drag", [0.0, 12.0])
@pytest.mark.parametrize("rise", [0.0, -70.0])
def test_a_sag_gives_the_tension_that_has_it(rise: float, drag: float) -> None:
    span, load = replace(SPAN, level_difference=rise), LoadState(15.0, 16.0, drag)
    tension = tension_of_sag(span, 8.5, load)
    assert hung_state(span, tension, load).sag == pytest.approx(8.5, rel=1e-12)


def test_wind_turns_the_plane_of_a_level_span_without_changing_its_shape() -> None:
    upright, turned = LoadState(15.0, 20.0), LoadState(15.0, 12.0, 16.0)
    assert turned.resultant == pytest.approx(20.0)
    assert turned.tilt == pytest.approx(math.atan(16.0 / 12.0))
    before, after = (change_of_state(SPAN, TENSION, EVERYDAY, load) for load in (upright, turned))
    assert after.horizontal_tension == pytest.approx(before.horizontal_tension, rel=1e-12)


@pytest.mark.parametrize(
    ("build", "fault"),
    [
        (lambda: LoadState(288.0 + 100.0, 16.0), r"temperature must lie between -100 and 300 .* kelvin, got 388"),
        (lambda: LoadState(-150.0, 16.0), r"temperature must lie between -100 and 300 degrees Celsius, got -150"),
        (lambda: LoadState(15.0, 0.0), r"weight must be a finite number greater than zero"),
        (
            lambda: HungSpan(300.0, 32.6e6, 18.8),
            r"conductor\.thermal_expansion must be per kelvin, at most 1e-4, got 18",
        ),
        (lambda: HungSpan(-3.0, 32.6e6, 2e-5), r"span\.length must be a finite number greater than zero, got -3"),
        (lambda: tension_of_sag(SPAN, 0.0, EVERYDAY), r"sag must be a finite number greater than zero, got 0"),
        (lambda: change_of_state(SPAN, -1.0, EVERYDAY, ICED), r"tension must be a finite number greater than zero"),
        (
            lambda: change_of_state(SPAN, 700.0, EVERYDAY, ICED),
            r"span\.everyday must carry 300 m .* like a chain, got 700",
        ),
        (
            lambda: change_of_state(replace(SPAN, thermal_expansion=1e-4), 801.0, EVERYDAY, LoadState(200.0, 16.0)),
            r"span\.everyday has no state at 200 degrees Celsius: \d+ m of conductor cannot span 300 m, got 801",
        ),
        (
            lambda: change_of_state(SPAN, 1e9, EVERYDAY, ICED),
            r"span\.everyday has no state at -5 degrees Celsius: 9\.\d+ m of conductor cannot span 300 m, got 1",
        ),
    ],
)
def test_a_broken_rule_is_named(build, fault: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InvalidSpec, match=fault):
        build()
