"""A bare conductor as a row of a catalogue: SI figures of a source, and what follows from them."""

from dataclasses import asdict, dataclass
from typing import Any

from app.reference.text_forms import folded

_WIRES = frozenset({"aluminium_wires", "steel_wires"})


def name_key(name: str) -> str:
    """Return a name in one form, without case and extra spaces, as conductors are compared by it."""
    return " ".join(folded(name).split())


@dataclass(frozen=True, slots=True)
class CatalogueRow:
    """Figures of one bare conductor; None where the source has none.

    Lengths in m, areas in m2, mass in kg/m, strength in N, modulus in Pa, expansion in 1/K.
    """

    name: str
    designation: str
    standard: str
    type: str
    aluminium_wires: int | None
    steel_wires: int | None
    aluminium_wire_diameter_m: float | None
    steel_wire_diameter_m: float | None
    aluminium_area_m2: float | None
    area_m2: float | None
    diameter_m: float
    mass_kg_per_m: float
    rated_strength_n: float | None
    youngs_modulus_pa: float | None
    thermal_expansion_per_k: float | None
    source: str
    source_address: str | None
    licence: str | None
    own: bool = False

    @property
    def stranding(self) -> str | None:
        """Wires of aluminium / of steel, where both are known."""
        if self.aluminium_wires is None or self.steel_wires is None:
            return None
        return f"{self.aluminium_wires}/{self.steel_wires}"

    def listed(self) -> dict[str, Any]:
        """Return the row as answers and the command line list it, with the stranding for the numbers of wires."""
        shown = {name: value for name, value in asdict(self).items() if name not in _WIRES}
        return {**shown, "stranding": self.stranding}
