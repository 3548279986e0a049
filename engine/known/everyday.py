"""The iced span from its everyday state."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from engine.known.change_of_state import HungSpan, HungState, LoadState, change_of_state, hung_state, tension_of_sag
from engine.known.description import EverydayState, KnownLine, KnownSpan
from engine.known.estimate import Estimate
from engine.known.provenance import Assumption, Provenance, assumed, computed, given
from engine.outcome import Fault, InvalidSpec, require
from engine.spec import GRAVITY, Span

USUAL_SHARE = Estimate(
    0.2, "", 0.15, 0.25, "assumed: lines are usually strung to some 20 % of the rated strength; range 15 to 25 %"
)
USUAL_TEMPERATURE = Estimate(15.0, "degC", 5.0, 25.0, "assumed: 15 degrees Celsius; range 5 to 25")
ICING_TEMPERATURE = Estimate(
    -3.0, "degC", -10.0, 0.0, "assumed: ice grows a few degrees below freezing; range -10 to 0"
)


@dataclass(frozen=True, slots=True)
class IcedSpan:
    """The span with its iced tension, the values that it follows from, and both states."""

    span: Span
    rows: Provenance
    everyday: HungState
    iced: HungState


def iced_span(
    line: KnownLine, known: KnownSpan, values: Provenance, mass: float, chosen: Mapping[str, float]
) -> IcedSpan:
    """Return the span under ice in still air.

    Parameters
    ----------
    line : KnownLine
        Its section has a ruling span, or else its adjacent spans estimate one.
    known : KnownSpan
        The span of the line.
    values : Provenance
        The values of the conductor.
    mass : float
        Of the iced sub-conductor per length [kg/m].
    chosen : mapping
        Values that replace assumed ones, by path.

    Raises
    ------
    InvalidSpec
        If the rated strength is needed and not known, a tension exceeds it, or the span has no such state.
    """
    rows = Provenance().extended(_conditions(line, known, chosen))
    hung = HungSpan(
        length=known.length,
        rigidity=values["conductor.axial_rigidity"],
        thermal_expansion=values["conductor.thermal_expansion"],
        level_difference=known.level_difference,
        ruling_span=rows.get("span.ruling_span"),
    )
    state = known.everyday or EverydayState(chosen.get("span.everyday.share_of_rated_strength", USUAL_SHARE.value))
    drag = state.wind_pressure * values["conductor.diameter"]
    usual = _load("span.everyday.temperature", rows, GRAVITY * values["conductor.bare_mass"], drag)
    iced = _load("span.temperature", rows, GRAVITY * mass, 0.0)
    measure = _measure(known, state, values, chosen)
    tension = _tension(measure, hung, usual, values)
    rows = rows.extended([measure])
    everyday = hung_state(hung, tension, usual)
    under_ice = change_of_state(hung, tension, usual, iced)
    require(_strength_fault(measure, values, under_ice, iced))
    source = f"change of state from {tension:.0f} N at {usual.temperature:g} degrees Celsius, bare"
    result = computed("span.horizontal_tension", under_ice.horizontal_tension, "N", source)
    span = Span(
        length=known.length,
        horizontal_tension=result.value,
        elements=known.elements,
        level_difference=known.level_difference,
    )
    return IcedSpan(span, rows.extended([result]), everyday, under_ice)


def _conditions(line: KnownLine, known: KnownSpan, chosen: Mapping[str, float]) -> list[Assumption]:
    """Return both temperatures, and the ruling span unless the span stands between dead ends."""
    usual = None if known.everyday is None else known.everyday.temperature
    rows = [given("span.length", known.length, "m")]
    for path, stated, estimate in (
        ("span.everyday.temperature", usual, USUAL_TEMPERATURE),
        ("span.temperature", known.temperature, ICING_TEMPERATURE),
    ):
        rows.append(assumed(path, estimate, chosen) if stated is None else given(path, stated, "degC"))
    ends = (line.supports.left, line.supports.right)
    if known.ruling_span is not None:
        return [*rows, given("span.ruling_span", known.ruling_span, "m")]
    if line.section is not None:
        ruling = ruling_span(span.length for span in line.section.spans)
        return [*rows, computed("span.ruling_span", ruling, "m", "sqrt(sum L^3/sum L) of the section's spans")]
    if all(end.dead_end for end in ends):
        return rows
    lengths = [end.adjacent_span for end in ends if not end.dead_end and end.adjacent_span is not None]
    return [*rows, assumed("span.ruling_span", _of_neighbours([known.length, *lengths]), chosen)]


def ruling_span(lengths: Iterable[float]) -> float:
    """Return the ruling span sqrt(sum L^3/sum L) of spans [m]."""
    spans = list(lengths)
    return math.sqrt(sum(length**3 for length in spans) / sum(spans))


def _of_neighbours(lengths: list[float]) -> Estimate:
    source = "assumed: the ruling span of this span and its known neighbours; range 0.8 to 1.25 times the extremes"
    return Estimate(ruling_span(lengths), "m", 0.8 * min(lengths), 1.25 * max(lengths), source)


def _load(path: str, rows: Provenance, weight: float, drag: float) -> LoadState:
    """Return a load state; a temperature out of bounds is a fault of the field at this path."""
    try:
        return LoadState(rows[path], weight, drag)
    except InvalidSpec as error:
        named = (replace(fault, field=path) if fault.field == "temperature" else fault for fault in error.faults)
        raise InvalidSpec(*named) from error


def _measure(known: KnownSpan, state: EverydayState, values: Provenance, chosen: Mapping[str, float]) -> Assumption:
    """Return the everyday state's measure of tension as a row."""
    if state.horizontal_tension is not None:
        return given("span.everyday.horizontal_tension", state.horizontal_tension, "N")
    if state.sag is not None:
        return given("span.everyday.sag", state.sag, "m")
    path = "span.everyday.share_of_rated_strength"
    assert state.share_of_rated_strength is not None, "an everyday state has one measure"
    if "conductor.rated_strength" not in values:
        rule = "must be given where the everyday tension is a share of it; or give its tension or sag"
        raise InvalidSpec(Fault("conductor.rated_strength", None, rule))
    return (
        assumed(path, USUAL_SHARE, chosen) if known.everyday is None else given(path, state.share_of_rated_strength, "")
    )


def _tension(measure: Assumption, hung: HungSpan, usual: LoadState, values: Provenance) -> float:
    """Return the everyday horizontal tension [N]."""
    if measure.path.endswith("share_of_rated_strength"):
        return measure.value * values["conductor.rated_strength"]
    if measure.path.endswith("horizontal_tension"):
        return measure.value
    if not measure.value < hung.length:
        raise InvalidSpec(Fault(measure.path, measure.value, f"must be smaller than the span's length ({hung.length})"))
    return tension_of_sag(hung, measure.value, usual)


def _strength_fault(measure: Assumption, values: Provenance, iced: HungState, load: LoadState) -> Fault | None:
    if "conductor.rated_strength" not in values:
        return None
    strength = values["conductor.rated_strength"]
    if iced.largest_tension <= strength:
        return None
    where = f"{iced.largest_tension:.0f} N under ice at {load.temperature:g} degrees Celsius"
    rule = f"must leave the tension below the rated strength ({strength:.0f} N): it would be {where}"
    return Fault(measure.path, measure.value, rule)
