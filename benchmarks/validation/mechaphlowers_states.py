"""Let mechaphlowers compute changes of state and print them as JSON: tests/validation/mechaphlowers_states.json.

It needs pandas 2, which the project does not, so it runs in an environment of its own, without the project:

    python -m venv peer && peer/bin/pip install mechaphlowers==0.13.1
    peer/bin/python benchmarks/validation/mechaphlowers_states.py > tests/validation/mechaphlowers_states.json

Sections are strung at 15 degrees Celsius, bare; angles and weights of strings are those of the section.
"""

import importlib.metadata
import json
import sys
from typing import Any

import numpy as np

AREA, MODULUS, DIAMETER, MASS, EXPANSION = 468.64, 69640.0, 28.14, 1.6281, 18.82e-6  # mm2, MPa, mm, kg/m, 1/K
ICE_WEIGHT = 8829.0  # N/m3: 900 kg/m3
STRUNG = 15.0  # degrees Celsius
# Spans [m], level differences [m], catenary parameter [m], length and mass of the strings [m, kg].
SECTIONS: list[tuple[list[float], list[float], float, float, float]] = [
    ([213.36], [0.0], 1500.0, 0.0, 0.0),
    ([300.0], [0.0], 1750.0, 0.0, 0.0),
    ([300.0], [60.0], 1750.0, 0.0, 0.0),
    ([500.0], [-90.0], 2000.0, 0.0, 0.0),
    ([280.0, 300.0, 330.0], [0.0, 0.0, 0.0], 1750.0, 4.5, 250.0),
]
# Temperature [degrees Celsius], thickness of the ice [m], pressure of the wind [Pa].
STATES = [
    (15.0, 0.012, 0.0),
    (15.0, 0.012, 200.0),
    (-20.0, 0.0, 0.0),
    (50.0, 0.0, 0.0),
    (-5.0, 0.012, 0.0),
    (-5.0, 0.012, 200.0),
    (0.0, 0.03, 0.0),
]
FIELDS = ("temperature_c", "ice_thickness_m", "wind_pressure_pa")


def engine_of(spans: list[float], rises: list[float], parameter: float, string: tuple[float, float]) -> Any:
    """Return mechaphlowers' engine for a section between dead ends."""
    import pandas as pd  # noqa: PLC0415
    from mechaphlowers.core.models.balance.engine import BalanceEngine  # noqa: PLC0415
    from mechaphlowers.entities.arrays import CableArray, SectionArray  # noqa: PLC0415

    inner, count = len(spans) - 1, len(spans) + 1
    altitude = 100.0 + np.concatenate([[0.0], np.cumsum(rises)])
    frame = {
        "name": [str(i) for i in range(count)],
        "suspension": [False] + [True] * inner + [False],
        "conductor_attachment_altitude": altitude,
        "crossarm_length": [0.0] * count,
        "line_angle": [0.0] * count,
        "insulator_length": [0.01] + [string[0]] * inner + [0.01],
        "span_length": [*spans, np.nan],
        "insulator_mass": [0.0] + [string[1]] * inner + [0.0],
    }
    section = SectionArray(pd.DataFrame(frame), sagging_parameter=parameter, sagging_temperature=STRUNG)
    cable = {
        "section": AREA,
        "diameter": DIAMETER,
        "linear_mass": MASS,
        "young_modulus": MODULUS,
        "dilatation_coefficient": EXPANSION,
        "temperature_reference": STRUNG,
        "a1": MODULUS,
    }
    others = ("a0", "a2", "a3", "a4", "b0", "b1", "b2", "b3", "b4", "diameter_heart", "section_heart")
    thermal = ("solar_absorption", "emissivity", "electric_resistance_20", "linear_resistance_temperature_coef")
    conduction = ("radial_thermal_conductivity",)
    zeros = dict.fromkeys((*others, *thermal, *conduction), 0.0)
    more = {"section_conductor": AREA, "is_polynomial": False, "has_magnetic_heart": False, **zeros}
    return BalanceEngine(CableArray(pd.DataFrame({**{k: [v] for k, v in {**cable, **more}.items()}})), section)


def computed(section: tuple[list[float], list[float], float, float, float]) -> dict[str, Any]:
    """Return a section with its horizontal tensions [N] in every state, one for each span."""
    spans, rises, parameter, length, mass = section
    states = []
    for temperature, thickness, pressure in STATES:
        engine = engine_of(spans, rises, parameter, (length, mass))
        engine.balance_model.cable_loads.ice_density = ICE_WEIGHT
        engine.solve_adjustment()
        engine.balance_model.cable_loads.ice_density = ICE_WEIGHT
        engine.solve_change_state(pressure, thickness, temperature)
        tension = [float(value) for value in engine.span_model.T_h()[: len(spans)]]
        given = dict(zip(FIELDS, (temperature, thickness, pressure), strict=True))
        states.append({**given, "horizontal_tension_n": [round(value, 3) for value in tension]})
    return {
        "spans_m": spans,
        "level_differences_m": rises,
        "catenary_parameter_m": parameter,
        "string_length_m": length,
        "string_mass_kg": mass,
        "states": states,
    }


def main() -> None:
    """Print all sections."""
    conductor = {
        "area_m2": AREA * 1e-6,
        "youngs_modulus_pa": MODULUS * 1e6,
        "diameter_m": DIAMETER * 1e-3,
        "mass_kg_per_m": MASS,
        "thermal_expansion_per_k": EXPANSION,
    }
    page = {
        "program": "mechaphlowers",
        "version": importlib.metadata.version("mechaphlowers"),
        "script": "benchmarks/validation/mechaphlowers_states.py",
        "strung_at_c": STRUNG,
        "ice_density_kg_per_m3": 900.0,
        "conductor": conductor,
        "sections": [computed(section) for section in SECTIONS],
    }
    json.dump(page, sys.stdout, indent=1)
    sys.stdout.write("\n")


if __name__ == "__main__":
    main()
