"""The line of the guide, and the source's line, as engineers know them."""

from app.reference.catalogue_row import CatalogueRow as ShippedRow
from app.reference.conductors import named
from engine.known.bundles import arranged
from engine.known.description import (
    CatalogueRow,
    ConductorData,
    EverydayState,
    KnownAerodynamics,
    KnownConductor,
    KnownIce,
    KnownLine,
    KnownSpan,
    Reference,
)
from engine.known.ice_sections import Accretion, Shape
from engine.known.provenance import Origin
from engine.spec import Aerodynamics, Support, Supports

C11 = Aerodynamics((-0.1667, -4.0547, 8.3581), (0.8605, 0.8325, 1.7815), (-0.7272, 0.2935, 5.9704))


def catalogue_row(row: ShippedRow) -> CatalogueRow:
    """Return a shipped conductor as the engine takes it."""
    data = ConductorData(
        diameter=row.diameter_m,
        bare_mass=row.mass_kg_per_m,
        area=row.area_m2,
        aluminium_area=row.aluminium_area_m2,
        modulus=row.youngs_modulus_pa,
        rated_strength=row.rated_strength_n,
        thermal_expansion=row.thermal_expansion_per_k,
        aluminium_wires=row.aluminium_wires,
        steel_wires=row.steel_wires,
    )
    return CatalogueRow(row.name, "a table", data)


(_DRAKE,) = named("795 kcmil 26/7")
DRAKE = catalogue_row(_DRAKE)
SHAPE = KnownAerodynamics(C11, reference=Reference.BARE, origin=Origin.CATALOGUE, source="C11", spread=0.3)
GUIDE = KnownLine(
    conductor=KnownConductor(row=DRAKE),
    bundle=arranged(2, 0.457, None),
    span=KnownSpan(300.0, EverydayState(0.2, temperature=15.0), -5.0, 305.0),
    ice=KnownIce(SHAPE, Accretion(Shape.CRESCENT, 0.012, density=900.0, angle=0.0)),
    supports=Supports(
        left=Support(adjacent_span=280.0, insulator_length=2.4),
        right=Support(adjacent_span=330.0, insulator_length=2.4),
    ),
)
SPARSE = KnownLine(
    conductor=KnownConductor(row=DRAKE),
    bundle=arranged(1, None, None),
    span=KnownSpan(300.0),
    ice=KnownIce(KnownAerodynamics(C11), Accretion(Shape.CRESCENT, 0.012)),
)
