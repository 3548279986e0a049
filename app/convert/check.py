"""Find the faults of a request beyond its schema: those of the engine's rules and of the study, as JSON pointers."""

from collections.abc import Mapping, Sequence
from itertools import islice
from typing import Any

from pydantic import ValidationError

from app import schemas
from app.convert import study
from app.convert.assemble import SoundParts, gather
from app.convert.known import known_of
from app.convert.parts import placement
from app.convert.pointers import json_names, to_pointer
from app.convert.remedies import remedies_faults
from app.convert.sound_parts import SoundAxis, pruned, sound_analysis, sound_axes, sound_parts
from app.convert.study import Ground
from app.schemas.faults import MOST_FAULTS, BadInput, Fault, faults_of, json_pointer
from engine.outcome import InvalidSpec
from engine.spec import check_placement


def read(document: object) -> schemas.JobRequest:
    """Return a request that passes its schema and all rules.

    Raises
    ------
    BadInput
        With every fault of the schema and of the rules.
    """
    try:
        request = schemas.JobRequest.model_validate(document)
    except ValidationError as error:
        faults = faults_of(error.errors(include_url=False))
        raise BadInput(with_further_faults(document, faults)) from error
    faults = request_faults(request)
    if faults:
        raise BadInput(faults)
    return request


def request_faults(request: schemas.JobRequest) -> list[Fault]:
    """Return the faults of a request beyond its schema."""
    axes = request.study.axes if request.study else []
    sound = [SoundAxis(i, axis.parameters, list(enumerate(axis.values))) for i, axis in enumerate(axes)]
    parts = SoundParts.of(request.line)
    faults = _combined({}, parts, request.analysis, sound)
    return faults or _placement_faults(request) or _remedies_faults(request)


def _placement_faults(request: schemas.JobRequest) -> list[Fault]:
    """Return the faults of the placement of a request that is valid without it."""
    if request.placement is None:
        return []
    line, analysis, _ = gather(SoundParts.of(request.line), request.analysis)
    assert line is not None, "a line without faults was gathered"
    try:
        check_placement(line, analysis, placement(request.placement))
    except InvalidSpec as error:
        names = [json_names(request.placement, fault.field.split(".")) for fault in error.faults]
        pointers = [json_pointer(["placement", *path]) for path in names]
        placed = zip(pointers, error.faults, strict=True)
        return [Fault(pointer, "inconsistent", fault.rule) for pointer, fault in placed]
    return []


def _remedies_faults(request: schemas.JobRequest) -> list[Fault]:
    """Return the faults of the remedies of a request that is valid without them."""
    if request.remedies is None:
        return []
    line, analysis, _ = gather(SoundParts.of(request.line), request.analysis)
    assert line is not None, "a line without faults was gathered"
    return remedies_faults(request.remedies, line, analysis, known_of(request))


def with_further_faults(document: object, faults: Sequence[Fault]) -> list[Fault]:
    """Return the faults of the schema and those of combinations of the valid parts of a request document."""
    body: Mapping[str, Any] = pruned(document, faults) if isinstance(document, dict) else {}
    raw = body.get("line")
    line: Mapping[str, Any] = raw if isinstance(raw, dict) else {}
    options = sound_analysis(body.get("analysis", {}))
    return [*faults, *_combined(line, sound_parts(line), options, sound_axes(body.get("study")))]


def _combined(
    line: Mapping[str, Any], parts: SoundParts, options: schemas.Analysis | None, axes: Sequence[SoundAxis]
) -> list[Fault]:
    """Return the faults of valid parts together, and the faults that the axes of a study add."""
    _, _, found = gather(parts, options)
    faults = [to_pointer(fault, parts, options) for fault in found]
    if axes:
        ground = Ground.of(line, parts, options)
        faults += islice(study.faults(ground, axes), MOST_FAULTS)
    return faults
