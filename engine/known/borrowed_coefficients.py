"""Aerodynamic coefficients for a line: referred to its bare diameter, with what a borrowed shape leaves open."""

from collections.abc import Iterator, Mapping
from dataclasses import replace

from engine.known.description import KnownAerodynamics, Reference, UnknownShape
from engine.known.estimate import Estimate
from engine.known.provenance import Assumption, Origin, Provenance, assumed, computed, from_catalogue, given
from engine.spec import Aerodynamics, Coefficients

_PATH = "ice.aerodynamics"
AT_REST = (
    ("vertical", Estimate(0.0, "", -0.3, 0.3, "assumed: no lift at rest; range -0.3 to 0.3")),
    ("horizontal", Estimate(1.0, "", 0.7, 1.6, "assumed: the drag of a rough cylinder; range 0.7 to 1.6")),
    ("torsional", Estimate(0.0, "", -0.1, 0.1, "assumed: no moment at rest; range -0.1 to 0.1")),
)


def coefficients(
    known: KnownAerodynamics | UnknownShape, bare: float, outer: float | None, chosen: Mapping[str, float]
) -> tuple[Aerodynamics, Provenance]:
    """Return the coefficients over the bare diameter.

    Forces of a section are coefficient times diameter, moments times its square, so coefficients over another diameter
    count with its ratio to the bare one and the ratio's square. The motion of the section's edge, d Theta'/2, keeps the
    bare diameter.

    Parameters
    ----------
    known : KnownAerodynamics or UnknownShape
        Of several shapes the one whose number is chosen, else the first. What any of them leaves open has its rows.
    bare : float
        Diameter of the bare conductor [m].
    outer : float or None
        Outer diameter with an accretion [m], None without one: then coefficients are over the bare diameter.
    chosen : mapping
        Values that replace assumed ones, by path.
    """
    if isinstance(known, UnknownShape):
        shape = _assumed_shape(known, chosen)
        rows = Provenance((shape,))
        open_at_rest = any(map(_lacks_rest, known.shapes))
        known = known.shapes[round(shape.value)]
    else:
        rows, open_at_rest = Provenance(), _lacks_rest(known)
    rows = rows.extended(_reference(known, bare, outer, chosen))
    rows = rows.extended(_spread(known, chosen))
    aerodynamics = known.aerodynamics
    if open_at_rest:
        rest = [assumed(f"{_PATH}_at_rest.{name}", estimate, chosen) for name, estimate in AT_REST]
        rows = rows.extended(rest)
        lift, drag, moment = (row.value for row in rest)
        if _lacks_rest(known):
            aerodynamics = replace(aerodynamics, at_rest=(lift, drag, moment))
    path = f"{_PATH}.reference_diameter"
    ratio = rows[path] / bare if path in rows else 1.0
    factors = [rows[f"{_PATH}.{name}_factor"] if known.spread else 1.0 for name, _ in AT_REST]
    return _scaled(aerodynamics, ratio, factors), rows


def _assumed_shape(known: UnknownShape, chosen: Mapping[str, float]) -> Assumption:
    listed = ", ".join(f"{number} {name}" for number, name in enumerate(known.names))
    source = f"assumed: the shape of the ice is not known; one of {listed}, none likelier than another"
    estimate = Estimate(0.0, "", 0.0, len(known.names) - 1.0, source)
    return replace(assumed(f"{_PATH}.catalogue", estimate, chosen), choices=known.names)


def _lacks_rest(known: KnownAerodynamics) -> bool:
    return known.origin is Origin.CATALOGUE and known.aerodynamics.at_rest is None


def _reference(
    known: KnownAerodynamics, bare: float, outer: float | None, chosen: Mapping[str, float]
) -> Iterator[Assumption]:
    path, stated = f"{_PATH}.reference_diameter", known.reference_diameter
    if known.reference is not None:
        size = bare if known.reference is Reference.BARE or outer is None else outer
        source = f"the {known.reference.value} diameter, to which the coefficients refer ({known.source})"
        yield computed(path, size, "m", source)
    elif stated is not None:
        listed = known.origin is Origin.CATALOGUE
        yield from_catalogue(path, stated, "m", known.source) if listed else given(path, stated, "m")
    elif outer is not None and outer > bare:
        source = "assumed: the bare diameter, since the coefficients came without one; range up to the iced diameter"
        yield assumed(path, Estimate(bare, "m", bare, outer, source), chosen)


def _spread(known: KnownAerodynamics, chosen: Mapping[str, float]) -> Iterator[Assumption]:
    if not known.spread:
        return
    source = (
        f"assumed: this ice has the coefficients of another one within {100.0 * known.spread:.0f} % ({known.source})"
    )
    for name, _ in AT_REST:
        estimate = Estimate(1.0, "", 1.0 - known.spread, 1.0 + known.spread, source)
        yield assumed(f"{_PATH}.{name}_factor", estimate, chosen)


def _scaled(aerodynamics: Aerodynamics, ratio: float, factors: list[float]) -> Aerodynamics:
    """Return coefficients times the ratio of diameters (moments: its square), and slopes times their factors."""
    powers = (ratio, ratio, ratio**2)
    vertical, horizontal, torsional = (
        _times(row, power * factor)
        for row, power, factor in zip(
            (aerodynamics.vertical, aerodynamics.horizontal, aerodynamics.torsional), powers, factors, strict=True
        )
    )
    rest = aerodynamics.at_rest
    table = aerodynamics.measured
    if table is not None:
        force, turn = ratio, ratio**2
        table = replace(
            table,
            lift=tuple(force * factors[0] * value for value in table.lift),
            drag=tuple(force * factors[1] * value for value in table.drag),
            moment=tuple(turn * factors[2] * value for value in table.moment),
        )
    return replace(
        aerodynamics,
        vertical=vertical,
        horizontal=horizontal,
        torsional=torsional,
        at_rest=None if rest is None else (rest[0] * powers[0], rest[1] * powers[1], rest[2] * powers[2]),
        measured=table,
    )


def _times(row: Coefficients, factor: float) -> Coefficients:
    first, second, third = (factor * value for value in row)
    return first, second, third
