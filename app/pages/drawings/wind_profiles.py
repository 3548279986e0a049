"""The wind along a span: its profile, as a multiple of the wind speed of the analysis."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from markupsafe import Markup

from app.pages.drawings.scales import ticks
from app.pages.drawings.svg import Point, element, path, picture
from app.pages.measures import Units, plain
from app.pages.wording import words

SIZE = (560.0, 90.0)
_SIDE, _TOP, _BOTTOM = 26.0, 30.0, 22.0
_MOST_NAMED = 12


def wind_profile(line: Mapping[str, Any], units: Units) -> Markup | None:
    """Return the drawing of an explicit line's profile from 0 on, None where the wind is the same everywhere."""
    points = [(float(p["position_m"]), float(p["factor"])) for p in (line.get("wind") or {}).get("profile") or ()]
    if not points:
        return None
    length = float(line["span"]["length_m"])
    largest = max(factor for _, factor in points)

    def place(point: Point) -> Point:
        x = _SIDE + (SIZE[0] - 2.0 * _SIDE) * point[0] / length
        return x, SIZE[1] - _BOTTOM - (SIZE[1] - _TOP - _BOTTOM) * point[1] / largest

    held = [(0.0, points[0][1]), *points, (length, points[-1][1])]
    parts = [
        *_axis(length, place((0.0, 0.0))[1], units),
        element("path", d=path([place(point) for point in held]), class_="path"),
        *_named([(place(point), point[1]) for point in points]),
    ]
    return picture(SIZE, words().drawings.wind_profile, parts, "drawing profile")


def _axis(length: float, ground: float, units: Units) -> Iterator[Markup]:
    unit = units.unit("m")
    yield element("path", d=f"M{_SIDE} {ground:.2f}H{SIZE[0] - _SIDE}", class_="grid")
    yield element("text", words().drawings.wind_profile, x=_SIDE, y=14.0)
    for tick in ticks(0.0, length * unit.factor, 6):
        x = _SIDE + (SIZE[0] - 2.0 * _SIDE) * tick / (length * unit.factor)
        last = x > SIZE[0] - 3.0 * _SIDE
        text = f"{tick:.4g} {unit.name}"
        yield element("text", text, x=x, y=SIZE[1] - 4.0, class_="figures note" if last else "figures")


def _named(points: Sequence[tuple[Point, float]]) -> Iterator[Markup]:
    for (x, y), factor in points:
        yield element("circle", cx=x, cy=y, r=2.5, class_="wire")
        if len(points) <= _MOST_NAMED:
            yield element("text", plain(factor), x=x, y=y - 6.0, class_="figures mid")
