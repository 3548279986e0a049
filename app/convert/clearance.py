"""Ellipses of design practice for the command line."""

from app.faults import BadInput, Fault
from engine.outcome import InvalidSpec

# What the engine names -> the option that gives it.
_OPTIONS = {"sag": "--sag-m", "span_length": "--span-m", "diameter": "--diameter-m", "subconductors": "--subconductors"}


def ellipse(
    method: str, sag: float, span_length: float | None, diameter: float | None, subconductors: int
) -> dict[str, float | None]:
    """Return both axes and B of the ellipse of a method, in metres; None for each if there is none.

    Raises
    ------
    BadInput
        If a length is missing or not positive, or there is no sub-conductor.
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


def _sentence(rule: str, value: object) -> str:
    return rule if value is None else f"{rule}, got {value}"
