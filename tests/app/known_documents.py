"""Thirteen lines of different make, as engineers know them."""

from copy import deepcopy
from typing import Any

from app.reference.source_lines import example

CONTRACT: dict[str, Any] = {
    "conductor": {"catalogue": "Drake"},
    "bundle": {"subconductors": 2, "spacing_m": 0.457, "arrangement": "horizontal"},
    "span": {
        "length_m": 300.0,
        "level_difference_m": 0.0,
        "ruling_span_m": 305.0,
        "temperature_c": -5.0,
        "everyday": {"temperature_c": 15.0, "share_of_rated_strength": 0.20},
    },
    "ice": {
        "accretion": {"shape": "crescent", "thickness_m": 0.012, "density_kg_per_m3": 900.0, "angle_deg": 0.0},
        "aerodynamics": {"catalogue": "c11-40"},
    },
    "supports": {
        "left": {"adjacent_span_m": 280.0, "insulator_length_m": 2.4},
        "right": {"adjacent_span_m": 330.0, "insulator_length_m": 2.4},
    },
    "phases": [
        {"name": "top", "y_m": 7.0, "z_m": 0.0},
        {"name": "ground wire", "y_m": 14.0, "z_m": 1.0, "required_clearance_m": 1.2},
    ],
    "required_clearance_m": 1.5,
    "design_wind_m_per_s": 10.0,
    "climate": {
        "line_azimuth_deg": 45.0,
        "sectors": [{"direction_deg": 315.0, "share": 1.0, "weibull_shape": 2.0, "weibull_scale_m_per_s": 6.0}],
        "icing": [{"kind": "glaze", "thickness_m": 0.012, "hours_a_year": 40.0}],
    },
}
_TABLE = [
    {"angle_deg": float(angle), "lift": 0.1 + 0.01 * angle, "drag": 1.0 + 0.001 * angle, "moment": -0.002 * angle}
    for angle in range(0, 90, 10)
]


def changed(**parts: Any) -> dict[str, Any]:
    """Return the contract's line with other parts."""
    return {**deepcopy(CONTRACT), **parts}


def _in(part: str, **fields: Any) -> dict[str, Any]:
    return {**deepcopy(CONTRACT[part]), **fields}


def _feet(value: float) -> dict[str, Any]:
    return {"value": value, "unit": "ft"}


LINES: dict[str, dict[str, Any]] = {
    "as in the contract": CONTRACT,
    "explicit": example("c11-twin"),
    "explicit without what can be assumed": {
        key: value for key, value in example("c11-quad").items() if key not in {"damping", "wind"}
    },
    "imperial": changed(
        span={
            "length_m": _feet(1000.0),
            "temperature_c": {"value": 32.0, "unit": "degF"},
            "everyday": {"horizontal_tension_n": {"value": 6.3, "unit": "kip"}},
        },
        bundle={"subconductors": 2, "spacing_m": {"value": 18.0, "unit": "in"}},
    ),
    "single with wet snow": changed(
        bundle={"subconductors": 1},
        ice={
            "accretion": {"shape": "uniform", "thickness_m": 0.02, "kind": "wet_snow"},
            "aerodynamics": {"catalogue": "C11-270", "angle_deg": 270.0},
        },
    ),
    "quad by mass of ice": changed(
        conductor={"catalogue": "242-AL1/39-ST1A"},
        bundle={"subconductors": 4, "spacing_m": 0.4},
        ice=_in("ice", accretion={"shape": "d_shape", "mass_kg_per_m": 0.8}),
    ),
    "outline": changed(
        ice=_in(
            "ice",
            accretion={
                "shape": "profile",
                "points_m": [[0.02, 0.0], [0.0, 0.03], [-0.02, 0.0], [0.0, -0.02]],
            },
        )
    ),
    "sag on a slope": changed(
        span={"length_m": 250.0, "level_difference_m": 20.0, "everyday": {"sag_m": 5.0, "wind_pressure_pa": 50.0}}
    ),
    "not in a catalogue, with a table": changed(
        conductor={"diameter_m": 0.03, "bare_mass_kg_per_m": 1.8, "rated_strength_n": 150e3},
        ice={
            "accretion": {"shape": "crescent", "thickness_m": 0.01},
            "aerodynamics": {
                "table": _TABLE,
                "static_angle_deg": 40.0,
                "half_range_deg": 20.0,
                "reference_diameter_m": 0.035,
            },
        },
    ),
    "of unknown shape": changed(ice={"accretion": {"shape": "crescent", "thickness_m": 0.012}}),
    "in a section on a slope": {
        **changed(
            span={
                "length_m": 300.0,
                "level_difference_m": 12.0,
                "temperature_c": -5.0,
                "everyday": {"horizontal_tension_n": 28000.0},
            },
            section={
                "spans": [
                    {"length_m": 280.0},
                    {"length_m": 300.0, "level_difference_m": 12.0},
                    {"length_m": 330.0, "level_difference_m": -5.0},
                ],
                "span_of_interest": 2,
                "strings": [{"length_m": 2.4, "weight_n": 1200.0}] * 2,
            },
        ),
        "supports": {},
    },
    "tied to a phase": changed(
        devices=[{"type": "interphase_spacer", "position_m": 150.0, "mass_kg": 20.0, "between": ["this", "top"]}]
    ),
    "overridden, dead ends, a device": changed(
        conductor={"catalogue": "drake", "torsional_rigidity_n_m2": 150.0, "youngs_modulus_pa": 74e9},
        supports={"left": {"dead_end": True}, "right": {"dead_end": True}},
        damping={"torsional_ratio": 0.08},
        devices=[{"type": "detuning_pendulum", "position_m": 150.0, "mass_kg": 12.0, "arm_m": 0.3}],
    ),
}
