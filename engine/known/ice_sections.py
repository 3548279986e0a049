"""Sections of accreted ice: mass, eccentricity and inertia of an iced sub-conductor by exact section integrals.

The conductor is a disc about the origin, the ice what an outline encloses beyond it. All shapes have one thickest
direction, and are symmetric about it unless the outline is given:

uniform     a circle about the conductor's centre
crescent    a circle that touches the conductor opposite to the thickest point
d_shape     half a ring: ice of one thickness on the half that faces the thickest direction, none on the other
profile     the outline as it is given
"""

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from engine.known.densities import IceKind, density_of
from engine.known.outlines import Arc, Edge, Moments, Outline, circle, crossing_edges, extent, moments, within_disc
from engine.known.outlines import polygon as closed_polygon
from engine.outcome import Fault, require
from engine.spec.rules import finite, positive

UP = 1.0 + 0.0j
WINDWARD = 1.5 * math.pi  # rad, clockwise from straight up
MOST_POINTS = 1000
DEEPEST_CUT = 0.1  # of the radius: chords of an outline that lies on the conductor pass inside its circle
THICKEST = 0.5  # m
SOLID_ICE = 917.0  # kg/m3, no accretion is denser


class Shape(StrEnum):
    """Outline of the ice."""

    UNIFORM = "uniform"
    CRESCENT = "crescent"
    D_SHAPE = "d_shape"
    PROFILE = "profile"


@dataclass(frozen=True, slots=True)
class Accretion:
    """Ice on a sub-conductor: its shape and one measure of how much there is.

    thickness: the largest radial thickness [m]; mass: of the ice per length [kg/m]; density [kg/m3], None for that of
    the kind, and kind None for glaze; angle: direction of the thickest point, clockwise from straight up like that of a
    sub-conductor [rad], None for windward. A profile has points (y, z) of its outline about the bare centre [m], which
    the angle turns, None by nothing; unless its density is given, it may have a mass from which the density follows.
    """

    shape: Shape
    thickness: float | None = None
    mass: float | None = None
    kind: IceKind | None = None
    density: float | None = None
    angle: float | None = None
    points: tuple[tuple[float, float], ...] = ()

    def __post_init__(self) -> None:
        """Check the rules of every field, and that exactly one measure is given."""
        require(
            positive("ice.accretion.thickness", self.thickness),
            Fault("ice.accretion.thickness", self.thickness, f"must be at most {THICKEST} m: 12 mm is 0.012 m")
            if self.thickness is not None and self.thickness > THICKEST
            else None,
            positive("ice.accretion.mass", self.mass),
            finite("ice.accretion.angle", self.angle),
            positive("ice.accretion.density", self.density),
            _density_fault(self.density),
            *(self._profile_faults() if self.shape is Shape.PROFILE else self._measure_faults()),
        )

    @property
    def usual_density(self) -> float:
        """The density, given or that of the kind [kg/m3]."""
        return density_of(self.kind or IceKind.GLAZE).value if self.density is None else self.density

    @property
    def direction(self) -> float:
        """The angle, given or the usual one [rad]."""
        usual = 0.0 if self.shape is Shape.PROFILE else WINDWARD
        return usual if self.angle is None else self.angle

    def _measure_faults(self) -> Iterator[Fault | None]:
        given = [value for value in (self.thickness, self.mass) if value is not None]
        if len(given) != 1:
            yield Fault("ice.accretion", tuple(given), "must have exactly one of thickness and mass")
        if self.points:
            yield Fault("ice.accretion.points", len(self.points), "must be absent unless the shape is a profile")

    def _profile_faults(self) -> Iterator[Fault | None]:
        if self.thickness is not None:
            yield Fault("ice.accretion.thickness", self.thickness, "must be absent for a profile, whose points say it")
        if self.mass is not None and self.density is not None:
            yield Fault("ice.accretion.mass", self.mass, "must be absent for a profile whose density is given")
        if not 3 <= len(self.points) <= MOST_POINTS:
            yield Fault("ice.accretion.points", len(self.points), f"must be 3 to {MOST_POINTS} points of the outline")
        values = ((f"{i}.{j}", value) for i, point in enumerate(self.points) for j, value in enumerate(point))
        yield from (finite(f"ice.accretion.points.{path}", value) for path, value in values)


