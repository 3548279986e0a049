"""A line as an engineer knows it: forms beside the numbers of a line, nothing required that can be estimated."""

from app.schemas.known.ice import Accretion, CatalogueShape, KnownCubics, KnownIce, KnownTable
from app.schemas.known.line import KnownDamping, KnownLine
from app.schemas.known.parts import Everyday, KnownBundle, KnownConductor, KnownSpan

__all__ = [
    "Accretion",
    "CatalogueShape",
    "Everyday",
    "KnownBundle",
    "KnownConductor",
    "KnownCubics",
    "KnownDamping",
    "KnownIce",
    "KnownLine",
    "KnownSpan",
    "KnownTable",
]
