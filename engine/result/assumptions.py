"""Where the values of a line came from, if it was resolved from what is known."""

from dataclasses import dataclass
from typing import Annotated, Literal

from engine.result.columns import Column

OriginWord = Literal["given", "catalogue", "computed", "assumed"]


@dataclass(frozen=True, slots=True)
class AssumptionRow:
    """One value of a line as an engineer knows it: said, read in a catalogue, computed from others, or assumed."""

    path: Annotated[str, Column("Dotted name of the field", "conductor.torsional_rigidity_n_m2")]
    value: Annotated[float, Column("Its value, in the unit of the next column", 173.2, unit="1")]
    unit: Annotated[str, Column("Unit; 1 for a number without one", "N m2")]
    origin: Annotated[OriginWord, Column("How the value is known", "assumed")]
    source: Annotated[str, Column("Where it came from, in a sentence", "energy of layers of helical wires that slide")]
    lowest: Annotated[float | None, Column("Lowest plausible value of an assumed one", 86.6, unit="1")]
    highest: Annotated[float | None, Column("Highest plausible value of an assumed one", 346.4, unit="1")]