@dataclass(frozen=True, slots=True)
class IceSection:
    """An iced sub-conductor per length.

    thickness: largest radial thickness [m]; density [kg/m3]; ice_area [m2]; ice_mass and mass, with the conductor
    [kg/m]; eccentricity_y, eccentricity_z of the iced mass centre from the bare centre [m]; polar_inertia about the
    bare centre, with the conductor [kg m]; outer_diameter: largest distance of two points of the section [m];
    frontal_diameter: its extent across the wind, along Y [m].
    """

    thickness: float
    density: float
    ice_area: float
    ice_mass: float
    mass: float
    eccentricity_y: float
    eccentricity_z: float
    polar_inertia: float
    outer_diameter: float
    frontal_diameter: float


@dataclass(frozen=True, slots=True)
class BareConductor:
    """A bare sub-conductor: diameter [m], mass per length [kg/m], polar inertia per length about its centre [kg m]."""

    diameter: float
    mass: float
    polar_inertia: float

    def __post_init__(self) -> None:
        """Check that every value is positive."""
        require(*(positive(f"conductor.{name}", getattr(self, name)) for name in ("diameter", "mass", "polar_inertia")))


def ice_section(conductor: BareConductor, accretion: Accretion) -> IceSection:
    """Return the properties of an iced sub-conductor.

    Parameters
    ----------
    conductor : BareConductor
    accretion : Accretion

    Returns
    -------
    IceSection
        The eccentricity is the first moment of ice and conductor about the bare centre over their mass.

    Raises
    ------
    InvalidSpec
        If a profile crosses itself or does not enclose the conductor, or its mass needs ice denser than ice.
    """
    radius = 0.5 * conductor.diameter
    if accretion.shape is Shape.PROFILE:
        return _of_profile(conductor, accretion)
    density = accretion.usual_density
    thickness = _thickness(accretion, radius, density)
    outline = _outline(accretion.shape, radius, thickness, accretion.direction)
    bare = Moments(math.pi * radius**2, 0j, 0.5 * math.pi * radius**4)
    ice = moments(outline) + bare.scaled(-1.0)
    crescent = accretion.shape is Shape.CRESCENT
    outer = conductor.diameter + (thickness if crescent else 2.0 * thickness)
    return _section(conductor, ice, density, (thickness, outer, extent(outline, UP)))


def _thickness(accretion: Accretion, radius: float, density: float) -> float:
    """Return the largest radial thickness [m], given or from the mass of the ice."""
    if accretion.thickness is not None:
        return accretion.thickness
    assert accretion.mass is not None, "an accretion checks on construction that one measure is given"
    area = accretion.mass / density
    if accretion.shape is Shape.D_SHAPE:
        area *= 2.0
    # R^2 - a^2 without cancellation where the ice is thin.
    beyond = area / math.pi / (math.sqrt(radius**2 + area / math.pi) + radius)
    return 2.0 * beyond if accretion.shape is Shape.CRESCENT else beyond


def _outline(shape: Shape, radius: float, thickness: float, angle: float) -> Outline:
    if shape is Shape.UNIFORM:
        return circle(0j, radius + thickness)
    if shape is Shape.CRESCENT:
        return circle(cmath.rect(0.5 * thickness, angle), radius + 0.5 * thickness)
    outer = radius + thickness
    begin, end = angle - 0.5 * math.pi, angle + 0.5 * math.pi
    return (
        Arc(0j, outer, begin, math.pi),
        Edge(cmath.rect(outer, end), cmath.rect(radius, end)),
        Arc(0j, radius, end, math.pi),
        Edge(cmath.rect(radius, begin), cmath.rect(outer, begin)),
    )


