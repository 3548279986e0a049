"""Densities of accreted ice by kind: a usual value, and the range in which accretions lie."""

from collections.abc import Mapping
from enum import StrEnum

from engine.known.estimate import Estimate

_THESIS = "a chapter on atmospheric icing (clicours.com/types-of-atmospheric-icing-accretion)"


class IceKind(StrEnum):
    """How the ice formed."""

    GLAZE = "glaze"
    WET_SNOW = "wet_snow"
    HARD_RIME = "hard_rime"
    SOFT_RIME = "soft_rime"


_DENSITIES: Mapping[IceKind, Estimate] = {
    IceKind.GLAZE: Estimate(
        900.0,
        "kg/m3",
        800.0,
        917.0,
        f"glaze: {_THESIS} says more than 900 kg/m3, a glossary of meteorology (blossary.com) up to 800 or 900 kg/m3; "
        "917 is solid ice",
    ),
    IceKind.WET_SNOW: Estimate(
        500.0, "kg/m3", 300.0, 800.0, "assumed: the range for wet snow was found in no source that could be opened"
    ),
    IceKind.HARD_RIME: Estimate(
        750.0,
        "kg/m3",
        600.0,
        900.0,
        f"hard rime, middle of the range: {_THESIS} says 300 to 900 kg/m3 for rime and less than 600 for soft rime",
    ),
    IceKind.SOFT_RIME: Estimate(
        450.0,
        "kg/m3",
        300.0,
        600.0,
        f"soft rime, middle of the range: {_THESIS} says 300 to 900 kg/m3 for rime and less than 600 for soft rime",
    ),
}


def density_of(kind: IceKind) -> Estimate:
    """Return the density of a kind of ice [kg/m3]."""
    return _DENSITIES[kind]
