"""Convert a table of measured coefficients, by the engine's fit, to coefficients for a line document."""

import math
from typing import Any

from app import schemas
from app.convert.pointers import json_names
from app.reference.coefficient_doubts import cubic_doubts, ice_direction, table_doubts
from app.schemas.faults import BadInput, Fault, json_pointer
from engine import spec
from engine.outcome import InvalidSpec

_DIRECTIONS = ("vertical", "horizontal", "torsional")


def doubts_of(coefficients: spec.Aerodynamics) -> list[str]:
    """Return the slips that the coefficients of a line show: those of their table, if they come from one."""
    table = coefficients.measured
    if table is None:
        return cubic_doubts({name: getattr(coefficients, name) for name in _DIRECTIONS})
    rows = zip(table.angle, table.lift, table.drag, table.moment, strict=True)
    return table_doubts([(math.degrees(angle), lift, drag, moment) for angle, lift, drag, moment in rows])


def fit(request: schemas.MeasuredCoefficients) -> dict[str, Any]:
    """Fit cubics to a table (theory section 5) and return the answer as plain values.

    Raises
    ------
    BadInput
        If too few rows lie in the range, or all of them lie on one side of the static angle.
    """
    import numpy as np  # noqa: PLC0415 - the API and `galloping --help` need no numerics

    from engine.mechanics.coefficients import CoefficientTable, den_hartog_coefficient, fit_coefficients  # noqa: PLC0415

    degrees = np.array([row.angle for row in request.table])
    rows = [(row.angle, row.lift, row.drag, row.moment) for row in request.table]
    columns = np.array([row[1:] for row in rows])
    table = CoefficientTable(np.radians(degrees), columns[:, 0], columns[:, 1], columns[:, 2])
    try:
        found = fit_coefficients(table, math.radians(request.static_angle), math.radians(request.half_range))
    except InvalidSpec as error:
        pointers = [(json_pointer(json_names(request, fault.field.split("."))), fault.rule) for fault in error.faults]
        raise BadInput([Fault(pointer, "inconsistent", rule) for pointer, rule in pointers]) from error
    made = found.aerodynamics
    names = _DIRECTIONS
    slope = made.vertical[0]
    over_angle = zip(degrees.tolist(), den_hartog_coefficient(table).tolist(), strict=True)
    return {
        "aerodynamics": {name: list(getattr(made, name)) for name in names}
        | {"fitted_range_deg": math.degrees(made.fitted_range or 0.0)},
        "aerodynamics_at_rest": dict(zip(names, made.at_rest or (), strict=True)),
        "residual": dict(zip(names, found.residual, strict=True)),
        "rows_used": found.rows,
        "den_hartog": {"coefficient": slope, "unstable": slope < 0.0},
        "doubts": table_doubts(rows),
        "ice_direction_deg": ice_direction(rows),
        "den_hartog_over_angle": [{"angle_deg": a, "coefficient": c, "unstable": c < 0.0} for a, c in over_angle],
    }
