"""Where the lines of a batch stand: their coordinates to scale, without tiles from elsewhere."""

from collections.abc import Callable, Iterator, Sequence
from math import cos, radians
from typing import Any

from markupsafe import Markup

from app.pages.batches.overviews import Feature
from app.pages.drawings.scales import Scale, fitting
from app.pages.drawings.svg import Point, element, path
from app.pages.measures import Units
from app.pages.wording import word_for, words

_SIZE = (900.0, 480.0)
_METRES_A_DEGREE = 111_195.0  # of a meridian of the sphere of 6371 km
_ROUND = (1.0, 2.0, 5.0)


def tracks(geometry: Any) -> Iterator[list[Point]]:
    """Yield the courses of a geometry as (longitude, latitude) [deg]; a point is a course of one place."""
    if not isinstance(geometry, dict):
        return
    for part in geometry.get("geometries") or ():
        yield from tracks(part)
    yield from _courses(geometry.get("coordinates"))


def batch_map(features: Sequence[Feature], units: Units, address: Callable[[int], str]) -> Markup:
    """Return the map of the lines that have coordinates, each a link to its result; empty if none has any.

    Equirectangular about the middle latitude: true to scale there, and along every meridian.
    """
    placed = [(feature["properties"], list(tracks(feature["geometry"]))) for feature in features]
    places = [place for _, courses in placed for course in courses for place in course]
    if not places:
        return Markup("")
    low, high = min(at for _, at in places), max(at for _, at in places)
    narrowing = cos(radians(0.5 * (low + high)))

    def metres(place: Point) -> Point:
        return _METRES_A_DEGREE * place[0] * narrowing, _METRES_A_DEGREE * place[1]

    scale = fitting([metres(place) for place in places], _SIZE, 30.0, least=200.0)
    parts = []
    for line, courses in reversed(placed):  # what matters most is drawn last, on top
        said = line["name"] or line["reference"] or words().batch.number.format(number=line["number"])
        text = f"{said}: {word_for(words().gallops, line['gallops'] or 'waiting')}"
        drawn = [_drawn([scale.place(metres(place)) for place in course]) for course in courses]
        look = f"place {line['gallops'] or 'unknown'}"
        if drawn:
            title, to = element("title", text), address(line["number"])
            parts.append(element("a", title, *drawn, href=to, aria_label=text, class_=look))
    box = f"0 0 {_SIZE[0]:g} {_SIZE[1]:g}"  # a group, since an image could not hold links
    inside = (*parts, *_bar(scale, units))
    return element("svg", *inside, viewBox=box, role="group", aria_label=words().batch.map, class_="drawing map")


def _courses(coordinates: Any) -> Iterator[list[Point]]:
    if not isinstance(coordinates, list) or not coordinates:
        return
    if isinstance(coordinates[0], int | float):
        yield [(float(coordinates[0]), float(coordinates[1]))]
    elif isinstance(coordinates[0][0], int | float):
        yield [(float(place[0]), float(place[1])) for place in coordinates]
    else:
        for part in coordinates:
            yield from _courses(part)


def _drawn(course: Sequence[Point]) -> Markup:
    if len(course) == 1:
        return element("circle", cx=course[0][0], cy=course[0][1], r=4.0)
    return element("path", d=path(course))


def _bar(scale: Scale, units: Units) -> Iterator[Markup]:
    """Yield a bar of a round length, at most a quarter of the map."""
    most = units.value(0.25 * _SIZE[0] / scale.per_metre, "m")
    length = max(by * 10.0**power for power in range(9) for by in _ROUND if by * 10.0**power <= most)
    width = length / units.unit("m").factor * scale.per_metre
    x, y = 16.0, _SIZE[1] - 12.0
    yield element("path", d=f"M{x} {y - 5.0}V{y}H{x + width:.1f}V{y - 5.0}", class_="scale-bar")
    yield element(
        "text", f"{length:,.0f} {units.unit('m').name}".replace(",", "\N{NARROW NO-BREAK SPACE}"), x=x + 6.0, y=y - 5.0
    )
