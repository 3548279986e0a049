"""Find the valid parts of a request document that fails its schema, so that the other rules can still be checked."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

from pydantic import BaseModel, TypeAdapter, ValidationError

from app import schemas
from app.convert.assemble import SoundParts
from app.schemas.faults import Fault
from app.schemas.fields import Document
from app.schemas.known.parts import as_in
from app.schemas.request import STUDY_POINTS_LIMIT, AxisValue

Part = TypeVar("Part", bound=BaseModel)

PARTS = ("conductor", "bundle", "span", "supports", "ice", "wind", "damping")

_MOST_AXES = 2
_MOST_DEVICES = 200
_DEVICE: TypeAdapter[schemas.Device] = TypeAdapter(schemas.Device)
_PHASES: TypeAdapter[list[schemas.Phase]] = TypeAdapter(list[schemas.Phase])
_AXIS_VALUE: TypeAdapter[Any] = TypeAdapter(AxisValue)


@dataclass(frozen=True, slots=True)
class SoundAxis:
    """An axis of a study: its number, the fields that it varies, and its valid values with their numbers."""

    number: int
    parameters: Sequence[str]
    values: Sequence[tuple[int, Any]]


def pruned(document: Mapping[str, Any], faults: Iterable[Fault]) -> Mapping[str, Any]:
    """Return a document without the unknown fields that these faults name, so that they hide no other faults."""
    pointers = [fault.pointer for fault in faults if fault.code == "unknown_field"]
    paths = [[token.replace("~1", "/").replace("~0", "~") for token in text.split("/")[1:]] for text in pointers]
    without: Mapping[str, Any] = _without(document, paths)
    return without


def _without(node: Any, paths: Iterable[Sequence[str]]) -> Any:
    """Return a copy without the nodes at the end of the paths; copy only nodes on a path."""
    below: dict[str, list[Sequence[str]]] = defaultdict(list)
    for path in paths:
        if path:
            below[path[0]].append(path[1:])
    if isinstance(node, list):
        return [_without(item, below[str(i)]) if str(i) in below else item for i, item in enumerate(node)]
    if not isinstance(node, dict):
        return node
    kept = {name: value for name, value in node.items() if [] not in below.get(name, ())}
    return {name: _without(value, below[name]) if name in below else value for name, value in kept.items()}


def sound_parts(line: Mapping[str, Any]) -> SoundParts:
    """Return the parts of a line document that pass their schema; an absent part has its default."""
    devices = line.get("devices")
    return SoundParts(
        conductor=_part(schemas.Conductor, line, "conductor"),
        bundle=_part(schemas.Bundle, line, "bundle"),
        span=_part(schemas.Span, line, "span"),
        supports=_part(schemas.Supports, line, "supports"),
        ice=_part(schemas.Ice, line, "ice"),
        wind=_part(schemas.Wind, line, "wind"),
        damping=_part(schemas.Damping, line, "damping"),
        devices=[_device(item) for item in devices[:_MOST_DEVICES]] if isinstance(devices, list) else [],
        climate=_sound(schemas.Climate, line["climate"]) if line.get("climate") is not None else None,
        section=_part(schemas.Section, line, "section"),
        phases=_phases(line.get("phases", [])),
        required_clearance=_clearance(line.get("required_clearance_m")),
        design_wind=_design_wind(line.get("design_wind_m_per_s")),
    )


def sound_analysis(value: object) -> schemas.Analysis | None:
    """Return an analysis of the options that are valid by themselves; None if the value is not an object."""
    if not isinstance(value, dict):
        return None
    choices: dict[str, Any] = {}
    for name, field in schemas.Analysis.model_fields.items():
        key = field.alias or name
        if key not in value:
            continue
        if _sound(schemas.Analysis, {key: value[key]}) is not None:
            choices[key] = value[key]
        elif name in {"loops", "finite_element_loops"}:
            choices[key] = [1]  # every line has enough elements for one loop, but perhaps not for the default
    return _sound(schemas.Analysis, choices)


def sound_axes(study: object) -> list[SoundAxis]:
    """Return the axes of a study document whose parameter is valid, with their valid values."""
    axes = study.get("axes") if isinstance(study, dict) else None
    if not isinstance(axes, list):
        return []
    found = (_axis(number, axis) for number, axis in enumerate(axes[:_MOST_AXES]) if isinstance(axis, dict))
    return [axis for axis in found if axis is not None]


def _axis(number: int, axis: Mapping[str, Any]) -> SoundAxis | None:
    fields = {name: axis[name] for name in ("parameter", "also") if name in axis}
    named = _sound(schemas.Axis, {**fields, "values": [0]})
    if named is None:
        return None
    values = axis.get("values")
    listed = values[:STUDY_POINTS_LIMIT] if isinstance(values, list) else []
    return SoundAxis(number, named.parameters, [(j, value) for j, value in enumerate(listed) if _is_axis_value(value)])


def _is_axis_value(value: object) -> bool:
    try:
        _AXIS_VALUE.validate_python(value)
    except ValidationError:
        return False
    return True


def _part(model: type[Part], line: Mapping[str, Any], name: str) -> Part | None:
    default = schemas.Line.model_fields[name].default
    return default if name not in line and isinstance(default, model) else _sound(model, line.get(name))


def _sound(model: type[Part], value: object) -> Part | None:
    try:
        return model.model_validate(value)
    except ValidationError:
        return None


def _device(value: object) -> schemas.Device | None:
    try:
        return _DEVICE.validate_python(value)
    except ValidationError:
        return None


def _phases(value: object) -> list[schemas.Phase] | None:
    """Return all phases, None if one of them does not pass its schema."""
    try:
        return _PHASES.validate_python(value)
    except ValidationError:
        return None


class _DesignWind(Document):
    """The design wind of a line by itself."""

    design_wind: float | None = as_in(schemas.Line, "design_wind")


def _design_wind(value: object) -> float | None:
    sound = _sound(_DesignWind, {"design_wind_m_per_s": value})
    return None if sound is None else sound.design_wind


def _clearance(value: object) -> float | None:
    sound = _sound(schemas.Phase, {"name": "sound", "y_m": 0.0, "required_clearance_m": value})
    return None if sound is None else sound.required_clearance
