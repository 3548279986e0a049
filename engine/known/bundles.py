"""Bundles as line engineers name them: a number, a spacing and an arrangement."""

import math
from enum import StrEnum

from engine.outcome import Fault, require
from engine.spec import Bundle, CrossSection
from engine.spec.rules import positive


class Arrangement(StrEnum):
    """How the sub-conductors of a regular bundle stand."""

    HORIZONTAL = "horizontal"
    VERTICAL = "vertical"
    TRIANGLE = "triangle"
    INVERTED_TRIANGLE = "inverted_triangle"
    SQUARE = "square"
    DIAMOND = "diamond"
    POLYGON = "polygon"


# Sub-conductors, and the angle of the first one from straight up. A polygon stands on an edge.
_FIXED = {
    Arrangement.HORIZONTAL: (2, 0.5 * math.pi),
    Arrangement.VERTICAL: (2, 0.0),
    Arrangement.TRIANGLE: (3, 0.0),
    Arrangement.INVERTED_TRIANGLE: (3, math.pi),
    Arrangement.SQUARE: (4, 0.25 * math.pi),
    Arrangement.DIAMOND: (4, 0.0),
}
USUAL = {2: Arrangement.HORIZONTAL, 3: Arrangement.INVERTED_TRIANGLE, 4: Arrangement.SQUARE}


def arranged(
    subconductors: int, spacing: float | None, arrangement: Arrangement | None, section: CrossSection | None = None
) -> Bundle:
    """Return the bundle of a number of sub-conductors at equal distances of neighbours.

    Parameters
    ----------
    subconductors : int
    spacing : float or None
        Distance of neighbours [m]; None for one sub-conductor.
    arrangement : Arrangement or None
        None for the usual one: a horizontal twin, a triple with one below, a square quad, a polygon on an edge.
    section : CrossSection or None
        How the section moves.

    Raises
    ------
    InvalidSpec
        If the spacing or the arrangement does not fit the number.
    """
    single = subconductors == 1
    chosen = USUAL.get(subconductors, Arrangement.POLYGON) if arrangement is None else arrangement
    count = _FIXED[chosen][0] if chosen in _FIXED else subconductors
    rule = f"must fit the number of sub-conductors: {chosen.value} means {count}, there are {subconductors}"
    require(
        None if subconductors >= 1 else Fault("bundle.subconductors", subconductors, "must be at least 1"),
        positive("bundle.spacing", spacing),
        Fault("bundle.spacing", spacing, "must be given for more than one sub-conductor")
        if spacing is None and not single
        else None,
        Fault("bundle.spacing", spacing, "must be absent for one sub-conductor") if spacing and single else None,
        Fault("bundle.arrangement", chosen.value, rule) if not single and count != subconductors else None,
        Fault("bundle.arrangement", chosen.value, "must be absent for one sub-conductor")
        if single and arrangement is not None
        else None,
    )
    if spacing is None:
        return Bundle(section=section)
    step = math.pi / subconductors
    first = _FIXED[chosen][1] if chosen in _FIXED else step
    return Bundle.regular(subconductors, 0.5 * spacing / math.sin(step), first, section)
