"""The iced sub-conductor: mass, eccentricity and inertia from its accretion, or as they are given."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from engine.known import estimators
from engine.known.densities import IceKind, density_of
from engine.known.description import KnownIce
from engine.known.estimate import Estimate
from engine.known.ice_sections import SOLID_ICE, WINDWARD, Accretion, BareConductor, IceSection, Shape, ice_section
from engine.known.provenance import Assumption, Provenance, assumed, computed, given

ANY_ICE = Estimate(
    900.0,
    "kg/m3",
    600.0,
    SOLID_ICE,
    "assumed: glaze, since neither density nor kind of ice is given; range down to hard rime",
)
GROWS_TO_WINDWARD = Estimate(
    WINDWARD,
    "rad",
    math.pi,
    2.0 * math.pi,
    "assumed: ice is thickest to windward; range from below to above the conductor",
)


@dataclass(frozen=True, slots=True)
class IcedConductor:
    """What an iced sub-conductor weighs and where: rows of values, and the section if there is an accretion."""

    rows: Provenance
    section: IceSection | None


def iced_conductor(ice: KnownIce, values: Provenance, chosen: Mapping[str, float]) -> IcedConductor:
    """Return mass [kg/m], inertia [kg m] and eccentricity [m] of an iced sub-conductor.

    Parameters
    ----------
    ice : KnownIce
    values : Provenance
        The values of the bare conductor.
    chosen : mapping
        Values that replace assumed ones, by path.
    """
    if ice.accretion is None:
        return IcedConductor(Provenance().extended(_as_given(ice, values, chosen)), None)
    settled, rows = _settled(ice.accretion, chosen)
    bare = BareConductor(
        values["conductor.diameter"], values["conductor.bare_mass"], values["conductor.bare_polar_inertia"]
    )
    section = ice_section(bare, settled)
    return IcedConductor(Provenance().extended(rows).extended(_of_section(section)), section)


def _settled(accretion: Accretion, chosen: Mapping[str, float]) -> tuple[Accretion, list[Assumption]]:
    """Return the accretion with density and angle settled, and its rows."""
    rows = []
    for name, unit in (("thickness", "m"), ("mass", "kg/m"), ("density", "kg/m3"), ("angle", "rad")):
        value = getattr(accretion, name)
        if value is not None:
            rows.append(given(f"ice.accretion.{name}", value, unit))
    profile = accretion.shape is Shape.PROFILE
    if accretion.density is None and not (profile and accretion.mass is not None):
        estimate = ANY_ICE if accretion.kind is None else density_of(IceKind(accretion.kind))
        rows.append(assumed("ice.accretion.density", estimate, chosen))
        accretion = replace(accretion, density=rows[-1].value)
    if accretion.angle is None and accretion.shape not in {Shape.UNIFORM, Shape.PROFILE}:
        rows.append(assumed("ice.accretion.angle", GROWS_TO_WINDWARD, chosen))
        accretion = replace(accretion, angle=rows[-1].value)
    return accretion, rows


def _of_section(section: IceSection) -> Iterator[Assumption]:
    source = "section of conductor and ice"
    yield computed("ice.outer_diameter", section.outer_diameter, "m", source)
    yield computed("conductor.mass", section.mass, "kg/m", source)
    yield computed("conductor.polar_inertia", section.polar_inertia, "kg m", source)
    yield computed("ice.eccentricity_y", section.eccentricity_y, "m", source)
    yield computed("ice.eccentricity_z", section.eccentricity_z, "m", source)


def _as_given(ice: KnownIce, values: Provenance, chosen: Mapping[str, float]) -> Iterator[Assumption]:
    """Yield the values of ice without an accretion, or those of the bare conductor."""
    if ice.mass is None:
        mass = computed("conductor.mass", values["conductor.bare_mass"], "kg/m", "no ice: that of the bare conductor")
    else:
        mass = given("conductor.mass", ice.mass, "kg/m")
    yield mass
    if ice.polar_inertia is not None:
        yield given("conductor.polar_inertia", ice.polar_inertia, "kg m")
    elif ice.mass is None:
        bare = values["conductor.bare_polar_inertia"]
        yield computed("conductor.polar_inertia", bare, "kg m", "no ice: that of the bare conductor")
    else:
        estimate = estimators.iced_polar_inertia(values["conductor.diameter"], mass.value)
        yield assumed("conductor.polar_inertia", estimate, chosen)
    for name, value in (("eccentricity_y", ice.eccentricity_y), ("eccentricity_z", ice.eccentricity_z)):
        if value is not None:
            yield given(f"ice.{name}", value, "m")
