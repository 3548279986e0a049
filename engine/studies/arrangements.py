"""Practical places for devices on a span: arrangements that crews use, and small changes of them.

Practice mounts devices at the quarter points and at mid-span, evenly over the span, or in the middles of equal parts.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from engine.spec import Line, PointDevice, Spacer

Places = tuple[float, ...]
ANCHORS = (0.25, 0.5, 0.75)  # of the span: the quarter points and mid-span
DECIMALS = 2  # places are whole centimetres
TOLERANCE = 1e-6  # of the separation


@dataclass(frozen=True, slots=True)
class Room:
    """Where devices may stand [m]: from lowest to highest, `separation` from one another and from places taken."""

    lowest: float
    highest: float
    separation: float
    taken: Places = ()

    def holds(self, places: Sequence[float]) -> bool:
        """Return whether places in rising order lie in the room and keep the separation."""
        slack = TOLERANCE * self.separation
        least = self.separation - slack
        return (
            all(self.lowest - slack <= place <= self.highest + slack for place in places)
            and all(right - left >= least for left, right in pairwise(places))
            and all(abs(place - other) >= least for place in places for other in self.taken)
        )

    def fitted(self, places: Iterable[float]) -> Places | None:
        """Return the places pushed apart and into the room, in rising order; None where they do not fit."""
        ordered = sorted(self._beside(place) for place in places)
        mirrored = [-place for place in reversed(ordered)]
        from_left = _pushed(ordered, self.lowest, self.highest, self.separation)
        from_right = [-place for place in reversed(_pushed(mirrored, -self.highest, -self.lowest, self.separation))]
        found = tuple(round(0.5 * (one + other), DECIMALS) for one, other in zip(from_left, from_right, strict=True))
        return found if self.holds(found) else None

    def _beside(self, place: float) -> float:
        """Return a place, or the nearest one that keeps the separation from the place taken beside it."""
        for other in self.taken:
            if abs(place - other) < self.separation:
                return other + self.separation if place >= other else other - self.separation
        return place


def room_on(line: Line, separation: float) -> Room:
    """Return the room on a span: a separation away from both supports and from the devices at points.

    Spacers take no room, because other devices are mounted beside them.
    """
    return Room(separation, line.span.length - separation, separation, taken_places(line))


def taken_places(line: Line) -> Places:
    """Return where devices stand that others must keep away from [m]."""
    return tuple(
        device.position for device in line.devices if isinstance(device, PointDevice) and not isinstance(device, Spacer)
    )


def practice(count: int, room: Room, length: float) -> list[Places]:
    """Return the arrangements of practice that the room holds, each once.

    Parameters
    ----------
    count : int
        Number of devices, at least 1.
    room : Room
    length : float
        Of the span [m].

    Returns
    -------
    list of tuples of float
        Positions in rising order [m]. Those that are not symmetric about mid-span, which only a single device has,
        come with their mirror image.
    """
    fitted = (room.fitted(length * share for share in shares) for shares in _shares(count, room.separation / length))
    return list(dict.fromkeys(places for places in fitted if places is not None))


def neighbours(places: Places, room: Room, step: float, length: float) -> list[Places]:
    """Return the arrangements that differ by a step [m]: of two devices of a mirror pair, of one, or of all.

    Symmetric changes come first. The mirror image of the places has the mirror images of these arrangements.
    """
    found = (_moved(places, moves, step) for moves in _moves(len(places)))
    inside = (tuple(round(place, DECIMALS) for place in sorted(one)) for one in found)
    return list(dict.fromkeys(one for one in inside if one != places and room.holds(one) and one[-1] <= length))


def _pushed(places: Sequence[float], lowest: float, highest: float, separation: float) -> list[float]:
    """Push places apart from the left, then back from the right end."""
    found: list[float] = []
    for place in places:
        found.append(max(place, found[-1] + separation if found else lowest))
    limit = highest
    for i in range(len(found) - 1, -1, -1):
        found[i] = min(found[i], limit)
        limit = found[i] - separation
    return found


def _shares(count: int, separation: float) -> Iterator[list[float]]:
    """Yield positions as shares of the span, for a separation that is a share of it too."""
    for at_quarters in range(count // 2, -1, -1):
        numbers = (at_quarters, count - 2 * at_quarters, at_quarters)
        yield [place for anchor, n in zip(ANCHORS, numbers, strict=True) for place in _about(anchor, n, separation)]
    yield [(i + 1) / (count + 1) for i in range(count)]
    yield [(i + 0.5) / count for i in range(count)]
    if count == 1:
        yield from ([ANCHORS[0]], [ANCHORS[2]])


def _about(anchor: float, count: int, separation: float) -> list[float]:
    return [anchor + (i - 0.5 * (count - 1)) * separation for i in range(count)]


def _moves(count: int) -> Iterator[dict[int, int]]:
    """Yield which devices move, and in which direction."""
    for sign in (1, -1):
        yield from ({i: sign, count - 1 - i: -sign} for i in range(count // 2))
    for sign in (1, -1):
        yield from ({i: sign} for i in range(count))
    if count > 1:
        yield from (dict.fromkeys(range(count), sign) for sign in (1, -1))


def _moved(places: Places, moves: dict[int, int], step: float) -> list[float]:
    return [place + step * moves.get(i, 0) for i, place in enumerate(places)]
