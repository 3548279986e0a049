"""A line that uses every field of the contract, how to change one of its fields, and what is wrong with a request."""

import json
import math
from typing import Any

from app import convert
from app.reference.source_lines import example
from app.schemas.faults import BadInput, Fault

COEFFICIENTS = example("c11-twin")["ice"]["aerodynamics"]
FULL_LINE: dict[str, Any] = {
    "name": "C11 twin, 126 m",
    "asset_id": "L204-S017",
    "tags": {"region": "north"},
    "conductor": {
        "diameter_m": 0.0286,
        "axial_rigidity_n": 28418105.8,
        "torsional_rigidity_n_m2": 101.0,
        "axial_torsional_coupling_n_m": 0.5,
        "mass_kg_per_m": 2.379,
        "polar_inertia_kg_m": 3.334e-4,
        "rated_strength_n": 140000.0,
    },
    "bundle": {"subconductors": 2, "radius_m": 0.2355, "orientation_deg": 90.0, "section": "free"},
    "span": {"length_m": 125.88, "horizontal_tension_n": 30000.0, "elements": 12, "level_difference_m": 3.0},
    "supports": {
        "longitudinal_stiffness_n_per_m": None,
        "left": {
            "dead_end": True,
            "adjacent_span_m": None,
            "insulator_length_m": None,
            "insulator_weight_n": 0.0,
            "yoke": "free",
        },
        "right": {"dead_end": False, "adjacent_span_m": 99.0, "insulator_length_m": 2.0, "insulator_weight_n": 300.0},
    },
    "ice": {
        "eccentricity_y_m": 2.05e-3,
        "eccentricity_z_m": -0.63e-3,
        "aerodynamics": COEFFICIENTS,
        "aerodynamics_at_rest": {"vertical": 0.1, "horizontal": 1.0, "torsional": 0.2},
        "segments": [
            {
                "from_m": 0.0,
                "to_m": 62.94,
                "aerodynamics": COEFFICIENTS,
                "aerodynamics_at_rest": {"vertical": 0.3, "horizontal": 1.1, "torsional": 0.4},
                "eccentricity_y_m": 1e-3,
                "mass_kg_per_m": 2.3,
            }
        ],
    },
    "wind": {
        "air_density_kg_per_m3": 1.2,
        "blow_out": {"wind_speed_m_per_s": 10.0, "drag_coefficient": 1.1},
        "yaw_deg": 30.0,
        "profile": [{"position_m": 0.0, "factor": 0.7}, {"position_m": 125.88, "factor": 1.3}],
    },
    "damping": {
        "vertical_ratio": 0.000515,
        "horizontal_ratio": 0.0006,
        "torsional_ratio": 0.308,
        "model": "constant_ratio",
    },
    "devices": [
        {"type": "spacer", "position_m": 25.0, "mass_kg": 6.5, "polar_inertia_kg_m2": 0.4},
        {"type": "detuning_pendulum", "position_m": 62.94, "mass_kg": 12.0, "arm_m": 0.35, "angle_deg": 30.0},
        {"type": "airflow_spoiler", "from_m": 30.0, "to_m": 60.0, "aerodynamics": COEFFICIENTS, "mass_kg_per_m": 0.3},
    ],
    "climate": {
        "line_azimuth_deg": 90.0,
        "sectors": [
            {
                "direction_deg": 45.0,
                "width_deg": 30.0,
                "share": 0.25,
                "weibull_shape": 2.0,
                "weibull_shape_lowest": 1.8,
                "weibull_shape_highest": 2.2,
                "weibull_scale_m_per_s": 6.0,
                "weibull_scale_lowest_m_per_s": 5.0,
                "weibull_scale_highest_m_per_s": 7.0,
            },
            {
                "direction_deg": 180.0,
                "width_deg": 0.0,
                "share": 0.75,
                "weibull_shape": 1.6,
                "weibull_scale_m_per_s": 4.0,
            },
        ],
        "icing": [
            {
                "kind": "glaze",
                "thickness_m": 0.012,
                "hours_a_year": 40.0,
                "hours_a_year_lowest": 20.0,
                "hours_a_year_highest": 80.0,
            },
            {
                "kind": "wet snow",
                "events_a_year": 2.0,
                "events_a_year_lowest": 1.0,
                "events_a_year_highest": 4.0,
                "event_hours": 20.0,
                "event_hours_lowest": 10.0,
                "event_hours_highest": 40.0,
                "wind_persistence_hours": 6.0,
                "wind_persistence_hours_lowest": 1.0,
                "wind_persistence_hours_highest": 12.0,
            },
        ],
    },
}
SHORT = {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [4.0, 6.0]}


def changed(path: str, value: Any, line: dict[str, Any] | None = None) -> dict[str, Any]:
    """Return a copy of a line, or of the full one, with one field by its dotted path set to a value."""
    document: dict[str, Any] = json.loads(json.dumps(line or FULL_LINE))  # shares no part with itself
    *way, last = path.split(".")
    node: Any = document
    for token in way:
        node = node[int(token)] if isinstance(node, list) else node.setdefault(token, {})
    if isinstance(node, list):
        node[int(last)] = value
    else:
        node[last] = value
    return document


def faults(document: object) -> list[Fault]:
    """Return every fault for which a request is refused; none if it is taken."""
    try:
        convert.read(document)
    except BadInput as error:
        return list(error.faults)
    return []


def close(row: dict[str, Any], expected: dict[str, Any]) -> bool:
    """Tell whether two rows have the same columns and words, and numbers that differ by rounding only."""

    def same(a: Any, b: Any) -> bool:
        if isinstance(a, float) and isinstance(b, float):
            return math.isclose(a, b, rel_tol=1e-6, abs_tol=1e-9)
        return bool(a == b)

    return row.keys() == expected.keys() and all(same(row[name], expected[name]) for name in row)
