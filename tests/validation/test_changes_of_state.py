"""Change of state against a published table and against mechaphlowers, the statics of the French grid operator."""

import math

import pytest

from benchmarks.mechaphlowers import HungCable, Weather, horizontal_tension, section_tensions
from engine.known.change_of_state import HungSpan, LoadState, change_of_state
from engine.known.ice_sections import Accretion, BareConductor, Shape, ice_section
from engine.spec import GRAVITY

POUND, FOOT, INCH = 4.4482216152605, 0.3048, 0.0254
RIGIDITY, EXPANSION, DIAMETER, MASS = 468.64e-6 * 69.64e9, 18.82e-6, 0.02814, 1.6281  # Drake
ICE_DENSITY = 900.0
LEVEL = ((213.36, 0.0, 24e3), (300.0, 60.0, 28e3), (500.0, -90.0, 32e3))
ISOTHERMAL = (Weather(15.0, 200.0, 0.012), Weather(15.0, 0.0, 0.03))
OTHERS = (
    Weather(-20.0),
    Weather(50.0),
    Weather(-5.0, 0.0, 0.012),
    Weather(-5.0, 200.0, 0.012),
    Weather(0.0, 0.0, 0.03),
)


def ice_weight(diameter: float, thickness: float, density: float) -> float:
    bare = BareConductor(diameter, 1.0, 1.0)
    return GRAVITY * ice_section(bare, Accretion(Shape.UNIFORM, thickness, density=density)).ice_mass


@pytest.mark.parametrize(("modulus", "expansion", "within"), [(69.64e9, 18.82e-6, 1e-3), (74e9, 18.9e-6, 1.6e-2)])
def test_drake_on_700_feet_has_the_published_tensions(modulus: float, expansion: float, within: float) -> None:
    # NESC heavy, final: 5,429 lb bare at 60 F; NESC adds 0.3 lb/ft to the resultant of ice and wind. Horizontal
    # tensions are within 0.4 % of those at the supports, whichever the table has.
    span = HungSpan(700.0 * FOOT, 468.5e-6 * modulus, expansion)
    bare, ice = 1.094 * POUND / FOOT, ice_weight(1.108 * INCH, 0.5 * INCH, 57.0 * 0.45359237 / FOOT**3)
    wind = 4.0 * POUND / FOOT**2 * (1.108 + 2 * 0.5) * INCH
    everyday = LoadState(celsius(60.0), bare)
    iced = change_of_state(span, 5429.0 * POUND, everyday, LoadState(celsius(32.0), bare + ice))
    heavy = LoadState(celsius(0.0), bare + ice, wind, constant=0.3 * POUND / FOOT)
    windy = change_of_state(span, 5429.0 * POUND, everyday, heavy)
    assert iced.horizontal_tension / POUND == pytest.approx(9224.0, rel=within)
    assert windy.horizontal_tension / POUND == pytest.approx(11318.0, rel=within)


def celsius(fahrenheit: float) -> float:
    return (fahrenheit - 32.0) / 1.8


def tension(span: HungSpan, strung: float, weather: Weather) -> float:
    """Return the engine's horizontal tension in another state [N]."""
    ice = ice_weight(DIAMETER, weather.ice_thickness, ICE_DENSITY) if weather.ice_thickness else 0.0
    drag = weather.wind_pressure * (DIAMETER + 2.0 * weather.ice_thickness)
    wanted = LoadState(weather.temperature, GRAVITY * MASS + ice, drag)
    return change_of_state(span, strung, LoadState(15.0, GRAVITY * MASS), wanted).horizontal_tension


def weighed(weather: Weather) -> Weather:
    return Weather(weather.temperature, weather.wind_pressure, weather.ice_thickness, GRAVITY * ICE_DENSITY)


@pytest.mark.parametrize(("length", "rise", "strung"), LEVEL)
@pytest.mark.parametrize(
    ("weather", "within"),
    # mechaphlowers takes the mean tension for the strain, and adds to it the thermal strain from 0 degrees Celsius,
    # where lengths multiply here.
    [*((weather, 1e-4) for weather in ISOTHERMAL), *((weather, 5e-4) for weather in OTHERS)],
    ids=str,
)
def test_a_span_between_dead_ends_changes_as_in_mechaphlowers(
    length: float, rise: float, strung: float, weather: Weather, within: float
) -> None:
    cable = HungCable(DIAMETER, RIGIDITY, MASS, length, strung, rise, EXPANSION)
    expected = horizontal_tension(cable, weighed(weather))
    assert tension(HungSpan(length, RIGIDITY, EXPANSION, rise), strung, weather) == pytest.approx(expected, rel=within)


@pytest.mark.parametrize("weather", [*ISOTHERMAL, *OTHERS], ids=str)
def test_the_ruling_span_stands_for_a_section_whose_strings_lean(weather: Weather) -> None:
    lengths, strung = (280.0, 300.0, 330.0), 28e3
    cable = HungCable(DIAMETER, RIGIDITY, MASS, 300.0, strung, 0.0, EXPANSION)
    expected = section_tensions(cable, lengths, (4.5, 250.0), weighed(weather))
    ruling = math.sqrt(sum(length**3 for length in lengths) / sum(lengths))
    for length, value in zip(lengths, expected, strict=True):
        span = HungSpan(length, RIGIDITY, EXPANSION, ruling_span=ruling)
        assert tension(span, strung, weather) == pytest.approx(value, rel=5e-3)
