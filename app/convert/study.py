"""Studies: check fields of the line by dotted JSON path beforehand, and set them at every point."""

import copy
import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel, ValidationError

from app import schemas
from app.convert.assemble import SoundParts, gather
from app.convert.pointers import to_pointer
from app.convert.sound_parts import PARTS, SoundAxis, sound_parts
from app.schemas.faults import Fault, faults_of, json_pointer
from app.schemas.request import STUDY_POINTS_LIMIT

_UNVARIABLE = frozenset({"name", "asset_id", "tags"})


def points(study: schemas.Study | None) -> Iterator[dict[str, Any]]:
    """Yield for every point the axes' values by parameter, the last axis fastest; without axes one empty point."""
    axes = study.axes if study else []
    names = [axis.parameter for axis in axes]
    for values in itertools.product(*(axis.values for axis in axes)):
        yield dict(zip(names, values, strict=True))


def settings(study: schemas.Study | None, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the value of every field that a point sets, including fields that follow an axis."""
    axes = study.axes if study else []
    return {name: values[axis.parameter] for axis in axes for name in axis.parameters}


def count(study: schemas.Study | None) -> int:
    """Return the number of points."""
    return math.prod(len(axis.values) for axis in study.axes) if study else 1


def varied(line: schemas.Line, values: dict[str, Any]) -> schemas.Line:
    """Return a line with some fields set to other values.

    Raises
    ------
    pydantic.ValidationError
        If a field cannot take its value.
    LookupError
        If there is no such field.
    """
    if not values:
        return line
    document = line.model_dump(mode="json", by_alias=True)
    for path, value in values.items():
        _set(document, path.split("."), value)
    return schemas.Line.model_validate(document)


@dataclass(frozen=True, slots=True)
class Ground:
    """A line document that a study varies: valid parts with their defaults, other parts unchanged, and its own faults.

    `unsound` holds the paths of parts and devices that fail their schema. `known` holds the pointers of faults without
    the study, which no value of an axis causes.
    """

    document: dict[str, Any]
    unsound: frozenset[tuple[str, ...]]
    options: schemas.Analysis | None
    known: frozenset[str]

    @classmethod
    def of(cls, line: Mapping[str, Any], parts: SoundParts, options: schemas.Analysis | None) -> "Ground":
        """Take a line document, its valid parts, and the valid options of the analysis."""
        document: dict[str, Any] = {"devices": []}
        unsound: set[tuple[str, ...]] = set()
        for name in PARTS:
            part = getattr(parts, name)
            document[name] = line.get(name) if part is None else _dumped(part)
            unsound |= {(name,)} if part is None else set()
        for number, device in enumerate(parts.devices):
            document["devices"].append(line["devices"][number] if device is None else _dumped(device))
            unsound |= {("devices", str(number))} if device is None else set()
        if parts.climate is not None:
            document["climate"] = _dumped(parts.climate)
        elif line.get("climate") is not None:
            document["climate"] = line["climate"]
            unsound.add(("climate",))
        if parts.section is not None:
            document["section"] = _dumped(parts.section)
        elif line.get("section") is not None:
            document["section"] = line["section"]
            unsound.add(("section",))
        if parts.phases is None:
            document["phases"] = line["phases"]
            unsound.add(("phases",))
        else:
            document["phases"] = [_dumped(phase) for phase in parts.phases]
        for name in ("required_clearance_m", "design_wind_m_per_s"):
            document[name] = line.get(name)
        if not isinstance(line.get("devices", []), list):
            unsound.add(("devices",))
        known = {fault.pointer for fault in _document_faults(document, options)}
        return cls(document, frozenset(unsound), options, frozenset(known))

    def is_unsound(self, path: Sequence[str]) -> bool:
        """Tell whether a path leads into a part that is not valid, so that its defaults are unknown."""
        return tuple(path[:1]) in self.unsound or tuple(path[:2]) in self.unsound


def faults(ground: Ground, axes: Sequence[SoundAxis]) -> Iterator[Fault]:
    """Yield the faults of the axes of a study, value by value and then point by point, except the line's own faults.

    Combinations are checked only if each value alone is valid.
    """
    found = False
    for axis in axes:
        for fault in _axis_faults(ground, axis):
            found = True
            yield fault
    if found or len(axes) < 2 or math.prod(len(axis.values) for axis in axes) > STUDY_POINTS_LIMIT:
        return
    for combination in itertools.product(*(axis.values for axis in axes)):
        values = {name: value for axis, (_, value) in zip(axes, combination, strict=True) for name in axis.parameters}
        yield from _point_faults(ground, values, "/study/axes")


def _axis_faults(ground: Ground, axis: SoundAxis) -> Iterator[Fault]:
    wrong = False
    for number, name in enumerate(axis.parameters):
        if reason := _path_fault(ground, name.split(".")):
            wrong = True
            place = ["parameter"] if number == 0 else ["also", number - 1]
            yield Fault(json_pointer(["study", "axes", axis.number, *place]), "unknown_parameter", reason)
    if wrong:
        return
    for j, value in axis.values:
        pointer = json_pointer(["study", "axes", axis.number, "values", j])
        yield from _point_faults(ground, dict.fromkeys(axis.parameters, value), pointer)


def _point_faults(ground: Ground, values: dict[str, Any], pointer: str) -> Iterator[Fault]:
    """Yield the faults that the line has only with these values."""
    assignment = ", ".join(f"{name} = {value}" for name, value in values.items())
    own = {json_pointer(["line", *name.split(".")]) for name in values}
    document = copy.deepcopy(ground.document)
    try:
        for name, value in values.items():
            _set(document, name.split("."), value)
    except LookupError:
        return  # the field is missing in a part that is not valid
    for fault in _document_faults(document, ground.options):
        if fault.pointer in own or fault.pointer not in ground.known:
            yield Fault(pointer, fault.code, f"with {assignment}: {fault}")


def _document_faults(document: Mapping[str, Any], options: schemas.Analysis | None) -> list[Fault]:
    """Return the faults of a line document, those of its schema first."""
    wrong: list[Fault] = []
    try:
        parts = SoundParts.of(schemas.Line.model_validate(document))
    except ValidationError as error:
        wrong = faults_of(error.errors(include_url=False, include_input=False), root="/line")
        parts = sound_parts(document)
    _, _, found = gather(parts, options)
    return [*wrong, *(to_pointer(fault, parts, options) for fault in found)]


def _dumped(part: BaseModel) -> Any:
    return part.model_dump(mode="json", by_alias=True)


def _path_fault(ground: Ground, path: Sequence[str]) -> str | None:
    """Return why a path leads to no number or word of a line document; None if it does, or if that is unknown yet."""
    if path[0] in _UNVARIABLE or path[-1] == "type":
        return "must lead to a number or a word that affects the analysis"
    try:
        value = _at(ground.document, path)
    except LookupError:
        if ground.is_unsound(path):
            return None
        return "leads to no field of this line; use a number from 0 for a list item"
    if isinstance(value, bool | dict | list):
        return "must lead to a single number or word"
    return None


def _at(document: Any, path: Sequence[str]) -> Any:
    for token in path:
        document = document[_key(document, token)]
    return document


def _set(document: Any, path: Sequence[str], value: object) -> None:
    parent = _at(document, path[:-1])
    parent[_key(parent, path[-1])] = value


def _key(document: object, token: str) -> str | int:
    """Return the key or index for a token in an object or a list.

    Raises
    ------
    LookupError
        If there is none.
    """
    if isinstance(document, list) and token.isdecimal() and int(token) < len(document):
        return int(token)
    if isinstance(document, dict) and token in document:
        return token
    raise LookupError(token)
