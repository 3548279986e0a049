"""Build a line and an analysis from their parts, and collect all faults of parts and combinations.

Where a part is not valid, a neutral part replaces it, so that rules about several parts are still checked for the other
parts. The neutral part itself causes no fault.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial
from typing import TypedDict, TypeVar

from app import schemas
from app.convert import parts
from engine import spec
from engine.outcome import Fault, InvalidSpec

Made = TypeVar("Made")
Source = TypeVar("Source")

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
        )


@dataclass(frozen=True, slots=True)
class Gathered:
    """The faults found so far, with paths from the root of the line or the analysis, and the paths of neutral parts."""

    faults: list[Fault] = field(default_factory=list)
    neutral: list[str] = field(default_factory=list)

    def make(self, path: str, source: Source | None, maker: Callable[[Source], Made], neutral: Made) -> Made:
        """Return what `maker` builds from a source, or the neutral part if there is no source or it is wrong."""
        return self.settle(path, None if source is None else self.attempt(f"{path}.", lambda: maker(source)), neutral)

    def settle(self, path: str, made: Made | None, neutral: Made) -> Made:
        """Return what was built, or the neutral part, whose faults are ignored."""
        if made is None:
            self.neutral.append(path)
            return neutral
        return made

    def attempt(self, prefix: str, make: Callable[[], Made]) -> Made | None:
        """Return what is built, or collect its faults and return None."""
        try:
            return make()
        except InvalidSpec as error:
            found = [replace(fault, field=_rooted(prefix, fault.field)) for fault in error.faults]
            self.faults.extend(fault for fault in found if not self._is_neutral(fault.field))
            return None

    def _is_neutral(self, path: str) -> bool:
        return any(f"{path}.".startswith(f"{place}.") for place in self.neutral)


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
        slack = list(_slack_faults(line))
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
    bare = replace(_without_physics(loops, more_loops, closure), loop_competition=competition)
    for choice in (bare, spec.with_physics(line, _NEUTRAL_ANALYSIS, parts.physics(options))):
        gathered.attempt("", partial(spec.check_compatible, line, choice))


@lru_cache  # all lines of a batch have the same options
def _without_physics(loops: tuple[int, ...], more_loops: tuple[int, ...], closure: spec.Closure) -> spec.Analysis:
    return replace(_NEUTRAL_ANALYSIS, loops=loops, finite_element_loops=more_loops, closure=closure)


def _values(sound: SoundParts, gathered: Gathered) -> _LineParts:
    return {
        "conductor": gathered.make("conductor", sound.conductor, parts.conductor, _NEUTRAL_CONDUCTOR),
        "bundle": gathered.make("bundle", sound.bundle, parts.bundle, spec.Bundle()),
        "span": gathered.make("span", sound.span, parts.span, _NEUTRAL_SPAN),
        "supports": gathered.make("supports", sound.supports, parts.supports, spec.Supports()),
        "ice": gathered.make("ice", sound.ice, lambda ice: _ice(ice, gathered), spec.Ice(_STILL)),
        "wind": gathered.make("wind", sound.wind, parts.wind, spec.Wind()),
        "damping": gathered.make("damping", sound.damping, parts.damping, _NEUTRAL_DAMPING),
        "devices": tuple(_device(i, part, gathered) for i, part in enumerate(sound.devices)),
        "climate": gathered.attempt("", partial(_climate, sound.climate)),
        "section": None if sound.section is None else _section(sound.section, gathered),
    }


def _climate(part: schemas.Climate | None) -> spec.Climate | None:
    return None if part is None else parts.climate(part)


def _device(index: int, part: schemas.Device | None, gathered: Gathered) -> spec.Device:
    path = f"devices.{index}"
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


def _section(section: schemas.Section, gathered: Gathered) -> spec.Section | None:
    made = gathered.make("section", section, parts.section, None)
    if made is None:
        return None
    own = [span.ice for span in section.spans]
    spans = tuple(
        replace(span, ice=None if ice is None else _ice_of_span(i, ice, gathered))
        for i, (span, ice) in enumerate(zip(made.spans, own, strict=True))
    )
    return replace(made, spans=spans)


def _ice_of_span(index: int, ice: schemas.Ice, gathered: Gathered) -> spec.Ice:
    alone = Gathered()
    made = alone.make("ice", ice, lambda part: _ice(part, alone), spec.Ice(_STILL))
    gathered.faults.extend(replace(fault, field=f"section.spans.{index}.{fault.field}") for fault in alone.faults)
    gathered.neutral.extend(f"section.spans.{index}.{path}" for path in alone.neutral)
    return made


def _apart_from_positions(values: _LineParts) -> spec.Line | None:
    """Return a line with a neutral span and conductor, to check rules that do not depend on positions or inertia."""
    other: _LineParts = {
        **values,
        "span": replace(_NEUTRAL_SPAN, elements=values["span"].elements),
        "conductor": _NEUTRAL_CONDUCTOR,
        "section": None,
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


def _rooted(prefix: str, path: str) -> str:
    """Prepend a prefix to a path unless the engine's path begins at the root already."""
    root = prefix.split(".", maxsplit=1)[0]
    return path if not prefix or path.split(".", maxsplit=1)[0] == root else prefix + path
