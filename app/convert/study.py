"""Studies: fields of the line by dotted JSON path, checked beforehand, set for every point."""

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import Any

from pydantic import ValidationError

from app import schemas
from app.convert.assemble import SoundParts, gather
from app.faults import Fault, faults_of, json_pointer

_UNVARIABLE = frozenset({"name", "asset_id", "tags"})


def points(study: schemas.Study | None) -> Iterator[dict[str, Any]]:
    """Yield the axes' values by parameter for every point, the last axis fastest; one empty point without axes."""
    axes = study.axes if study else []
    names = [axis.parameter for axis in axes]
    for values in itertools.product(*(axis.values for axis in axes)):
        yield dict(zip(names, values, strict=True))


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


def faults(request: schemas.JobRequest) -> Iterator[Fault]:
    """Yield what is wrong with the axes of a request whose line is sound, value by value, then point by point.

    Every combination is tried only if each value is sound by itself.
    """
    if request.study is None:
        return
    found = list(_axes_faults(request))
    yield from found
    if not found and len(request.study.axes) > 1:
        for values in points(request.study):
            yield from _point_faults(request, values, "/study/axes")


def _axes_faults(request: schemas.JobRequest) -> Iterator[Fault]:
    axes = request.study.axes if request.study else []
    document = request.line.model_dump(mode="json", by_alias=True)
    for i, axis in enumerate(axes):
        reason = _path_fault(document, axis.parameter.split("."))
        if reason:
            yield Fault(json_pointer(["study", "axes", i, "parameter"]), "unknown_parameter", reason)
            continue
        for j, value in enumerate(axis.values):
            yield from _point_faults(request, {axis.parameter: value}, json_pointer(["study", "axes", i, "values", j]))


def _point_faults(request: schemas.JobRequest, values: dict[str, Any], pointer: str) -> Iterator[Fault]:
    said = ", ".join(f"{name} = {value}" for name, value in values.items())
    try:
        line = varied(request.line, values)
    except ValidationError as error:
        for fault in faults_of(error.errors(include_url=False, include_input=False)):
            yield Fault(pointer, fault.code, f"with {said}: {fault}")
        return
    _, _, found = gather(SoundParts.of(line), request.analysis)
    for wrong in found:
        yield Fault(pointer, "inconsistent", f"with {said}: {wrong.field} {wrong.rule}")


def _path_fault(document: Any, path: Sequence[str]) -> str | None:
    """Say why a path leads to no number or word of a line document; None if it does."""
    if path[0] in _UNVARIABLE or path[-1] == "type":
        return "must lead to a number or a word that the analysis depends on"
    try:
        value = _at(document, path)
    except LookupError:
        return "leads to no field of this line; list items are named by their number from 0"
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
    """Return the key of a token in an object or a list.

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
