"""Remedies through the border: from their document to the engine, and their faults."""

import math
from collections.abc import Generator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from app import schemas
from app.convert import parts
from app.convert.pointers import at_names, json_names
from app.schemas.devices import tried_remedies as said
from app.schemas.faults import Fault
from engine import spec
from engine.outcome import Fault as EngineFault
from engine.outcome import InvalidSpec
from engine.progress import Progress
from engine.result import Result

if TYPE_CHECKING:
    from engine.known.description import KnownLine  # it loads numpy, which clients of the service need not have

_MOVED: Mapping[str, type[spec.PointDevice]] = {
    "spacer": spec.Spacer,
    "detuning_pendulum": spec.DetuningPendulum,
    "torsional_damper": spec.TorsionalDamper,
    "interphase_spacer": spec.InterphaseSpacer,
}


def remedies(part: schemas.Remedies) -> spec.Remedies:
    """Build what is to be tried.

    Raises
    ------
    InvalidSpec
        With the number of the remedy in the path.
    """
    if part.tried is None:
        return spec.Remedies(None, part.separation)
    tried: list[spec.Remedy] = []
    faults: list[EngineFault] = []
    for number, one in enumerate(part.tried):
        try:
            tried.append(_remedy(one))
        except InvalidSpec as error:
            faults += [replace(fault, field=f"tried.{number}.{fault.field}") for fault in error.faults]
    if faults:
        raise InvalidSpec(*faults)
    return spec.Remedies(tuple(tried), part.separation)


def _remedy(part: said.RemedyTried) -> spec.Remedy:
    if isinstance(part, said.TensionTried):
        return spec.ChangedTension(part.factor, part.horizontal_tension)
    if isinstance(part, said.DevicesMoved):
        return spec.MovedDevices(_MOVED[part.device], _places(part.positions))
    if isinstance(part, said.SpoilerTried):
        made = parts.aerodynamics(part.aerodynamics, part.at_rest)
        return spec.AddedSpoiler(spec.AirflowSpoiler(0.0, part.length, made, part.mass), part.position)
    count = part.count if part.positions is None else len(part.positions)
    return spec.AddedDevices(_device(part), count or 0, _places(part.positions))


def _device(
    part: said.PendulumsTried | said.SpacersTried | said.DampersTried | said.InterphaseSpacersTried,
) -> spec.PointDevice:
    if isinstance(part, said.PendulumsTried):
        return spec.DetuningPendulum(0.0, part.mass, part.arm, math.radians(part.angle))
    if isinstance(part, said.SpacersTried):
        return spec.Spacer(0.0, part.mass, part.polar_inertia)
    if isinstance(part, said.DampersTried):
        return spec.TorsionalDamper(0.0, part.mass, part.polar_inertia, part.coefficient)
    one, other = part.between
    return spec.InterphaseSpacer(0.0, part.mass, (one, other), part.axial_stiffness)


def _places(positions: list[float] | None) -> tuple[float, ...] | None:
    return None if positions is None else tuple(positions)


def remedies_faults(
    part: schemas.Remedies, line: spec.Line, analysis: spec.Analysis, known: "KnownLine | None"
) -> list[Fault]:
    """Return the faults of remedies on a line that is valid without them."""
    try:
        asked = remedies(part)
        spec.check_remedies(line, analysis, asked)
        tensions = _tension_faults(line, known, asked)
    except InvalidSpec as error:
        tensions = list(error.faults)
    return [_to_pointer(fault, part) for fault in tensions]


def _tension_faults(line: spec.Line, known: "KnownLine | None", asked: spec.Remedies) -> list[EngineFault]:
    """Return the faults of other tensions, which only the changed line shows."""
    found: list[EngineFault] = []
    for number, remedy in enumerate(asked.tried or ()):
        if not isinstance(remedy, spec.ChangedTension):
            continue
        try:
            _restrung(line, known, remedy, {})
        except InvalidSpec as error:
            name = "horizontal_tension" if remedy.factor is None else "factor"
            found += [replace(fault, field=f"tried.{number}.{name}") for fault in error.faults]
    return found


def _to_pointer(fault: EngineFault, part: schemas.Remedies) -> Fault:
    return at_names(fault, json_names(part, fault.field.rstrip(".").split(".")), "remedies")


def _restrung(
    line: spec.Line, known: "KnownLine | None", tension: spec.ChangedTension, chosen: Mapping[str, float]
) -> spec.Line:
    from engine.known.resolve import resolve_with_tension, with_tension  # noqa: PLC0415 - checking needs no numerics

    return with_tension(line, tension) if known is None else resolve_with_tension(known, tension, chosen).line


def compared(
    request: schemas.JobRequest, line: spec.Line, analysis: spec.Analysis, known: "KnownLine | None"
) -> Generator[Progress, None, Result]:
    """Return the comparison of a line with its remedies, not yet started; samples belong to a known line."""
    from app.convert.known.samples import in_document_names  # noqa: PLC0415 - the API needs no numerics to start
    from engine.known.resolve import resolve  # noqa: PLC0415
    from engine.studies.remedies import Subject, compare  # noqa: PLC0415
    from engine.uncertainty.weighing import Unknowns, intervals  # noqa: PLC0415

    assert request.remedies is not None, "only a request with remedies has a comparison"
    assumptions = () if known is None else resolve(known).assumptions

    def line_of(chosen: Mapping[str, float]) -> spec.Line:
        return line if known is None else spec.with_section(resolve(known, chosen).line, analysis.physics)

    def restrung(tension: spec.ChangedTension, chosen: Mapping[str, float]) -> spec.Line:
        return spec.with_section(_restrung(line, known, tension, chosen), analysis.physics)

    subject = Subject(line, Unknowns(intervals(assumptions), line_of), restrung)
    steps = compare(subject, analysis, remedies(request.remedies), parts.uncertainty(request.analysis.uncertainty))
    return in_document_names((yield from steps), assumptions)
