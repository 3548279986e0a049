"""From a line as an engineer knows it to the explicit line that an analysis takes, with the origin of every value."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from engine.arrays import placed
from engine.known import estimators
from engine.known.bare_conductor import bare_conductor
from engine.known.borrowed_coefficients import coefficients
from engine.known.change_of_state import HungState
from engine.known.description import EverydayState, KnownLine, KnownSpan
from engine.known.estimate import Estimate
from engine.known.everyday import iced_span
from engine.known.ice_sections import IceSection
from engine.known.iced_conductor import iced_conductor
from engine.known.provenance import Assumption, Origin, Provenance, assumed, computed, given
from engine.mechanics.static_profile import static_profile
from engine.outcome import Fault, require
from engine.spec import Aerodynamics, ChangedTension, Conductor, Damping, Ice, Line, Span, Supports, Wind

DIRECTIONS = ("vertical", "horizontal", "torsional")
AIR = Estimate(
    1.2929, "kg/m3", 1.05, 1.4, "assumed: air at 0 degrees Celsius and sea level; range from 1,800 m to deep frost"
)


@dataclass(frozen=True, slots=True)
class Resolved:
    """An explicit line, the origin of its values, and what was computed on the way.

    section: of the ice, None without an accretion; everyday, iced: states of the span, None where its iced tension was
    given.
    """

    line: Line
    assumptions: tuple[Assumption, ...]
    section: IceSection | None = None
    everyday: HungState | None = None
    iced: HungState | None = None


def resolve(known: KnownLine, chosen: Mapping[str, float] | None = None) -> Resolved:
    """Return the explicit line that is known, with estimates for what is not.

    Parameters
    ----------
    known : KnownLine
    chosen : mapping, optional
        Other values of rows whose origin is `assumed`, by path, each within the row's range: a sample of what is not
        known. Everything that follows from them is computed anew.

    Returns
    -------
    Resolved
        One row for each value, those that others follow from first; those of `end_stiffnesses` are not among them.

    Raises
    ------
    InvalidSpec
        If a value breaks its rule or cannot be estimated, or a chosen value has no assumed row.
    """
    values = {} if chosen is None else chosen
    bare = isinstance(known.span, KnownSpan) or known.ice.accretion is not None or known.ice.mass is None
    rows = bare_conductor(known.conductor, values, bare=bare)
    iced = iced_conductor(known.ice, rows, values)
    rows = rows.extended(iced.rows.rows)
    hung = None
    if isinstance(known.span, KnownSpan):
        hung = iced_span(known, known.span, rows, rows["conductor.mass"], values)
    rows = rows.extended(_as_given(known.span) if hung is None else hung.rows.rows)
    outer = None if iced.section is None else iced.section.outer_diameter
    aerodynamics, borrowed = coefficients(known.ice.aerodynamics, rows["conductor.diameter"], outer, values)
    rows = rows.extended((*borrowed.rows, *_surroundings(known, values)))
    require(*_unknown_choices(values, rows))
    line = _line(known, rows, hung.span if hung else known.span, aerodynamics)
    states = (hung.everyday, hung.iced) if hung else (None, None)
    return Resolved(line, rows.rows, iced.section, *states)


def resolve_with_tension(
    known: KnownLine, tension: ChangedTension, chosen: Mapping[str, float] | None = None
) -> Resolved:
    """Return the explicit line of a line strung to another tension, everything else as known or chosen.

    A known everyday tension is changed, and the iced one follows from it by the change of state. A tension that is
    known under ice is changed there.

    Raises
    ------
    InvalidSpec
        As `resolve`, also if the other tension is above the rated strength.
    """
    values = dict(chosen or {})
    before = resolve(known, values)
    if before.everyday is None or not isinstance(known.span, KnownSpan):
        return replace(before, line=with_tension(before.line, tension))
    usual = known.span.everyday
    everyday = EverydayState(
        horizontal_tension=tension.of(before.everyday.horizontal_tension),
        temperature=None if usual is None else usual.temperature,
        wind_pressure=0.0 if usual is None else usual.wind_pressure,
    )
    values.pop("span.everyday.share_of_rated_strength", None)  # which was assumed
    return resolve(replace(known, span=replace(known.span, everyday=everyday)), values)


def with_tension(line: Line, tension: ChangedTension) -> Line:
    """Return an explicit line with another horizontal tension under ice, whatever measure of tightness it says."""
    before = float(static_profile((line,)).horizontal_tension[0])
    span = replace(line.span, horizontal_tension=tension.of(before), catenary_parameter=None, sag=None)
    return replace(line, span=span)


def _line(known: KnownLine, rows: Provenance, span: KnownSpan | Span, aerodynamics: Aerodynamics) -> Line:
    """Return the line of settled values."""
    assert isinstance(span, Span), "a known span has been hung"
    get = rows.get
    conductor = Conductor(
        diameter=rows["conductor.diameter"],
        axial_rigidity=rows["conductor.axial_rigidity"],
        torsional_rigidity=rows["conductor.torsional_rigidity"],
        mass=rows["conductor.mass"],
        polar_inertia=rows["conductor.polar_inertia"],
        axial_torsional_coupling=get("conductor.axial_torsional_coupling") or 0.0,
        rated_strength=get("conductor.rated_strength"),
    )
    vertical, horizontal, torsional = (rows[f"damping.{name}_ratio"] for name in DIRECTIONS)
    eccentricity = (get("ice.eccentricity_y") or 0.0, get("ice.eccentricity_z") or 0.0)
    return Line(
        conductor=conductor,
        bundle=known.bundle,
        span=span,
        ice=Ice(aerodynamics, *eccentricity, known.ice.segments),
        wind=replace(known.wind or Wind(), air_density=rows["wind.air_density"]),
        damping=Damping(vertical, horizontal, torsional, known.damping.model),
        supports=_with_neighbours(known.supports, rows),
        devices=known.devices,
        section=known.section,
        phases=known.phases,
    )


def _as_given(span: KnownSpan | Span) -> Iterator[Assumption]:
    """Yield the values of a span whose iced tension is given."""
    yield given("span.length", span.length, "m")
    for name, unit in (("horizontal_tension", "N"), ("catenary_parameter", "m"), ("sag", "m")):
        value = getattr(span, name, None)
        if value is not None:
            yield given(f"span.{name}", value, unit)


def _surroundings(known: KnownLine, chosen: Mapping[str, float]) -> Iterator[Assumption]:
    """Yield the values of supports, damping and air."""
    yield from _neighbours(known, chosen)
    for name in DIRECTIONS:
        path, ratio = f"damping.{name}_ratio", getattr(known.damping, f"{name}_ratio")
        yield assumed(path, estimators.damping_ratio(name), chosen) if ratio is None else given(path, ratio, "")
    path = "wind.air_density"
    yield assumed(path, AIR, chosen) if known.wind is None else given(path, known.wind.air_density, "kg/m3")


def _neighbours(known: KnownLine, chosen: Mapping[str, float]) -> Iterator[Assumption]:
    """Yield what holds the ends along the line unless a section does: a given stiffness, or the neighbours of (A10)."""
    supports, length = known.supports, known.span.length
    if supports.longitudinal_stiffness is not None:
        yield given("supports.longitudinal_stiffness", supports.longitudinal_stiffness, "N/m")
    if supports.longitudinal_stiffness is not None or known.section is not None:
        return
    source = "assumed: as long as this span, which (A10) takes; range half to twice"
    for name, end in (("left", supports.left), ("right", supports.right)):
        path = f"supports.{name}.adjacent_span"
        if end.adjacent_span is not None:
            yield given(path, end.adjacent_span, "m")
        elif not end.dead_end:
            yield assumed(path, Estimate(length, "m", 0.5 * length, 2.0 * length, source), chosen)
        if end.insulator_length is not None:
            yield given(f"supports.{name}.insulator_length", end.insulator_length, "m")


def _with_neighbours(supports: Supports, rows: Provenance) -> Supports:
    left, right = (rows.get(f"supports.{name}.adjacent_span") for name in ("left", "right"))
    return replace(
        supports, left=replace(supports.left, adjacent_span=left), right=replace(supports.right, adjacent_span=right)
    )


def end_stiffnesses(lines: Sequence[Line]) -> list[list[Assumption]]:
    """Return for each line the longitudinal stiffness of both ends per sub-conductor that (A10) gives, as rows.

    A dead end has none, nor has a line that gives it or that has a section.

    Raises
    ------
    InvalidSpec
        If the conductor pulls an insulator string up.
    """
    sought = [line.supports.longitudinal_stiffness is None and line.section is None for line in lines]
    computing = [line for line, wanted in zip(lines, sought, strict=True) if wanted]
    found = placed(static_profile(computing).end_stiffness.tolist() if computing else [], sought)
    return [[] if own is None else list(_ends(line, own)) for line, own in zip(lines, found, strict=True)]


def _ends(line: Line, stiffnesses: Sequence[float]) -> Iterator[Assumption]:
    ends = (("left", line.supports.left), ("right", line.supports.right))
    for (name, end), stiffness in zip(ends, stiffnesses, strict=True):
        if not end.dead_end:
            string = "" if end.insulator_length is None else " and of its string"
            source = f"(A10): static stiffness of the adjacent span{string}, under ice"
            yield computed(f"supports.{name}.longitudinal_stiffness", stiffness, "N/m", source)


def _unknown_choices(chosen: Mapping[str, float], rows: Provenance) -> Iterator[Fault]:
    paths = {row.path for row in rows.rows if row.origin is Origin.ASSUMED}
    yield from (Fault(path, value, "is no assumed value") for path, value in chosen.items() if path not in paths)
