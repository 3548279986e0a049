"""Branches of motions over the wind speed as pictures draw them: stretches of one stability, and marked points."""

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from app.plots.facts import Found, Row

Key = tuple[str, int, int]  # model, loops, branch
AMPLITUDES = ("vertical_m", "horizontal_m", "torsional_rad")
_WIND = "wind_speed_m_per_s"


@dataclass(frozen=True, slots=True)
class Stretch:
    """Neighbouring points of a branch that have one stability; whole is false where only the winds asked for are known.

    Points are rows with a wind speed and three amplitudes. A stretch begins with the last point of the one before it.
    """

    key: Key
    stability: str
    whole: bool
    points: Sequence[Row]


@dataclass(frozen=True, slots=True)
class Mark:
    """A bifurcation in a picture: its row, and the point of its branch, None where that is not known."""

    row: Row
    point: Row | None


def stretches(found: Found) -> Iterator[Stretch]:
    """Yield whole curves where the result has them, else lines from the Hopf point through the winds asked for."""
    curves: dict[tuple[Key, int], list[Row]] = {}
    for row in found.get("amplitude_curves", ()):
        curves.setdefault((_key(row), row["curve"]), []).append(row)
    for (key, _), rows in curves.items():
        yield from _by_stability(key, sorted(rows, key=lambda row: row["point"]))
    with_curves = {key for key, _ in curves}
    for key, rows in _at_winds(found).items():
        if key not in with_curves:
            yield from _joined(key, rows, found)


def marks(found: Found) -> list[Mark]:
    """Return the bifurcations with their places on the branches; a Hopf point has no amplitude."""
    lines: dict[Key, list[Sequence[Row]]] = {}
    for stretch in stretches(found):
        lines.setdefault(stretch.key, []).append(stretch.points)
    return [Mark(row, _place(row, lines.get(_key(row), ()))) for row in found.get("bifurcations", ())]


def _key(row: Row) -> Key:
    return row["model"], row["loops"], row["branch"]


def _by_stability(key: Key, rows: Sequence[Row]) -> Iterator[Stretch]:
    """Divide a curve where stability changes; the Hopf point itself belongs to what begins there."""
    start = 0
    kinds = [_between(before, after) for before, after in itertools.pairwise(rows)]
    for place in range(1, len(rows)):
        if place == len(rows) - 1 or kinds[place] != kinds[start]:
            yield Stretch(key, kinds[start], True, rows[start : place + 1])
            start = place


def _between(before: Row, after: Row) -> str:
    """Return the stability between two points: that of the first one, unless only the other is known."""
    return str(after["stability"] if before["stability"] == "unknown" else before["stability"])


def _at_winds(found: Found) -> dict[Key, list[Row]]:
    groups: dict[Key, list[Row]] = {}
    for row in found.get("limit_cycles", ()):
        if row["branch"] is not None and row.get("kind") != "quasi_periodic" and row["vertical_m"] is not None:
            groups.setdefault(_key(row), []).append(row)
    return groups


def _joined(key: Key, rows: Sequence[Row], found: Found) -> Iterator[Stretch]:
    """Join the motions at the winds asked for where each wind has one, from the Hopf point on."""
    winds = [row[_WIND] for row in rows]
    if len(set(winds)) < len(winds):  # at a fold a joined line would zigzag
        return
    hopf = [
        {_WIND: row[_WIND], **dict.fromkeys(AMPLITUDES, 0.0), "stability": "unknown"}
        for row in found.get("bifurcations", ())
        if row["type"] == "hopf" and _key(row) == key and not min(winds) <= row[_WIND] <= max(winds)
    ]
    ordered: list[Row] = sorted([*hopf, *rows], key=lambda row: float(row[_WIND]))
    for stretch in _by_stability(key, ordered):
        yield Stretch(key, stretch.stability, False, stretch.points)


def _place(row: Row, lines: Sequence[Sequence[Row]]) -> Row | None:
    """Return the point of a branch at the wind of a bifurcation; at several, where stability changes or at a fold."""
    wind = row[_WIND]
    if row["type"] == "hopf":
        return {_WIND: wind, **dict.fromkeys(AMPLITUDES, 0.0)}
    if row["type"] == "fold":
        ends = [point for line in lines for point in _turns(line)]
    else:
        ends = [point for line in lines for point in (line[0], line[-1])]
    near = min(ends, key=lambda point: abs(point[_WIND] - wind), default=None)
    crossings = [point for line in lines for point in _crossings(line, wind)]
    if not crossings:
        return {**near, _WIND: wind} if near is not None and _is_near(near, wind, lines) else None
    if near is None:
        return crossings[0]
    return min(crossings, key=lambda point: abs(point["vertical_m"] - near["vertical_m"]))


def _turns(line: Sequence[Row]) -> Iterator[Row]:
    """Yield the points where the wind turns back along a line, and its ends."""
    yield line[0]
    yield line[-1]
    for before, here, after in zip(line[:-2], line[1:-1], line[2:], strict=True):
        if (here[_WIND] - before[_WIND]) * (after[_WIND] - here[_WIND]) < 0.0:
            yield here


def _is_near(point: Row, wind: float, lines: Sequence[Sequence[Row]]) -> bool:
    """Tell whether a point is within a twentieth of the branch's range of wind speeds."""
    winds = [row[_WIND] for line in lines for row in line]
    return bool(abs(point[_WIND] - wind) <= 0.05 * (max(winds) - min(winds)))


def _crossings(line: Sequence[Row], wind: float) -> Iterator[Mapping[str, float]]:
    """Yield the points of a line at a wind speed, between its points in proportion."""
    for before, after in itertools.pairwise(line):
        low, high = before[_WIND], after[_WIND]
        if low != high and min(low, high) <= wind <= max(low, high):
            part = (wind - low) / (high - low)
            yield {
                _WIND: wind,
                **{name: before[name] + part * (after[name] - before[name]) for name in AMPLITUDES},
            }
