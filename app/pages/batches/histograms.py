"""How a figure is spread over the lines of a batch, as bars."""

from collections.abc import Sequence

from markupsafe import Markup

from app.pages.drawings.scales import ticks
from app.pages.drawings.svg import element, picture
from app.pages.measures import Units, plain
from app.pages.wording import words

_SIZE = (420.0, 200.0)
_LEFT, _RIGHT, _TOP, _BOTTOM = 34.0, 10.0, 14.0, 36.0
_BINS = 12


def counted(values: Sequence[float]) -> list[tuple[float, float, int]]:
    """Return bins of equal and round width from zero on: low, high, and how many values lie in [low, high)."""
    if not values:
        return []
    top = max(values) or 1.0
    edges = ticks(0.0, 1.0001 * top, _BINS)
    width = edges[1] - edges[0] if len(edges) > 1 else top
    counts = [0] * (int(top / width) + 1)
    for value in values:
        counts[max(0, int(value / width))] += 1
    return [(number * width, (number + 1) * width, count) for number, count in enumerate(counts)]


def histogram(title: str, values: Sequence[float], si: str, units: Units) -> Markup:
    """Return the bars of values in SI; empty without values. Each bar says its range and its number."""
    bins = counted([units.value(value, si) for value in values])
    if not bins:
        return Markup("")
    unit, most = units.unit(si).name, max(count for _, _, count in bins)
    across = (_SIZE[0] - _LEFT - _RIGHT) / bins[-1][1]
    up = (_SIZE[1] - _TOP - _BOTTOM) / most
    base = _SIZE[1] - _BOTTOM
    parts = []
    for low, high, count in bins:
        said = words().batch.bar.format(low=plain(low), high=plain(high), unit=unit, count=count)
        x, width = _LEFT + across * low, across * (high - low)
        bar = {"x": x + 0.5, "y": base - up * count, "width": max(width - 1.0, 0.5), "height": up * count}
        parts.append(element("rect", element("title", said), class_="count", **bar))
        if count:
            parts.append(
                element("text", str(count), x=x + 0.5 * width, y=base - up * count - 3.0, class_="figures mid")
            )
    parts += [
        element("text", f"{tick:.4g}", x=_LEFT + across * tick, y=base + 14.0, class_="figures mid")
        for tick in ticks(0.0, bins[-1][1], 7)
    ]
    parts.append(element("line", x1=_LEFT, x2=_SIZE[0] - _RIGHT, y1=base, y2=base, class_="grid"))
    parts.append(element("text", f"{title} [{unit}]", x=0.5 * _SIZE[0], y=_SIZE[1] - 6.0, class_="mid"))
    return picture(_SIZE, words().batch.histogram.format(name=title, count=len(values)), parts, "drawing histogram")
