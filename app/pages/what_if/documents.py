"""Places in the document of a line: read a number there, and set one in a copy."""

import json
from collections.abc import Iterator, Mapping
from typing import Any

from app.schemas.units import in_unit

Place = tuple[str | int, ...]
Line = Mapping[str, Any]


def number_at(document: Any, place: Place, unit: str) -> float | None:
    """Return the number at a place in a unit, whichever unit it is said in; None where there is none."""
    for step in place:
        if isinstance(step, int):
            document = document[step] if isinstance(document, list) and step < len(document) else None
        else:
            document = document.get(step) if isinstance(document, Mapping) else None
    found = in_unit(document, unit)
    return float(found) if isinstance(found, int | float) and not isinstance(found, bool) else None


def copy_of(document: Line) -> dict[str, Any]:
    """Return a copy of a document that may be changed."""
    made: dict[str, Any] = json.loads(json.dumps(document))
    return made


def put(document: dict[str, Any], place: Place, value: Any) -> None:
    """Set a value at a place of a document in place, with the objects that lead to it; lists must be long enough."""
    part: Any = document
    for step in place[:-1]:
        if isinstance(step, str) and part.get(step) is None:
            part[step] = {}
        part = part[step]
    part[place[-1]] = value


def pendulum(line: Line) -> int | None:
    """Return the number of the first detuning pendulum among the devices, None if there is none."""
    devices = line.get("devices") or []
    return next((i for i, device in enumerate(devices) if device.get("type") == "detuning_pendulum"), None)


def ties_phases(line: Line) -> bool:
    """Return whether an interphase spacer ties phases, which the finite element model alone computes."""
    return any(device.get("type") == "interphase_spacer" for device in line.get("devices") or ())


def places_along(line: Line) -> Iterator[Place]:
    """Yield the places of all distances along the span."""
    lists: tuple[Place, ...] = (("devices",), ("ice", "segments"), ("wind", "profile"))
    for at in lists:
        items: Any = line
        for step in at:
            items = (items or {}).get(step)
        for number in range(len(items or ())):
            yield from ((*at, number, name) for name in ("position_m", "from_m", "to_m"))
