"""Estimates of what utilities do not have: rigidities, expansion, inertia and damping of a conductor.

Each function returns a value with its range and says where both come from. A source is named only if it was opened.
"""

import math

from engine.known.estimate import Estimate
from engine.known.wires import (
    ALUMINIUM_EXPANSION,
    ALUMINIUM_MODULUS,
    ALUMINIUM_POISSON,
    FILLED,
    STEEL_EXPANSION,
    STEEL_MODULUS,
    STEEL_POISSON,
    Wires,
)
from engine.spec import DampingModel

WIRE_FIGURES = "wire figures of EN 60889, EN 50183 and EN 50189 as listed in RTE's package stranded-cable"
SOURCE_CONDUCTOR = (101.0, 0.0286)  # GJ [N m2] and diameter [m] of the source's Table 1
LAY_RATIO = 12.0  # length of lay over the outer diameter of a layer; EN 50182 allows 10 to 16
STRANDED = (0.78, 0.87, 0.95)  # modulus of a conductor over that of the mixture of its wires


def area_of_circle(diameter: float) -> Estimate:
    """Estimate the area of all wires [m2] from the diameter [m]."""
    circle = 0.25 * math.pi * diameter**2
    source = "assumed: round wires fill 70 to 80 % of the conductor's circle, shaped ones up to 93 %"
    return Estimate(FILLED * circle, "m2", 0.70 * circle, 0.93 * circle, source)


def modulus(wires: Wires) -> Estimate:
    """Estimate the final modulus over the whole area [Pa]: the mixture of the wires, less what their lay gives way."""
    mixture = wires.stiffness / wires.area
    low, usual, high = (share * mixture for share in STRANDED)
    source = (
        f"mixture of the moduli of the wires ({WIRE_FIGURES}) times 0.87 for their lay, the median of the shipped "
        "conductors; their sources state 0.80 to 0.93 of it"
    )
    return Estimate(usual, "Pa", low, high, source)


def thermal_expansion(wires: Wires) -> Estimate:
    """Estimate the thermal expansion [1/K] of wires that strain alike: sum(alpha E A)/sum(E A), as IEC 61597 has it."""
    usual = _expansion(wires, ALUMINIUM_MODULUS, STEEL_MODULUS)
    ends = _expansion(wires, 50e9, STEEL_MODULUS), _expansion(wires, ALUMINIUM_MODULUS, 180e9)
    source = (
        f"sum(alpha E A)/sum(E A) of the wires (IEC 61597, read in RTE's package stranded-cable; {WIRE_FIGURES}); "
        "range: moduli of 50 to 68 GPa of aluminium, 180 to 207 GPa of steel"
    )
    return Estimate(usual, "1/K", min(*ends, usual), max(*ends, usual), source)


def torsional_rigidity(wires: Wires) -> Estimate:
    """Estimate GJ [N m2] of layers of helical wires that slide freely.

    Under a twist Theta' a wire at radius r with lay angle a strains by r Theta' sin a cos a along itself, so that a
    wire of area A stores E A (r sin a cos a)^2/(2 cos a) per length of conductor, besides its own torsion:
    GJ = E A r^2 sin^2 a cos a + sum of G pi d^4/32. The aluminium fills a ring around the core, whose mean r^2 is that
    of its area. Wires that stick stiffen the conductor, loose ones soften it.
    """
    outer, core = 0.5 * wires.diameter, wires.core_radius
    wire = _wire_diameter(wires.aluminium_area, wires.aluminium_wires)
    angle = math.atan(math.pi * (1.0 - wire / wires.diameter) / LAY_RATIO)
    square = 0.5 * (outer**2 + core**2)
    helical = ALUMINIUM_MODULUS * wires.aluminium_area * square * math.sin(angle) ** 2 * math.cos(angle)
    own = _own_torsion(wires.aluminium_area, wires.aluminium_wires, ALUMINIUM_MODULUS, ALUMINIUM_POISSON)
    own += _own_torsion(wires.steel_area, wires.steel_wires, STEEL_MODULUS, STEEL_POISSON)
    value = helical + own
    source = (
        "energy of layers of helical wires that slide freely, lay ratio 12, besides the torsion of each wire "
        f"({WIRE_FIGURES}); range assumed: half to twice, since wires stick and loosen"
    )
    return Estimate(value, "N m2", 0.5 * value, 2.0 * value, source)


