"""Scales of drawings: from metres to the units of a drawing, and round numbers for its grid."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import ceil, floor, log10

from markupsafe import Markup

from app.pages.drawings.svg import Point, element

_ROUND = (1.0, 2.0, 5.0, 10.0)


@dataclass(frozen=True, slots=True)
class Scale:
    """One scale for both directions: the middle of what is drawn [m], and drawing units per metre."""

    middle: Point
    per_metre: float
    size: Point

    def place(self, point: Point) -> Point:
        """Return where a point (to the right, up) [m] lies on the drawing."""
        x = 0.5 * self.size[0] + self.per_metre * (point[0] - self.middle[0])
        return x, 0.5 * self.size[1] - self.per_metre * (point[1] - self.middle[1])


def fitting(points: Iterable[Point], size: Point, margin: float, least: float = 0.0) -> Scale:
    """Return the scale at which all points [m] lie within a drawing; at least so many metres are shown."""
    across, up = zip(*points, strict=True)
    middle = (0.5 * (min(across) + max(across)), 0.5 * (min(up) + max(up)))
    extents = (max(max(across) - min(across), least), max(max(up) - min(up), least))
    room = (size[0] - 2.0 * margin, size[1] - 2.0 * margin)
    return Scale(middle, min(room[0] / max(extents[0], 1e-9), room[1] / max(extents[1], 1e-9)), size)


def scale_bar(scale: Scale, unit: str, per_metre: float) -> Iterator[Markup]:
    """Yield a bar of a round length with its figure, at the lower right; `per_metre` of the unit are a metre."""
    width, height = scale.size
    length = ticks(0.0, 0.3 * width / scale.per_metre * per_metre, 3)[-1]
    across = length / per_metre * scale.per_metre
    yield element("path", d=f"M{width - 12.0 - across:.2f} {height - 12.0}h{across:.2f}", class_="bar")
    yield element("text", f"{length:.4g} {unit}", x=width - 12.0, y=height - 18.0, class_="note")


def ticks(low: float, high: float, most: int) -> list[float]:
    """Return round numbers from low to high, at most so many."""
    rough = (high - low) / max(most - 1, 1)
    power = 10.0 ** floor(log10(rough))
    step = next(factor * power for factor in _ROUND if factor * power >= rough * (1.0 - 1e-9))
    return [number * step for number in range(ceil(low / step - 1e-9), floor(high / step + 1e-9) + 1)]