def _of_profile(conductor: BareConductor, accretion: Accretion) -> IceSection:
    radius = 0.5 * conductor.diameter
    turned = np.array([complex(y, z) for y, z in accretion.points]) * cmath.rect(1.0, accretion.direction)
    edges = _edges(turned)
    require(*_outline_faults(edges, turned, radius))
    whole = moments(edges)
    ice = whole + within_disc(edges, radius).scaled(-1.0)
    if not ice.area > 0.0:
        require(Fault("ice.accretion.points", ice.area, "must enclose ice beyond the conductor"))
    density = _profile_density(accretion, ice.area)
    distances = np.abs(turned)
    outer = max(float(np.abs(turned[:, None] - turned).max()), float(distances.max()) + radius)
    frontal = max(edge.reach(UP) for edge in edges), max(edge.reach(-UP) for edge in edges)
    across = sum(max(reach, radius) for reach in frontal)
    return _section(conductor, ice, density, (float(distances.max()) - radius, outer, across))


def _edges(points: np.ndarray[tuple[int], np.dtype[np.complex128]]) -> tuple[Edge, ...]:
    return tuple(part for part in closed_polygon([complex(p) for p in points]) if isinstance(part, Edge))


def _outline_faults(
    edges: tuple[Edge, ...], points: np.ndarray[tuple[int], np.dtype[np.complex128]], radius: float
) -> Iterator[Fault]:
    crossing = crossing_edges(points)
    if crossing is not None:
        i, j = crossing
        rule = f"must not cross itself: the edges after points {i} and {j} meet"
        yield Fault("ice.accretion.points", (i, j), rule)
        return
    nearest = min(_distance(edge) for edge in edges)
    winding = sum(cmath.phase(edge.stop * edge.start.conjugate()) for edge in edges if edge.start and edge.stop)
    if winding < math.pi:
        rule = "must enclose the conductor: its centre lies outside the outline; points are (y up, z downwind) from it"
        yield Fault("ice.accretion.points", nearest, rule)
    elif nearest < (1.0 - DEEPEST_CUT) * radius:
        rule = f"must enclose the conductor: the outline comes closer to its centre than its radius ({radius:.4g} m)"
        yield Fault("ice.accretion.points", nearest, rule)


def _profile_density(accretion: Accretion, area: float) -> float:
    if accretion.mass is None:
        return accretion.usual_density
    density = accretion.mass / area
    require(_density_fault(density, f" within {1e4 * area:.4g} cm2 of ice", "mass", accretion.mass))
    return density


def _density_fault(
    density: float | None, where: str = "", field: str = "density", value: float | None = None
) -> Fault | None:
    if density is None or not density > SOLID_ICE:
        return None
    rule = f"must not make ice denser than solid ice, {SOLID_ICE:.0f} kg/m3{where}"
    return Fault(f"ice.accretion.{field}", density if value is None else value, rule)


def _section(conductor: BareConductor, ice: Moments, density: float, sizes: tuple[float, float, float]) -> IceSection:
    """Add ice and conductor; sizes: thickness, outer and frontal diameter [m]."""
    mass = conductor.mass + density * ice.area
    centre = density * ice.first / mass
    thickness, outer, frontal = sizes
    return IceSection(
        thickness=thickness,
        density=density,
        ice_area=ice.area,
        ice_mass=density * ice.area,
        mass=mass,
        eccentricity_y=centre.real,
        eccentricity_z=centre.imag,
        polar_inertia=conductor.polar_inertia + density * ice.polar,
        outer_diameter=outer,
        frontal_diameter=frontal,
    )


def _distance(edge: Edge) -> float:
    """Return the smallest distance of an edge from the origin [m]."""
    along = edge.stop - edge.start
    square = abs(along) ** 2
    mark = 0.0 if square == 0.0 else min(1.0, max(0.0, -(edge.start.conjugate() * along).real / square))
    return abs(edge.start + mark * along)
