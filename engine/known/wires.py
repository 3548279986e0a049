"""The wires of a conductor: areas of aluminium and steel, and what follows from them.

Figures of round wires are those of EN 60889, EN 50183 and EN 50189 as the package stranded-cable lists them (RTE,
github.com/rte-france/pallas-stranded-cable, strdcable/data/norm_OHL_EN_wires.csv).
"""

import math
from dataclasses import dataclass

ALUMINIUM_MODULUS, STEEL_MODULUS = 68e9, 207e9  # Pa
ALUMINIUM_EXPANSION, STEEL_EXPANSION = 23.0e-6, 11.5e-6  # 1/K
ALUMINIUM_DENSITY, STEEL_DENSITY = 2700.0, 7780.0  # kg/m3
ALUMINIUM_POISSON, STEEL_POISSON = 0.33, 0.3
LAY_MASS = 1.023  # wires are longer than the conductor
FILLED = 0.76  # share of its circle that the wires of a conductor fill


@dataclass(frozen=True, slots=True)
class Wires:
    """Areas of aluminium and steel [m2], numbers of wires (None if unknown), and the diameter of the conductor [m]."""

    aluminium_area: float
    steel_area: float
    diameter: float
    aluminium_wires: int | None = None
    steel_wires: int | None = None

    @property
    def area(self) -> float:
        """Area of both metals [m2]."""
        return self.aluminium_area + self.steel_area

    @property
    def stiffness(self) -> float:
        """Sum of E A of all wires [N]."""
        return ALUMINIUM_MODULUS * self.aluminium_area + STEEL_MODULUS * self.steel_area

    @property
    def core_radius(self) -> float:
        """Radius of the steel core, whose wires fill as much of it as all wires of the conductor [m]."""
        return 0.5 * self.diameter * math.sqrt(self.steel_area / self.area)


def areas_from_mass(area: float, mass: float) -> tuple[float, float]:
    """Return the areas of aluminium and steel [m2] of a conductor with an area [m2] and a mass per length [kg/m]."""
    steel = (mass / LAY_MASS - ALUMINIUM_DENSITY * area) / (STEEL_DENSITY - ALUMINIUM_DENSITY)
    # A few percent of the aluminium's mass are within what figures are rounded to.
    steel = min(max(steel, 0.0), area)
    return (area, 0.0) if steel < 0.02 * area else (area - steel, steel)
