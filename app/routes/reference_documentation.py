"""OpenAPI examples of fits, conductors, ice shapes and input fields."""

from typing import Any

from app.answers.reference import ConductorRow, FieldRow, IceShapeRow, TableRow
from app.schemas.fields import example_of

_MEASURED = (
    (20.0, -0.2734, 0.9778, -0.0643),
    (25.0, 0.0549, 0.9168, 0.0034),
    (30.0, 0.2279, 0.9404, 0.0041),
    (35.0, 0.2672, 1.0106, -0.0383),
    (40.0, 0.2000, 1.1000, -0.1000),
    (45.0, 0.0564, 1.1921, -0.1573),
    (50.0, -0.1327, 1.2814, -0.1862),
    (55.0, -0.3386, 1.3735, -0.1631),
    (60.0, -0.5365, 1.4836, -0.0641),
)
FIT_REQUEST: dict[str, Any] = {
    "table": [{"angle_deg": a, "lift": lift, "drag": drag, "moment": m} for a, lift, drag, m in _MEASURED],
    "static_angle_deg": 40.0,
    "half_range_deg": 20.0,
}
FIT_REQUESTS: dict[str, Any] = {"around-40": {"summary": "20 degrees to both sides of 40", "value": FIT_REQUEST}}
FIT: dict[str, Any] = {
    "aerodynamics": {
        "vertical": [-0.16671, -4.05441, 8.3584],
        "horizontal": [0.86061, 0.8328, 1.78088],
        "torsional": [-0.72712, 0.29402, 5.96977],
        "fitted_range_deg": 20.0,
    },
    "aerodynamics_at_rest": {"vertical": 0.19998, "horizontal": 1.09999, "torsional": -0.10002},
    "residual": {"vertical": 1e-05, "horizontal": 2e-05, "torsional": 2e-05},
    "rows_used": 9,
    "den_hartog": {"coefficient": -0.16671, "unstable": True},
    "doubts": [],
    "ice_direction_deg": 108.00089,
    "den_hartog_over_angle": [
        {"angle_deg": a, "coefficient": c, "unstable": c < 0.0}
        for a, c in (
            (20.0, 4.73984),
            (25.0, 3.78904),
            (30.0, 2.15679),
            (35.0, 0.85074),
            (40.0, -0.1078),
            (45.0, -0.71413),
            (50.0, -0.98178),
            (55.0, -0.9401),
            (60.0, -0.78417),
        )
    ],
}
CONDUCTORS: dict[str, Any] = {"conductors": [example_of(ConductorRow)]}
ICE_SHAPES: dict[str, Any] = {"ice_shapes": [example_of(IceShapeRow)]}
FIELDS: dict[str, Any] = {
    "fields": [example_of(FieldRow) | {"fewest_items": None, "most_items": None, "choices": None}],
}
TABLES: dict[str, Any] = {"tables": [example_of(TableRow)]}
