"""The statics of spans in mechaphlowers, an independent code: catenaries of elastic conductors between dead ends."""

import warnings
from dataclasses import dataclass

import numpy as np
import pandas as pd

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # of the packages that it loads
    from mechaphlowers.core.models.balance.engine import BalanceEngine
    from mechaphlowers.entities.arrays import CableArray, SectionArray

GRAVITY = 9.81
AREA = 400e-6  # m2; only its product with the modulus counts
UNUSED = (  # thermal and electrical fields that the schema asks for
    "diameter_heart",
    "section_heart",
    "solar_absorption",
    "emissivity",
    "electric_resistance_20",
    "linear_resistance_temperature_coef",
    "radial_thermal_conductivity",
)


@dataclass(frozen=True, slots=True)
class HungCable:
    """A conductor as it hangs at first: diameter [m], axial rigidity EA [N], mass [kg/m], expansion [1/K].

    length, level_difference: of its span [m]; horizontal_tension [N] at the temperature [degrees Celsius], bare and in
    still air.
    """

    diameter: float
    axial_rigidity: float
    mass: float
    length: float
    horizontal_tension: float
    level_difference: float = 0.0
    expansion: float = 0.0
    temperature: float = 15.0


@dataclass(frozen=True, slots=True)
class Weather:
    """Another state: temperature [degrees Celsius], pressure of wind [Pa], thickness [m] and weight [N/m3] of ice."""

    temperature: float = 15.0
    wind_pressure: float = 0.0
    ice_thickness: float = 0.0
    ice_weight: float = 9000.0


def horizontal_tension(cable: HungCable, weather: Weather) -> float:
    """Return the tension along the span in another state, between dead ends [N].

    mechaphlowers gives it along the projection of the span on the turned plane of the sag, where a level difference has
    a part across the line.
    """
    engine = _balanced(cable, weather)
    across = cable.level_difference * np.sin(engine.cable_loads.load_angle[0])
    return float(engine.span_model.T_h()[0] * cable.length / np.hypot(cable.length, across))


def section_tensions(
    cable: HungCable, lengths: tuple[float, ...], string: tuple[float, float], weather: Weather
) -> list[float]:
    """Return the tension of every level span of a section between dead ends in another state [N].

    string: length [m] and mass [kg] of each suspension string, plumb at first; the cable's own length is not used.
    """
    engine = _balanced(cable, weather, lengths, string)
    return [float(tension) for tension in engine.span_model.T_h()[: len(lengths)]]


def _balanced(
    cable: HungCable,
    weather: Weather,
    lengths: tuple[float, ...] = (),
    string: tuple[float, float] = (0.0, 0.0),
) -> BalanceEngine:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it warns of strings without length, which are the dead ends here
        engine = BalanceEngine(_cable(cable), _section(cable, lengths, string))
        engine.cable_loads.ice_density = weather.ice_weight
        engine.solve_adjustment()
        engine.solve_change_state(weather.wind_pressure, weather.ice_thickness, weather.temperature)
    return engine


def _cable(cable: HungCable) -> CableArray:
    modulus = 1e-6 * cable.axial_rigidity / AREA
    row = {
        "section": 1e6 * AREA,
        "section_conductor": 1e6 * AREA,
        "diameter": 1e3 * cable.diameter,
        "linear_mass": cable.mass,
        "young_modulus": modulus,
        "dilatation_coefficient": cable.expansion,
        "temperature_reference": 0.0,
        "is_polynomial": False,
        "has_magnetic_heart": False,
    }
    row |= {f"{kind}{i}": modulus if (kind, i) == ("a", 1) else 0.0 for kind in "ab" for i in range(5)}
    return CableArray(pd.DataFrame([row | dict.fromkeys(UNUSED, 0.0)]))


def _section(cable: HungCable, lengths: tuple[float, ...], string: tuple[float, float]) -> SectionArray:
    """Return the spans of these lengths, or the cable's own."""
    spans = lengths or (cable.length,)
    ends, inner = len(spans) + 1, len(spans) - 1
    supports = pd.DataFrame(
        {
            "name": [str(i) for i in range(ends)],
            "suspension": [False, *[True] * inner, False],
            "conductor_attachment_altitude": [1000.0, *[1000.0] * inner, 1000.0 + cable.level_difference],
            "crossarm_length": [0.0] * ends,
            "line_angle": [0.0] * ends,
            "insulator_length": [0.0, *[string[0]] * inner, 0.0],
            "insulator_mass": [0.0, *[string[1]] * inner, 0.0],
            "span_length": [*spans, np.nan],
        }
    )
    parameter = cable.horizontal_tension / (cable.mass * GRAVITY)
    return SectionArray(supports, sagging_parameter=parameter, sagging_temperature=cable.temperature)
