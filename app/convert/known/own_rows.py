"""What lines of an owner may name."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from app.reference.catalogue_row import CatalogueRow, name_key
from app.reference.conductors import NamedRows

_PLACES = ("by_name", "by_designation")


@dataclass(frozen=True, slots=True)
class OwnRows:
    """What an owner keeps: conductors, and tables of measured coefficients by name, as documents."""

    conductors: Sequence[CatalogueRow] = ()
    tables: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    named: NamedRows = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Sort the conductors by name once, for all lines of a batch."""
        object.__setattr__(self, "named", NamedRows.of(self.conductors))

    def named_in(self, line: Mapping[str, Any]) -> dict[str, Any]:
        """Return the rows that a line document may name, as a document."""
        ice = line.get("ice")
        coefficients = ice.get("aerodynamics") if isinstance(ice, Mapping) else None
        wanted = {_named(line.get("conductor")), _named(coefficients)} - {None}
        found = (row for key in wanted for by in _PLACES for row in getattr(self.named, by).get(key, ()))
        rows = list({id(row): row for row in found}.values())
        tables = [document for name, document in self.tables.items() if name_key(name) in wanted]
        return {"conductors": [asdict(row) for row in rows], "tables": tables}

    @classmethod
    def of(cls, document: Mapping[str, Any]) -> "OwnRows":
        """Return the rows of a document that `named_in` made."""
        rows = [CatalogueRow(**row) for row in document["conductors"]]
        return cls(rows, {table["name"]: table for table in document["tables"]})


def _named(part: object) -> str | None:
    name = part.get("catalogue") if isinstance(part, Mapping) else None
    return name_key(name) if isinstance(name, str) else None