def torsional_rigidity_of_diameter(diameter: float) -> Estimate:
    """Estimate GJ [N m2] as that of the source's conductor, scaled with the fourth power of the diameter [m]."""
    rigidity, reference = SOURCE_CONDUCTOR
    value = rigidity * (diameter / reference) ** 4
    source = (
        "Galloping of bundle conductor, Table 1: 101 N m2 at 28.6 mm, scaled with the fourth power of the diameter; "
        "range assumed: half, to 4.2 times, which few thick wires around a core reach (8/1)"
    )
    return Estimate(value, "N m2", 0.5 * value, 4.2 * value, source)


def polar_inertia(wires: Wires, mass: float) -> Estimate:
    """Estimate the polar inertia of the bare conductor per length [kg m], with its mass per length [kg/m].

    A steel core within a ring of aluminium, each of even density.
    """
    outer, core = 0.5 * wires.diameter, wires.core_radius
    aluminium, steel = 2700.0 * wires.aluminium_area, 7780.0 * wires.steel_area
    square = (aluminium * 0.5 * (outer**2 + core**2) + steel * 0.5 * core**2) / (aluminium + steel)
    value, disc = mass * square, 0.5 * mass * outer**2
    source = "core and ring of even density; range: 0.9 times that, up to an even disc or 1.1 times that"
    return Estimate(value, "kg m", 0.9 * value, max(disc, 1.1 * value), source)


def polar_inertia_of_disc(diameter: float, mass: float) -> Estimate:
    """Estimate the polar inertia of a bare conductor of unknown wires per length [kg m]."""
    disc = mass * diameter**2 / 8.0
    source = "assumed: 0.9 times that of an even disc, since steel lies in the middle; range 0.75 to 1"
    return Estimate(0.9 * disc, "kg m", 0.75 * disc, disc, source)


def iced_polar_inertia(diameter: float, mass: float) -> Estimate:
    """Estimate the polar inertia of an iced sub-conductor whose ice is unknown, per length [kg m]."""
    disc = mass * diameter**2 / 8.0
    source = "assumed: 1.4 times that of its mass on an even disc of the bare diameter; range 1 to 3 for thick ice"
    return Estimate(1.4 * disc, "kg m", disc, 3.0 * disc, source)


def damping_ratio(direction: str) -> Estimate:
    """Estimate the structural damping ratio of a direction, vertical, horizontal or torsional, at one loop."""
    if direction == "torsional":
        return Estimate(
            0.05,
            "",
            0.01,
            0.31,
            "assumed: a few percent; Galloping of bundle conductor, Table 1 has 0.308, the largest value known here",
        )
    return Estimate(
        0.001,
        "",
        0.0005,
        0.005,
        "assumed: 0.05 to 0.5 %; Galloping of bundle conductor, Table 1 has 0.0515 %, measured on its conductor",
    )


DAMPING_MODEL = DampingModel.CONSTANT_COEFFICIENT


def _expansion(wires: Wires, aluminium: float, steel: float) -> float:
    soft, stiff = aluminium * wires.aluminium_area, steel * wires.steel_area
    return (ALUMINIUM_EXPANSION * soft + STEEL_EXPANSION * stiff) / (soft + stiff)


def _wire_diameter(area: float, wires: int | None) -> float:
    """Return the diameter of each wire [m]; of nothing or an unknown number, none."""
    return math.sqrt(4.0 * area / (math.pi * wires)) if wires else 0.0


def _own_torsion(area: float, wires: int | None, modulus: float, poisson: float) -> float:
    """Return the sum of G J of wires [N m2]."""
    shear = 0.5 * modulus / (1.0 + poisson)
    return (wires or 0) * shear * math.pi * _wire_diameter(area, wires) ** 4 / 32.0
