"""Convert a line as an engineer knows it to the engine's: named conductors and shapes are looked up, forms built."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from functools import partial
from typing import Any, TypeVar

from app.convert import parts
from app.convert.assemble import section_with_ice
from app.convert.known.own_rows import OwnRows
from app.convert.pointers import at_names, json_names
from app.reference import conductors, ice_shapes
from app.reference.catalogue_row import CatalogueRow, name_key
from app.schemas import IceSegment
from app.schemas import known as said
from app.schemas.faults import Fault
from app.schemas.line import Phase
from app.schemas.measured import OwnTable
from engine import spec
from engine.known import description as known
from engine.known.bundles import Arrangement, arranged
from engine.known.densities import IceKind
from engine.known.ice_sections import Accretion, Shape
from engine.known.provenance import Origin
from engine.outcome import Fault as EngineFault
from engine.outcome import InvalidSpec

Made = TypeVar("Made")

SHAPE_SPREAD = 0.3
"""Half range of the coefficients that a shape of the catalogue lends to other ice: an assumption of this service."""
_DIRECTIONS = ("vertical", "horizontal", "torsional")
_FIGURES: Mapping[str, str] = {
    "diameter": "diameter_m",
    "bare_mass": "mass_kg_per_m",
    "area": "area_m2",
    "aluminium_area": "aluminium_area_m2",
    "modulus": "youngs_modulus_pa",
    "rated_strength": "rated_strength_n",
    "thermal_expansion": "thermal_expansion_per_k",
    "aluminium_wires": "aluminium_wires",
    "steel_wires": "steel_wires",
}
# Where the engine has another name than the document.
_OTHER_NAMES: Mapping[str, str] = {"conductor.modulus": "conductor.youngs_modulus"}


@dataclass(frozen=True, slots=True)
class _Gathered:
    """Faults of the parts found so far."""

    faults: list[EngineFault] = field(default_factory=list)

    def part(self, make: Callable[[], Made]) -> Made | None:
        """Return what is built, or collect its faults and return None."""
        try:
            return make()
        except InvalidSpec as error:
            self.faults.extend(error.faults)
            return None


def known_line(line: said.KnownLine, own: OwnRows) -> known.KnownLine:
    """Return the engine's line of what is known.

    Raises
    ------
    InvalidSpec
        With the faults of all parts.
    """
    gathered = _Gathered()
    conductor = gathered.part(lambda: _conductor(line.conductor, own))
    bundle = gathered.part(lambda: _bundle(line.bundle))
    span = gathered.part(lambda: _span(line.span))
    ice = gathered.part(lambda: _ice(line, own))
    supports = gathered.part(lambda: parts.supports(line.supports))
    wind = gathered.part(lambda: None if line.wind is None else parts.wind(line.wind))
    section = gathered.part(lambda: None if line.section is None else section_with_ice(line.section))
    phases = [gathered.part(partial(_phase, i, part)) for i, part in enumerate(line.phases)]
    devices = [gathered.part(partial(_device, i, part)) for i, part in enumerate(line.devices)]
    if conductor is None or bundle is None or span is None or ice is None or supports is None or gathered.faults:
        raise InvalidSpec(*gathered.faults)
    return known.KnownLine(
        conductor=conductor,
        bundle=bundle,
        span=span,
        ice=ice,
        supports=supports,
        wind=wind,
        damping=_damping(line.damping),
        devices=tuple(device for device in devices if device is not None),
        section=section,
        phases=tuple(phase for phase in phases if phase is not None),
    )


def _conductor(part: said.KnownConductor, own: OwnRows) -> known.KnownConductor:
    row = None if part.catalogue is None else _named_conductor(part.catalogue, own)
    given = known.ConductorData(
        diameter=part.diameter,
        bare_mass=part.bare_mass,
        area=part.area,
        aluminium_area=part.aluminium_area,
        modulus=part.youngs_modulus,
        axial_rigidity=part.axial_rigidity,
        torsional_rigidity=part.torsional_rigidity,
        axial_torsional_coupling=part.axial_torsional_coupling,
        bare_polar_inertia=part.bare_polar_inertia,
        rated_strength=part.rated_strength,
        thermal_expansion=part.thermal_expansion,
        aluminium_wires=part.aluminium_wires,
        steel_wires=part.steel_wires,
    )
    if row is None:
        return known.KnownConductor(given)
    figures = {name: getattr(row, listed) for name, listed in _FIGURES.items()}
    return known.KnownConductor(given, known.CatalogueRow(row.name, row.source, known.ConductorData(**figures)))


def _named_conductor(name: str, own: OwnRows) -> CatalogueRow:
    found = conductors.named(name, own.named)
    if len(found) == 1:
        return found[0]
    if found:
        rule = f"is the name of several conductors; say which: {', '.join(row.designation for row in found)}"
        raise InvalidSpec(EngineFault("conductor.catalogue", name, rule))
    rows = (*own.conductors, *conductors.shipped())
    rule = "must name an own conductor or one of GET /v1/conductors"
    names = {name_key(text): text for row in rows for text in (row.designation, row.name)}
    raise InvalidSpec(EngineFault("conductor.catalogue", name, rule + _near(name, names)))


def _near(name: str, names: Mapping[str, str]) -> str:
    close = get_close_matches(name_key(name), names, n=3, cutoff=0.7)
    return f"; near are {', '.join(names[key] for key in close)}" if close else ""


def _bundle(part: said.KnownBundle) -> spec.Bundle:
    section = spec.CrossSection(part.section) if part.section else None
    if part.positions is not None:
        return spec.Bundle(tuple((y, z) for y, z in part.positions), section)
    count = part.subconductors or 1
    if part.radius is not None or part.orientation is not None:
        return spec.Bundle.regular(count, part.radius or 0.0, math.radians(part.orientation or 0.0), section)
    return arranged(count, part.spacing, None if part.arrangement is None else Arrangement(part.arrangement), section)


def _span(part: said.KnownSpan) -> known.KnownSpan | spec.Span:
    if part.is_iced:
        return parts.span(part)
    state = part.everyday
    everyday = None
    if state is not None:
        everyday = known.EverydayState(
            share_of_rated_strength=state.share_of_rated_strength,
            horizontal_tension=state.horizontal_tension,
            sag=state.sag,
            temperature=state.temperature,
            wind_pressure=state.wind_pressure,
        )
    return known.KnownSpan(
        length=part.length,
        everyday=everyday,
        temperature=part.temperature,
        ruling_span=part.ruling_span,
        level_difference=part.level_difference,
        elements=part.elements,
    )


def _ice(line: said.KnownLine, own: OwnRows) -> known.KnownIce:
    part = line.ice
    segments = tuple(_segment(i, segment) for i, segment in enumerate(part.segments))
    return known.KnownIce(
        aerodynamics=_aerodynamics(part, own),
        accretion=None if part.accretion is None else _accretion(part.accretion),
        mass=line.conductor.mass,
        polar_inertia=line.conductor.polar_inertia,
        eccentricity_y=part.eccentricity_y,
        eccentricity_z=part.eccentricity_z,
        segments=segments,
    )


def _segment(index: int, part: IceSegment) -> spec.IceSegment:
    try:
        return parts.segment(part)
    except InvalidSpec as error:
        raise InvalidSpec(*(replace(f, field=f"ice.segments.{index}.{f.field}") for f in error.faults)) from error


def _device(index: int, part: Any) -> spec.Device:
    try:
        return parts.device(part)
    except InvalidSpec as error:
        raise InvalidSpec(*(replace(f, field=f"devices.{index}.{f.field}") for f in error.faults)) from error


def _phase(index: int, part: Phase) -> spec.Phase:
    try:
        return spec.Phase(part.name, part.y, part.z, part.required_clearance)
    except InvalidSpec as error:
        raise InvalidSpec(*(replace(f, field=f"phases.{index}.{f.field}") for f in error.faults)) from error


def _accretion(part: said.Accretion) -> Accretion:
    return Accretion(
        shape=Shape(part.shape),
        thickness=part.thickness,
        mass=part.mass,
        kind=None if part.kind is None else IceKind(part.kind),
        density=part.density,
        angle=None if part.angle is None else math.radians(part.angle),
        points=tuple((y, z) for y, z in part.points or ()),
    )


def _aerodynamics(part: said.KnownIce, own: OwnRows) -> known.KnownAerodynamics | known.UnknownShape:
    form = part.aerodynamics
    if form is None:
        shapes = ice_shapes.ICE_SHAPES
        return known.UnknownShape(
            tuple(_listed_shape(shape, part) for shape in shapes), tuple(shape.name for shape in shapes)
        )
    if isinstance(form, said.CatalogueShape):
        return _named_shape(form, part, own)
    try:
        made = parts.aerodynamics(form, part.at_rest)
    except InvalidSpec as error:
        raise InvalidSpec(*(replace(f, field=f"ice.{f.field}") for f in error.faults)) from error
    return known.KnownAerodynamics(made, form.reference_diameter)


def _named_shape(form: said.CatalogueShape, part: said.KnownIce, own: OwnRows) -> known.KnownAerodynamics:
    table = {name_key(name): (name, document) for name, document in own.tables.items()}.get(name_key(form.catalogue))
    if table is not None:
        name, document = table
        angle = {} if form.angle is None else {"static_angle_deg": form.angle}
        given = OwnTable.model_validate({**document, **angle})
        reference = form.reference_diameter or given.reference_diameter
        made = parts.aerodynamics(given, part.at_rest)
        source = f"own table {name}" + (f", {given.source}" if given.source else "")
        return known.KnownAerodynamics(made, reference, origin=Origin.CATALOGUE, source=source)
    shape = ice_shapes.named(form.catalogue)
    if shape is None:
        rule = "must name an own table or a shape of GET /v1/ice-shapes"
        names = {name_key(text): text for text in (*own.tables, *(known_.name for known_ in ice_shapes.ICE_SHAPES))}
        raise InvalidSpec(
            EngineFault("ice.aerodynamics.catalogue", form.catalogue, rule + _near(form.catalogue, names))
        )
    if form.angle is not None and form.angle != shape.static_angle_deg:
        rule = f"must be absent or {shape.static_angle_deg:g}, at which the coefficients of {shape.name} hold"
        raise InvalidSpec(EngineFault("ice.aerodynamics.angle", math.radians(form.angle), rule))
    return _listed_shape(shape, part, form.reference_diameter)


def _listed_shape(
    shape: ice_shapes.IceShape, part: said.KnownIce, reference_diameter: float | None = None
) -> known.KnownAerodynamics:
    rest, coefficients = part.at_rest, [_three(shape.aerodynamics[name]) for name in _DIRECTIONS]
    vertical, horizontal, torsional = coefficients
    at_rest = None if rest is None else (rest.vertical, rest.horizontal, rest.torsional)
    made = spec.Aerodynamics(vertical, horizontal, torsional, at_rest)
    return known.KnownAerodynamics(
        made,
        reference_diameter,
        reference=known.Reference(shape.reference) if reference_diameter is None else None,
        origin=Origin.CATALOGUE,
        source=shape.source,
        spread=SHAPE_SPREAD,
    )


def _three(values: Sequence[float]) -> spec.Coefficients:
    first, second, third = values
    return first, second, third


def _damping(part: said.KnownDamping) -> known.KnownDamping:
    return known.KnownDamping(
        vertical_ratio=part.vertical_ratio,
        horizontal_ratio=part.horizontal_ratio,
        torsional_ratio=part.torsional_ratio,
        model=spec.DampingModel(part.model),
    )


def to_pointer(fault: EngineFault, line: said.KnownLine) -> Fault:
    """Return a fault of the engine with the JSON pointer of its field in the line document."""
    path = _OTHER_NAMES.get(fault.field, fault.field).split(".")
    return at_names(fault, json_names(line, path))
