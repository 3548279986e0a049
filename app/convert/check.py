"""What is wrong with a request beyond its schema: faults of the engine and of the study, as JSON pointers."""

from collections.abc import Iterable, Mapping, Sequence
from itertools import islice
from typing import Any, TypeVar

from pydantic import BaseModel, TypeAdapter, ValidationError

from app import schemas
from app.convert import study
from app.convert.assemble import SoundParts, gather
from app.faults import MOST_FAULTS, BadInput, Fault, faults_of, json_pointer
from engine import outcome

Part = TypeVar("Part", bound=BaseModel)

_DEVICE: TypeAdapter[schemas.Device] = TypeAdapter(schemas.Device)


def read(document: object) -> schemas.JobRequest:
    """Return a request that passes its schema and fits together.

    Raises
    ------
    BadInput
        With every fault of the schema and beyond it.
    """
    try:
        request = schemas.JobRequest.model_validate(document)
    except ValidationError as error:
        faults = faults_of(error.errors(include_url=False, include_input=False))
        raise BadInput(with_further_faults(document, faults)) from error
    faults = request_faults(request)
    if faults:
        raise BadInput(faults)
    return request


def check(document: Mapping[str, object]) -> list[Fault]:
    """Return every fault of a request document; none if it can be run."""
    try:
        read(document)
    except BadInput as error:
        return list(error.faults)
    return []


def request_faults(request: schemas.JobRequest) -> list[Fault]:
    """Return the faults that a request has beyond its schema."""
    _, _, found = gather(SoundParts.of(request.line), request.analysis)
    faults = _pointed(found, request.line, request.analysis)
    if not faults and request.study is not None:
        faults = list(islice(study.faults(request), MOST_FAULTS))
    return faults


def with_further_faults(document: object, faults: Sequence[Fault]) -> list[Fault]:
    """Add to the faults of the schema those of the combination of the sound parts of a request document."""
    body: Mapping[str, Any] = document if isinstance(document, dict) else {}
    raw = body.get("line")
    line: Mapping[str, Any] = raw if isinstance(raw, dict) else {}
    sound = _sound_parts(line)
    asked = _sound(schemas.Analysis, body.get("analysis", {}))
    _, _, found = gather(sound, asked)
    return [*faults, *_pointed(found, sound, asked)]


def _sound_parts(line: Mapping[str, Any]) -> SoundParts:
    devices = line.get("devices")
    return SoundParts(
        conductor=_sound(schemas.Conductor, line.get("conductor")),
        bundle=_sound(schemas.Bundle, line.get("bundle")),
        span=_sound(schemas.Span, line.get("span")),
        supports=_sound(schemas.Supports, line.get("supports")),
        ice=_sound(schemas.Ice, line.get("ice")),
        wind=_sound(schemas.Wind, line.get("wind")),
        damping=_sound(schemas.Damping, line.get("damping")),
        devices=[_sound_device(item) for item in devices[:200]] if isinstance(devices, list) else [],
    )


def _sound(model: type[Part], value: object) -> Part | None:
    try:
        return model.model_validate(value)
    except ValidationError:
        return None


def _sound_device(value: object) -> schemas.Device | None:
    try:
        return _DEVICE.validate_python(value)
    except ValidationError:
        return None


def _pointed(found: Iterable[outcome.Fault], line: object, analysis: object) -> list[Fault]:
    return [_to_pointer(fault, line, analysis) for fault in found]


def _to_pointer(fault: outcome.Fault, line: object, analysis: object) -> Fault:
    path = fault.field.split(".")
    if path[0] == "analysis":
        path = path[1:]
    root, node = ("analysis", analysis) if path[0] in schemas.Analysis.model_fields else ("line", line)
    value = "" if fault.value is None else f", got {str(fault.value)[:80]}"
    return Fault(json_pointer([root, *_json_names(node, path)]), "inconsistent", f"{fault.rule}{value}")


def _json_names(node: object, path: Sequence[str]) -> list[str]:
    """Turn the engine's names into the contract's by walking the models, whose attributes carry the engine's names."""
    names: list[str] = []
    for token in path:
        if isinstance(node, BaseModel):
            fields = type(node).model_fields
            aliases = {info.alias for info in fields.values()}
            if token not in fields and token not in aliases:
                break  # a rule of several fields: it is told of what holds them
            names.append((fields[token].alias or token) if token in fields else token)
            node = getattr(node, token, None)
        elif isinstance(node, Sequence) and token.isdecimal():
            names.append(token)
            node = node[int(token)] if int(token) < len(node) else None
        else:
            names.append(token)
            node = getattr(node, token, None)
    return names
