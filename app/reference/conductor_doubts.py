"""Hold the figures of a conductor against each other: mass, diameter, modulus and expansion against its wires.

Densities, moduli and expansions of wires are those of EN 60889, EN 50183 and EN 50189; the modulus of a strand is lower
than that of its wires, since these lie askew (Austrian tables of EN 50182: 60 GPa for 7 wires of aluminium, 55 GPa for
61).
"""

import math
from collections.abc import Iterator

from app.reference.catalogue_row import CatalogueRow

ALUMINIUM_DENSITY, STEEL_DENSITY = 2700.0, 7780.0  # kg/m3
_LAY = (0.98, 1.035)
"""Mass of wires along the conductor over density times area: at least a printed digit less, at most the longest lay."""
_ALUMINIUM_MODULUS, _STEEL_MODULUS = (50e9, 68e9), (180e9, 207e9)  # Pa
_ALUMINIUM_EXPANSION, _STEEL_EXPANSION = 23.0e-6, 11.5e-6  # 1/K
_PRINTED = 0.015
"""How far a printed figure may be from the one that the wires give."""
_FILLED = (0.6, 0.93)
"""Share of the circle that round or shaped wires fill."""
_STRENGTH = (1.2e8, 9e8)  # Pa


def doubts(row: CatalogueRow) -> list[str]:
    """Return a sentence for every figure that the other figures of a row contradict."""
    return [*_areas(row), *_mass(row), *_diameter(row), *_modulus(row), *_expansion(row), *_strength(row)]


def _areas(row: CatalogueRow) -> Iterator[str]:
    if row.area_m2 is None:
        return
    if row.aluminium_area_m2 is not None and row.aluminium_area_m2 > row.area_m2 * (1.0 + _PRINTED):
        yield f"the area of aluminium, {_mm2(row.aluminium_area_m2)}, is larger than the area, {_mm2(row.area_m2)}"
    wires = row.aluminium_wires, row.aluminium_wire_diameter_m
    if wires[0] and wires[1] is not None and row.aluminium_area_m2 is not None:
        area = wires[0] * math.pi / 4.0 * wires[1] ** 2
        if not math.isclose(area, row.aluminium_area_m2, rel_tol=_PRINTED):
            yield (
                f"{wires[0]} wires of {1e3 * wires[1]:g} mm have {_mm2(area)} of aluminium, "
                f"not {_mm2(row.aluminium_area_m2)}"
            )


def _mass(row: CatalogueRow) -> Iterator[str]:
    if row.area_m2 is None or row.aluminium_area_m2 is None:
        return
    steel = row.area_m2 - row.aluminium_area_m2
    metal = ALUMINIUM_DENSITY * row.aluminium_area_m2 + STEEL_DENSITY * steel
    if not _LAY[0] <= row.mass_kg_per_m / metal <= _LAY[1]:
        yield f"the mass, {row.mass_kg_per_m:g} kg/m, is not that of its areas, about {1.02 * metal:.4g} kg/m"


def _diameter(row: CatalogueRow) -> Iterator[str]:
    layers = _layered_diameter(row)
    if layers is not None and not math.isclose(layers, row.diameter_m, rel_tol=2.0 * _PRINTED):
        yield f"the diameter, {1e3 * row.diameter_m:g} mm, is not that of its layers of wires, {1e3 * layers:.4g} mm"
    if row.area_m2 is not None:
        filled = row.area_m2 / (math.pi / 4.0 * row.diameter_m**2)
        if not _FILLED[0] <= filled <= _FILLED[1]:
            yield f"the area fills {100.0 * filled:.0f} % of the circle of the diameter; wires fill 60 to 93 %"


def _layered_diameter(row: CatalogueRow) -> float | None:
    """Return the diameter of round wires in layers around the core [m]; None if the wires are not known."""
    wires, wire = row.aluminium_wires, row.aluminium_wire_diameter_m
    if not wires or wire is None or row.steel_wires is None:
        return None
    if row.steel_wires == 0:
        diameter, left = wire, wires - 1
    elif row.steel_wire_diameter_m is None or row.steel_wires not in {1, 7, 19}:
        return None
    else:
        diameter, left = row.steel_wire_diameter_m * {1: 1, 7: 3, 19: 5}[row.steel_wires], wires
    while left > 0:
        diameter += 2.0 * wire
        left -= round(math.pi / math.asin(wire / (diameter - wire)))
    return diameter


def _modulus(row: CatalogueRow) -> Iterator[str]:
    share = _steel_share(row)
    if share is None or row.youngs_modulus_pa is None:
        return
    least, most = (
        (1.0 - share) * aluminium + share * steel
        for aluminium, steel in zip(_ALUMINIUM_MODULUS, _STEEL_MODULUS, strict=True)
    )
    if not least <= row.youngs_modulus_pa <= most:
        yield (
            f"the modulus, {1e-9 * row.youngs_modulus_pa:g} GPa, is not between {1e-9 * least:.0f} and "
            f"{1e-9 * most:.0f} GPa, the mixture of its wires"
        )


def _expansion(row: CatalogueRow) -> Iterator[str]:
    share = _steel_share(row)
    if share is None or row.thermal_expansion_per_k is None:
        return
    stiff = mixed_expansion(share, _ALUMINIUM_MODULUS[0], _STEEL_MODULUS[1]) * (1.0 - _PRINTED)
    soft = mixed_expansion(share, _ALUMINIUM_MODULUS[1], _STEEL_MODULUS[0]) * (1.0 + _PRINTED)
    if not stiff <= row.thermal_expansion_per_k <= soft:
        yield (
            f"the thermal expansion, {1e6 * row.thermal_expansion_per_k:g}e-6/K, is not between {1e6 * stiff:.3g}e-6 "
            f"and {1e6 * soft:.3g}e-6/K, the mixture of its wires"
        )


def mixed_expansion(steel_share: float, aluminium_modulus: float, steel_modulus: float) -> float:
    """Return the thermal expansion of wires that strain alike [1/K]: the mean of both, weighted with stiffness.

    Energies 13 (2020) 411, equation (1), gives it as the usual way to compute a conductor's.
    """
    aluminium, steel = (1.0 - steel_share) * aluminium_modulus, steel_share * steel_modulus
    return (aluminium * _ALUMINIUM_EXPANSION + steel * _STEEL_EXPANSION) / (aluminium + steel)


def _strength(row: CatalogueRow) -> Iterator[str]:
    if row.rated_strength_n is None or row.area_m2 is None:
        return
    stress = row.rated_strength_n / row.area_m2
    if not _STRENGTH[0] <= stress <= _STRENGTH[1]:
        yield f"the rated strength is {1e-6 * stress:.0f} MPa over the area; conductors have 120 to 900 MPa"


def _steel_share(row: CatalogueRow) -> float | None:
    if row.area_m2 is None or row.aluminium_area_m2 is None:
        return None
    return max(0.0, 1.0 - row.aluminium_area_m2 / row.area_m2)


def _mm2(area: float) -> str:
    return f"{1e6 * area:.4g} mm2"
