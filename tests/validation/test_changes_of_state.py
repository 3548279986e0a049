"""Change of state against a published table and against mechaphlowers, the statics of the French grid operator.

mechaphlowers needs pandas 2, which the tests do not have; its figures are data, written by
benchmarks/validation/mechaphlowers_states.py, whose head says how.
"""

import json
import math
from pathlib import Path
from typing import Any

import pytest

from engine.known.change_of_state import HungSpan, LoadState, change_of_state
from engine.known.ice_sections import Accretion, BareConductor, Shape, ice_section
from engine.spec import GRAVITY

PEER = json.loads((Path(__file__).parent / "mechaphlowers_states.json").read_text(encoding="utf-8"))
POUND, FOOT, INCH = 4.4482216152605, 0.3048, 0.0254


def ice_weight(diameter: float, thickness: float, density: float) -> float:
    bare = BareConductor(diameter, 1.0, 1.0)
    return GRAVITY * ice_section(bare, Accretion(Shape.UNIFORM, thickness, density=density)).ice_mass


@pytest.mark.parametrize(("modulus", "expansion", "within"), [(69.64e9, 18.82e-6, 2e-3), (74e9, 18.9e-6, 1.6e-2)])
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


def states() -> list[Any]:
    cases = []
    for section in PEER["sections"]:
        lengths = "-".join(f"{length:g}" for length in section["spans_m"])
        for state in section["states"]:
            name = (
                f"{lengths} m, {state['temperature_c']} C, {state['ice_thickness_m']}, {state['wind_pressure_pa']} Pa"
            )
            cases.append(pytest.param(section, state, id=name))
    return cases


@pytest.mark.parametrize(("section", "state"), states())
def test_tensions_are_those_of_mechaphlowers(section: dict[str, Any], state: dict[str, Any]) -> None:
    conductor, lengths = PEER["conductor"], section["spans_m"]
    weight = GRAVITY * conductor["mass_kg_per_m"]
    thickness, diameter = state["ice_thickness_m"], conductor["diameter_m"]
    ice = ice_weight(diameter, thickness, PEER["ice_density_kg_per_m3"]) if thickness else 0.0
    load = LoadState(state["temperature_c"], weight + ice, state["wind_pressure_pa"] * (diameter + 2.0 * thickness))
    several = len(lengths) > 1
    ruling = math.sqrt(sum(length**3 for length in lengths) / sum(lengths)) if several else None
    # It adds the strains of tension and temperature, which multiply here; strings that lean part its spans' tensions.
    within = 4e-3 if several else 5e-5 if state["temperature_c"] == PEER["strung_at_c"] else 5e-4
    for length, rise, expected in zip(
        lengths, section["level_differences_m"], state["horizontal_tension_n"], strict=True
    ):
        rigidity = conductor["area_m2"] * conductor["youngs_modulus_pa"]
        span = HungSpan(length, rigidity, conductor["thermal_expansion_per_k"], rise, ruling)
        strung = section["catenary_parameter_m"] * weight
        found = change_of_state(span, strung, LoadState(PEER["strung_at_c"], weight), load)
        # Its tension lies in the plane of the sag, which a level difference turns out of X.
        in_plane = found.horizontal_tension * math.hypot(1.0, rise * math.sin(load.tilt) / length)
        assert in_plane == pytest.approx(expected, rel=within)


def test_the_recorded_figures_are_of_the_recorded_version() -> None:
    assert (PEER["program"], PEER["version"]) == ("mechaphlowers", "0.13.1")
    assert len(states()) == 35
