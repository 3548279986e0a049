"""Build a line and an analysis from their parts, and collect all faults of parts and combinations.

Where a part is not valid, a neutral part replaces it, so that rules about several parts are still checked for the other
parts. The neutral part itself causes no fault.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import TypedDict

from app import schemas
from app.convert import parts
from app.convert.gathered import Gathered
from engine import spec
from engine.outcome import Fault, InvalidSpec

_STEEPEST = 100.0  # far beyond a sag equal to the length, and far below overflow
_STILL = spec.Aerodynamics((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), at_rest=(0.0, 0.0, 0.0))
_NEUTRAL_CONDUCTOR = spec.Conductor(0.03, 1e7, 100.0, 1e-3, 1e3)
_NEUTRAL_SPAN = spec.Span(1e9, horizontal_tension=1e4, elements=1000)
_NEUTRAL_DAMPING = spec.Damping(0.01, 0.01, 0.01)
_NEUTRAL_DEVICE: spec.Device = spec.Spacer(0.0, 0.0, 0.0)
_NEUTRAL_ANALYSIS = spec.Analysis(loops=(1,), finite_element_loops=(1,))


class _LineParts(TypedDict):
    conductor: spec.Conductor
    bundle: spec.Bundle
    span: spec.Span
    supports: spec.Supports
    ice: spec.Ice
    wind: spec.Wind
    damping: spec.Damping
    devices: tuple[spec.Device, ...]
    climate: spec.Climate | None
    section: spec.Section | None
    phases: tuple[spec.Phase, ...]
    required_clearance: float | None
    design_wind: float | None


@dataclass(frozen=True, slots=True)
class SoundParts:
    """The parts of a line document that pass their schema; None for a part that does not, and for no section."""

    conductor: schemas.Conductor | None
    bundle: schemas.Bundle | None
    span: schemas.Span | None
    supports: schemas.Supports | None
    ice: schemas.Ice | None
    wind: schemas.Wind | None
    damping: schemas.Damping | None
    devices: Sequence[schemas.Device | None]
    climate: schemas.Climate | None = None
    section: schemas.Section | None = None
    phases: Sequence[schemas.Phase] | None = ()
    required_clearance: float | None = None
    design_wind: float | None = None

    @classmethod
    def of(cls, line: schemas.Line) -> "SoundParts":
        """Return the parts of a line that passes its schema."""
        return cls(
            conductor=line.conductor,
            bundle=line.bundle,
            span=line.span,
            supports=line.supports,
            ice=line.ice,
            wind=line.wind,
            damping=line.damping,
            devices=line.devices,
            climate=line.climate,
            section=line.section,
            phases=line.phases,
            required_clearance=line.required_clearance,
            design_wind=line.design_wind,
        )


def gather(sound: SoundParts, options: schemas.Analysis | None) -> tuple[spec.Line | None, spec.Analysis, list[Fault]]:
    """Build a line and an analysis, and return all faults of each and of their combination.

    Returns
    -------
    line : Line or None
        Use it only if there are no faults.
    analysis : Analysis
        Use it only if there are no faults.
    faults : list of Fault
        Faults with dotted paths from the root of the line or of the analysis.
    """
    gathered = Gathered()
    values = _values(sound, gathered)
    line = gathered.attempt("", lambda: spec.Line(**values))
    if line is not None and not gathered.neutral:
        slack = [*_slack_faults(line), *_slack_phases(line)]
        gathered.faults.extend(slack or [*_string_faults(line), *_section_faults(line)])
        if options is not None and options.risk and sound.climate is None:
            gathered.faults.append(Fault("climate", None, "must be given for a risk"))
    analysis = gathered.make("analysis", options, parts.analysis, _NEUTRAL_ANALYSIS)
    comparable = line or _apart_from_positions(values)
    if comparable is not None and options is not None:
        _compare(gathered, comparable, options)
        if "analysis" not in gathered.neutral:
            with_physics = partial(spec.with_physics, comparable, analysis, parts.physics(options))
            analysis = gathered.attempt("analysis.", with_physics) or _NEUTRAL_ANALYSIS
    line = None if line is None else spec.with_section(line, analysis.physics)
    return line, analysis, gathered.faults


def _compare(gathered: Gathered, line: spec.Line, options: schemas.Analysis) -> None:
    """Check a line against the options of an analysis, and apart from these against its physics, to find all faults."""
    loops, more_loops = tuple(options.loops), tuple(options.finite_element_loops)
    closure, competition = spec.Closure(options.closure), spec.LoopCompetition(options.loop_competition)
    apart = Gathered()  # the analysis by itself says what is wrong with its loops
    own = apart.attempt("", lambda: _without_physics(loops, more_loops, closure)) or _NEUTRAL_ANALYSIS
    bare = replace(
        own,
        loop_competition=competition,
        models=tuple(spec.Model(model) for model in options.models),
        device_effect=spec.DeviceEffect(options.device_effect),
    )
    physical = apart.attempt("", lambda: spec.with_physics(line, _NEUTRAL_ANALYSIS, parts.physics(options)))
    for choice in (bare, physical or _NEUTRAL_ANALYSIS):
        gathered.attempt("", partial(spec.check_compatible, line, choice))


@lru_cache  # all lines of a batch have the same options
def _without_physics(loops: tuple[int, ...], more_loops: tuple[int, ...], closure: spec.Closure) -> spec.Analysis:
    return replace(_NEUTRAL_ANALYSIS, loops=loops, finite_element_loops=more_loops, closure=closure)


def _values(sound: SoundParts, gathered: Gathered) -> _LineParts:
    values: _LineParts = {
        "conductor": gathered.make("conductor", sound.conductor, parts.conductor, _NEUTRAL_CONDUCTOR),
        "bundle": gathered.make("bundle", sound.bundle, parts.bundle, spec.Bundle()),
        "span": gathered.make("span", sound.span, parts.span, _NEUTRAL_SPAN),
        "supports": gathered.make("supports", sound.supports, parts.supports, spec.Supports()),
        "ice": gathered.make("ice", sound.ice, lambda ice: _ice(ice, gathered), spec.Ice(_STILL)),
        "wind": gathered.make("wind", sound.wind, parts.wind, spec.Wind()),
        "damping": gathered.make("damping", sound.damping, parts.damping, _NEUTRAL_DAMPING),
        "climate": gathered.attempt("", partial(_climate, sound.climate)),
        "devices": tuple(_device(f"devices.{i}", part, gathered) for i, part in enumerate(sound.devices)),
        "section": None if sound.section is None else _section(sound.section, gathered),
        "phases": (),
        "required_clearance": sound.required_clearance,
        "design_wind": sound.design_wind,
    }
    if sound.phases is None:  # then nothing is said of the phases that spacers name
        gathered.neutral.append("phases")
        return {**values, "devices": _without_interphase_spacers(values["devices"])}
    phases = (_phase(i, part, values, gathered) for i, part in enumerate(sound.phases))
    return {**values, "phases": tuple(phases)}


def _climate(part: schemas.Climate | None) -> spec.Climate | None:
    return None if part is None else parts.climate(part)


def _phase(index: int, part: schemas.Phase, values: _LineParts, gathered: Gathered) -> spec.Phase:
    """Build a phase; a neutral one lies beyond all others under the same name."""
    path = f"phases.{index}"
    ice = None if part.ice is None else _ice_at(f"{path}.ice", part.ice, gathered)
    own = None if part.line is None else _line_of_phase(path, part.line, values, gathered)
    made = gathered.attempt(
        f"{path}.", lambda: spec.Phase(part.name, part.y, part.z, part.required_clearance, ice, own)
    )
    return gathered.settle(path, made, spec.Phase(part.name, 1e8 * (index + 1), 0.0))


def _line_of_phase(path: str, part: schemas.PhaseLine, values: _LineParts, gathered: Gathered) -> spec.Line | None:
    """Build the line of a phase from its own parts and those of the line."""
    devices = tuple(device for device in values["devices"] if not isinstance(device, spec.InterphaseSpacer))
    own: _LineParts = {**values, "section": None, "devices": devices}
    if part.conductor is not None:
        own["conductor"] = gathered.make(f"{path}.line.conductor", part.conductor, parts.conductor, own["conductor"])
    if part.bundle is not None:
        own["bundle"] = gathered.make(f"{path}.line.bundle", part.bundle, parts.bundle, own["bundle"])
    if part.span is not None:
        own["span"] = gathered.make(f"{path}.line.span", part.span, parts.span, own["span"])
    if part.supports is not None:
        own["supports"] = gathered.make(f"{path}.line.supports", part.supports, parts.supports, own["supports"])
    if part.ice is not None:
        own["ice"] = _ice_at(f"{path}.line.ice", part.ice, gathered)
    if part.devices is not None:
        prefix = f"{path}.line.devices"
        own["devices"] = tuple(_device(f"{prefix}.{i}", device, gathered) for i, device in enumerate(part.devices))
    return gathered.attempt(f"{path}.line.", lambda: spec.Line(**own))


def _without_interphase_spacers(devices: tuple[spec.Device, ...]) -> tuple[spec.Device, ...]:
    return tuple(_NEUTRAL_DEVICE if isinstance(device, spec.InterphaseSpacer) else device for device in devices)


def _device(path: str, part: schemas.Device | None, gathered: Gathered) -> spec.Device:
    if part is None:
        return gathered.settle(path, None, _NEUTRAL_DEVICE)
    return gathered.settle(path, gathered.attempt(f"{path}.", lambda: parts.device(part)), _NEUTRAL_DEVICE)


def _ice(ice: schemas.Ice, gathered: Gathered) -> spec.Ice:
    # Neutral segments lie beyond every span and do not overlap.
    segments = tuple(
        gathered.make(f"ice.segments.{i}", part, parts.segment, spec.IceSegment(1e8 + i, 1e8 + i + 0.5))
        for i, part in enumerate(ice.segments)
    )
    coefficients = parts.aerodynamics(ice.aerodynamics, ice.at_rest)
    return spec.Ice(coefficients, ice.eccentricity_y, ice.eccentricity_z, segments)


def section_with_ice(section: schemas.Section) -> spec.Section:
    """Build a section by itself.

    Raises
    ------
    InvalidSpec
        With the faults of all its parts.
    """
    gathered = Gathered()
    made = _section(section, gathered)
    if made is None or gathered.faults:
        raise InvalidSpec(*gathered.faults)
    return made


def _section(section: schemas.Section, gathered: Gathered) -> spec.Section | None:
    made = gathered.make("section", section, parts.section, None)
    if made is None:
        return None
    own = [span.ice for span in section.spans]
    spans = tuple(
        replace(span, ice=None if ice is None else _ice_at(f"section.spans.{i}.ice", ice, gathered))
        for i, (span, ice) in enumerate(zip(made.spans, own, strict=True))
    )
    return replace(made, spans=spans)


def _ice_at(path: str, ice: schemas.Ice, gathered: Gathered) -> spec.Ice:
    """Build ice at a path that ends with "ice"."""
    root = path.removesuffix("ice")
    alone = Gathered()
    made = alone.make("ice", ice, lambda part: _ice(part, alone), spec.Ice(_STILL))
    gathered.faults.extend(replace(fault, field=f"{root}{fault.field}") for fault in alone.faults)
    gathered.neutral.extend(f"{root}{place}" for place in alone.neutral)
    return made


def _apart_from_positions(values: _LineParts) -> spec.Line | None:
    """Return a line with a neutral span and conductor, to check rules that do not depend on positions or inertia."""
    other: _LineParts = {
        **values,
        "span": replace(_NEUTRAL_SPAN, elements=values["span"].elements),
        "conductor": _NEUTRAL_CONDUCTOR,
        "section": None,
        "phases": (),
        "devices": _without_interphase_spacers(values["devices"]),
    }
    return Gathered().attempt("", lambda: spec.Line(**other))


def _slack_faults(line: spec.Line) -> Iterator[Fault]:
    """Refuse a span that sags more than its length: no line does, and the catenary would overflow."""
    span = line.span
    if span.sag is not None:
        field_name, sag = "sag", span.sag
    elif span.catenary_parameter is not None:
        field_name, sag = "catenary_parameter", _sag(span.length, span.catenary_parameter)
    else:
        tension = span.horizontal_tension or 0.0
        field_name, sag = "horizontal_tension", _sag(span.length, tension / (line.conductor.mass * spec.GRAVITY))
    if sag > span.length:
        yield Fault(f"span.{field_name}", getattr(span, field_name), "must give a sag smaller than the span's length")


def _slack_phases(line: spec.Line) -> Iterator[Fault]:
    for i, phase in enumerate(line.phases):
        for fault in _slack_faults(phase.line) if phase.line else ():
            yield replace(fault, field=f"phases.{i}.line.{fault.field}")


def _string_faults(line: spec.Line) -> Iterator[Fault]:
    if line.span.level_difference != 0.0:
        from engine.mechanics.static_profile import string_faults  # noqa: PLC0415 - level spans need no numerics

        yield from string_faults(line)


def _section_faults(line: spec.Line) -> Iterator[Fault]:
    if line.section is not None:
        from engine.assemblies.spans import section_faults  # noqa: PLC0415 - a span alone needs no numerics

        yield from section_faults(line)


def _sag(length: float, catenary_parameter: float) -> float:
    ratio = 0.5 * length / catenary_parameter
    return catenary_parameter * (math.cosh(ratio) - 1.0) if ratio < _STEEPEST else math.inf
