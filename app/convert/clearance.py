"""Ellipses of design practice, and the clearance that they and the computed motions leave between two phases."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal

from app.convert.run import specification_of_point
from app.schemas.faults import BadInput, Fault
from engine.outcome import InvalidSpec

EllipseMethodName = Literal["davison", "toye", "cigre", "aeso"]
MOTION = ("model", "loops", "wind_speed_m_per_s", "branch", "kind", "stability", "observed_at_m")

# Engine's name -> command-line option.
_OPTIONS = {"sag": "--sag-m", "span_length": "--span-m", "diameter": "--diameter-m", "subconductors": "--subconductors"}


def ellipse(
    method: str, sag: float, span_length: float | None, diameter: float | None, subconductors: int
) -> dict[str, float | None]:
    """Return both axes and B of a method's ellipse in metres, each None if the method gives no ellipse.

    Raises
    ------
    BadInput
        If a length is missing or not positive, or the number of sub-conductors is less than 1.
    """
    from engine.clearance import EllipseMethod, galloping_ellipse  # noqa: PLC0415 - `galloping --help` needs no numerics

    try:
        found = galloping_ellipse(EllipseMethod(method), sag, span_length, diameter, subconductors)
    except InvalidSpec as error:
        faults = [
            Fault(_OPTIONS[fault.field], "inconsistent", _sentence(fault.rule, fault.value)) for fault in error.faults
        ]
        raise BadInput(faults) from error
    return {
        "major_axis_m": found.major_axis if found else None,
        "minor_axis_m": found.minor_axis if found else None,
        "b_m": found.b_distance if found else None,
    }


def clearances(
    request: tuple[Mapping[str, object], int],
    found: Mapping[str, Sequence[Mapping[str, Any]]],
    offset: tuple[float, float],
    method: EllipseMethodName,
) -> dict[str, Any]:
    """Return the clearance between two phases that gallop alike, for each motion and for an ellipse.

    Parameters
    ----------
    request : tuple
        A request document and the number of a point.
    found : mapping
        The point's rows of `limit_cycles`, `orbits` and `static`.
    offset : tuple of float
        Position of the other phase: upward and downwind [m].
    method : str
        Method that gives the ellipse.

    Raises
    ------
    ValueError, LookupError
        If the line at this point is not valid, or there is no such point.
    """
    import numpy as np  # noqa: PLC0415 - the API and `galloping --help` need no numerics

    from engine import clearance as room  # noqa: PLC0415

    line, _ = specification_of_point(*request)
    positions, away = np.array(line.bundle.positions), np.array(offset)
    rows = []
    for orbit in found["orbits"]:
        cycle = found["limit_cycles"][orbit["cycle"]]
        series = np.array([orbit["vertical"], orbit["horizontal"], orbit["torsional"]])
        paths = room.subconductor_paths(series, positions)
        region = room.path_support(paths.reshape(-1, 2))
        height, width = room.extents(paths).tolist()
        left = float(room.clearance(region, region, away))
        rows.append({**{n: cycle[n] for n in MOTION}, "height_m": height, "width_m": width, "clearance_m": left})
    sag = found["static"][0]["sag_m"]
    ellipse = room.galloping_ellipse(
        room.EllipseMethod(method), sag, line.span.length, line.conductor.diameter, len(positions)
    )
    taken = room.ellipse_support(ellipse) if ellipse else None
    return {
        "motions": rows,
        "ellipse": {
            "method": method,
            "major_axis_m": ellipse.major_axis if ellipse else None,
            "minor_axis_m": ellipse.minor_axis if ellipse else None,
            "b_m": ellipse.b_distance if ellipse else None,
            "clearance_m": None if taken is None else float(room.clearance(taken, taken, away)),
        },
    }


def _sentence(rule: str, value: object) -> str:
    return rule if value is None else f"{rule}, got {value}"
