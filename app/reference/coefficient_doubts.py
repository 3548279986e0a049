"""Tell the usual slips in aerodynamic coefficients: slopes per degree, angles in radians, lift and drag swapped.

The sign of a moment cannot be told from a table alone, only where the ice would have to point for it: `ice_direction`.
"""

import math
from collections.abc import Iterator, Mapping, Sequence

Row = tuple[float, float, float, float]
"""Angle [deg], and coefficients of lift, drag and moment."""

_DEGREES = math.degrees(1.0)
_PER_DEGREE = (0.15, 0.01, 1e-3)
"""Largest cubics per degree: a tenth of what iced sections have per radian, over 57.3 and its powers."""
_FULL_TURN_RADIANS = 6.4
_LARGE_CHANGE = 0.3
"""Change of lift or drag that no section has within a few degrees."""
_SMALL_DRAG = 0.2
"""No iced conductor has less drag, and lift crosses zero somewhere."""
_EXPLAINED = 0.5
"""Share of the moment's variation that the centre of pressure must explain to tell its direction."""


def cubic_doubts(cubics: Mapping[str, Sequence[float]]) -> list[str]:
    """Return a sentence if cubics over the angle look as if they were per degree.

    Parameters
    ----------
    cubics : mapping
        a_1, a_2, a_3 by direction, said to be per radian.
    """
    largest = [max((abs(row[power]) for row in cubics.values()), default=0.0) for power in range(3)]
    curved = max(largest[1:])
    if largest[0] == 0.0 or curved == 0.0 or any(a > most for a, most in zip(largest, _PER_DEGREE, strict=True)):
        return []
    shown = ", ".join(
        f"{name} {', '.join(f'{value * _DEGREES ** (j + 1):.3g}' for j, value in enumerate(row))}"
        for name, row in cubics.items()
    )
    return [
        "the coefficients are so small that they look like slopes per degree; slopes are per radian, which would make "
        f"them {shown}"
    ]


def table_doubts(rows: Sequence[Row]) -> list[str]:
    """Return a sentence for every slip that a table of measured coefficients shows."""
    return [*_angle_doubts(rows), *_drag_doubts(rows)]


def _angle_doubts(rows: Sequence[Row]) -> Iterator[str]:
    angles, lift, drag = ([row[i] for row in rows] for i in range(3))
    span = max(angles) - min(angles)
    change = max(max(lift) - min(lift), max(drag) - min(drag))
    if 0.0 < span <= _FULL_TURN_RADIANS and change >= _LARGE_CHANGE:
        yield (
            f"lift or drag change by {change:.2g} within {span:.3g} degrees, so the angles look like radians; they are "
            f"in degrees, which would make the range {span * _DEGREES:.4g}"
        )


def _drag_doubts(rows: Sequence[Row]) -> Iterator[str]:
    lift, drag = ([row[i] for row in rows] for i in (1, 2))
    negative = sum(value < 0.0 for value in drag)
    if min(lift) > 0.0 and (negative or min(drag) < _SMALL_DRAG < min(lift)):
        yield (
            f"lift and drag look swapped: lift is positive at all {len(rows)} angles, and the smallest drag is "
            f"{min(drag):.3g}"
        )
    elif negative:
        yield f"drag is negative at {negative} of {len(rows)} angles; drag is positive downwind"


def ice_direction(rows: Sequence[Row]) -> float | None:
    """Return where the ice points at angle 0, clockwise from straight up, for the moments of a table [deg].

    Lift L and drag D act at a centre of pressure that turns with the ice at a distance e from the centre, as M = e
    (D cos phi - L sin phi), phi = angle + direction. If the ice points to the opposite side, the moment has the other
    sign. None if that explains less than half of the moment.
    """
    terms = []
    for angle, lift, drag, moment in rows:
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        terms.append((drag * c - lift * s, -drag * s - lift * c, moment))
    aa, ab, bb = (sum(row[i] * row[j] for row in terms) for i, j in ((0, 0), (0, 1), (1, 1)))
    am, bm, mm = (sum(row[i] * row[2] for row in terms) for i in range(3))
    determinant = aa * bb - ab**2
    if determinant <= 1e-12 * aa * bb or mm == 0.0:
        return None
    along, across = (bb * am - ab * bm) / determinant, (aa * bm - ab * am) / determinant
    if along * am + across * bm < _EXPLAINED * mm:
        return None
    return round(math.degrees(math.atan2(across, along)), 9) % 360.0
