"""What lines of an owner may name."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from app.reference.catalogue_row import CatalogueRow


@dataclass(frozen=True, slots=True)
class OwnRows:
    """What an owner keeps: conductors, and tables of measured coefficients by name, as documents."""

    conductors: Sequence[CatalogueRow] = ()
    tables: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
