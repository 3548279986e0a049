"""The lines of the source (paper Tables 1 and 3), ready to run."""

import math
from typing import Any

_ARRANGEMENTS: dict[str, tuple[str, dict[str, Any]]] = {
    "c11-single": ("C11 single, 126 m", {"subconductors": 1, "radius_m": 0.0}),
    "c11-twin": ("C11 twin, 126 m", {"subconductors": 2, "radius_m": 0.2355, "orientation_deg": 90.0}),
    "c11-triple": ("C11 triple, 126 m", {"subconductors": 3, "radius_m": 0.2355, "orientation_deg": 0.0}),
    "c11-quad": ("C11 quad, 126 m", {"subconductors": 4, "radius_m": 0.2355, "orientation_deg": 45.0}),
}

EXAMPLE_NAMES = tuple(_ARRANGEMENTS)

# Young's modulus times the iced area. It reproduces the bundles' torsional frequencies of Table 2; the bare area is
# off by 3 to 7 % (theory.md section 9).
_AXIAL_RIGIDITY_N = 4.78033e10 * 594.48e-6


DIAMETER_M = 0.0286
"""Diameter of the bare conductor, over which the coefficients are taken [m]."""
_ECCENTRICITY_M = (2.05e-3, -0.63e-3)
COEFFICIENTS: dict[int, dict[str, list[float]]] = {
    40: {
        "vertical": [-0.1667, -4.0547, 8.3581],
        "horizontal": [0.8605, 0.8325, 1.7815],
        "torsional": [-0.7272, 0.2935, 5.9704],
    },
    270: {
        "vertical": [0.9423, -0.9245, 2.6352],
        "horizontal": [1.3186, -3.2000, -13.0623],
        "torsional": [-0.8567, 0.9026, -0.2353],
    },
}
"""Aerodynamic coefficients of one iced sub-conductor by angle of the ice [deg] (paper Table 3), per radian."""


def example(name: str, static_angle_deg: int = 40) -> dict[str, Any]:
    """Return the line document of one of `EXAMPLE_NAMES`.

    Parameters
    ----------
    name : str
    static_angle_deg : {40, 270}
        Angle of the ice [deg].

    Raises
    ------
    KeyError
        If there is no such example, or it has no coefficients at this angle.
    """
    title, bundle = _ARRANGEMENTS[name]
    return {
        "name": title,
        "tags": {"source": "c11"},
        "conductor": {
            "diameter_m": DIAMETER_M,
            "axial_rigidity_n": _AXIAL_RIGIDITY_N,
            "torsional_rigidity_n_m2": 101.0,
            "mass_kg_per_m": 2.379,
            "polar_inertia_kg_m": 3.334e-4,
        },
        "bundle": dict(bundle),
        "span": {"length_m": 125.88, "horizontal_tension_n": 30000.0, "elements": 10},
        "ice": _ice(static_angle_deg),
        "wind": {"air_density_kg_per_m3": 1.2929},
        "damping": {
            "vertical_ratio": 0.000515,
            "horizontal_ratio": 0.000515,
            "torsional_ratio": 0.308,
            "model": "constant_coefficient",
        },
    }


def _ice(static_angle_deg: int) -> dict[str, Any]:
    """Rotate the ice mass with its shape; Table 1 gives the mass centre at 40 degrees only (theory.md section 9)."""
    turn = math.radians(static_angle_deg - 40)
    up, downwind = _ECCENTRICITY_M
    return {
        "eccentricity_y_m": up * math.cos(turn) - downwind * math.sin(turn),
        "eccentricity_z_m": up * math.sin(turn) + downwind * math.cos(turn),
        "aerodynamics": {direction: list(row) for direction, row in COEFFICIENTS[static_angle_deg].items()},
    }
