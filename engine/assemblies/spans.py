"""The spans of a section as lines of their own between dead ends, and what a section may not be. Theory section 16."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from engine.arrays import FloatArray
from engine.mechanics.along_span import mean_mass
from engine.mechanics.static_profile import StaticProfile, static_profile
from engine.outcome import Fault, InvalidSpec
from engine.spec import Ice, Line, Section, SectionSpan, Span, Support, Supports

SAME_WEIGHT = 1e-9  # relative difference of static weights that is none
_HELD = Supports(left=Support(dead_end=True), right=Support(dead_end=True))


def spans_of(line: Line) -> tuple[Line, ...]:
    """Return the spans of a section as single spans between dead ends, from left to right.

    All have the horizontal tension of the span of interest, since strings hang plumb. The devices are on that span.
    What a span does not say for itself, it has as the span of interest, with positions in proportion to its length.

    Raises
    ------
    InvalidSpec
        With paths from the root of the line, if the ice or the wind of a span does not fit on it.
    """
    section = _section(line)
    interest = replace(line, supports=_HELD, section=None)
    tension = float(static_profile([interest]).horizontal_tension[0])
    spans, faults = [], []
    for i, own in enumerate(section.spans):
        if i == section.span_of_interest - 1:
            spans.append(interest)
            continue
        try:
            spans.append(_span(line, own, tension))
        except InvalidSpec as error:
            faults += [replace(fault, field=f"section.spans.{i}.{_own_path(fault.field)}") for fault in error.faults]
    if faults:
        raise InvalidSpec(*faults)
    return tuple(spans)


def section_faults(line: Line) -> Iterator[Fault]:
    """Yield a fault for every part of a section that does not fit to the others.

    The ice of a span must lie on it, all spans must weigh the same, and every string must hang and be no longer than
    the larger sag beside it.
    """
    try:
        spans = spans_of(line)
    except InvalidSpec as error:
        yield from error.faults
        return
    weights = [mean_mass(span) for span in spans]
    own = mean_mass(line)
    for i, weight in enumerate(weights):
        if abs(weight - own) > SAME_WEIGHT * own:
            rule = (
                f"must give the mean mass per length of the span of interest ({own:.6g} kg/m): strings hang plumb only "
                "between spans of equal weight"
            )
            yield Fault(f"section.spans.{i}.ice.segments", weight, rule)
    profile = static_profile(spans)
    carried = carried_weights(spans, profile)
    for i, (string, weight) in enumerate(zip(_section(line).strings, carried.tolist(), strict=True)):
        sag = float(profile.sag[i : i + 2].max())
        if weight + 0.5 * string.weight <= 0.0:
            rule = f"must be more than twice the {-weight:.0f} N by which the conductors pull the string up"
            yield Fault(f"section.strings.{i}.weight", string.weight, rule)
        elif string.length > sag:
            rule = f"must not exceed the larger sag of the spans beside the string, which is {sag:.3g} m"
            yield Fault(f"section.strings.{i}.length", string.length, rule)


def carried_weights(spans: tuple[Line, ...], profile: StaticProfile) -> FloatArray:
    """Return P of each string, n H times the jump of the slope at its support: (strings,) [N].

    On level spans that is n p (S_left + S_right) / 2, the weight of half of both arcs.
    """
    right = np.sinh((profile.plane_span - profile.low_point) / profile.catenary_parameter)
    left = np.sinh(profile.low_point / profile.catenary_parameter)
    count = len(spans[0].bundle.positions)
    return np.asarray(count * profile.horizontal_tension[:-1] * (right[:-1] + left[1:]))


def _section(line: Line) -> Section:
    assert line.section is not None, "only a section has several spans"
    return line.section


def _span(line: Line, own: SectionSpan, tension: float) -> Line:
    share = own.length / line.span.length
    profile = tuple((x * share, phi) for x, phi in line.wind.profile) if own.profile is None else own.profile
    elements = line.span.elements
    return replace(
        line,
        span=Span(own.length, tension, elements=elements, level_difference=own.level_difference),
        ice=_in_proportion(line.ice, share) if own.ice is None else own.ice,
        wind=replace(line.wind, profile=profile),
        supports=_HELD,
        devices=(),
        section=None,
    )


def _in_proportion(ice: Ice, share: float) -> Ice:
    segments = (replace(s, start=s.start * share, stop=s.stop * share) for s in ice.segments)
    return replace(ice, segments=tuple(segments))


def _own_path(field: str) -> str:
    """Return the path of a field of a span's line as a path in `SectionSpan`."""
    for prefix in ("span.", "wind."):
        if field.startswith(prefix):
            return field.removeprefix(prefix)
    return field
