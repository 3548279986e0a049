"""Closed outlines of straight edges and circular arcs, and their exact section integrals.

A point of the section is the complex number w = y + i z, y up and z downwind, so an angle is counted from straight up
towards downwind: clockwise, as for sub-conductors (docs/conventions.md). For a function f that is homogeneous of degree
k, Green's theorem gives the integral of f over the enclosed area as 1/(k + 2) times that of f (y dz - z dy) along the
outline. Area, first moment and polar moment about the origin are f = 1, w and |w|^2.
"""

import cmath
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from engine.arrays import ComplexArray


@dataclass(frozen=True, slots=True)
class Moments:
    """Integrals over an area: area [m2], first moment of w = y + i z [m3], polar moment about the origin [m4]."""

    area: float = 0.0
    first: complex = 0j
    polar: float = 0.0

    def __add__(self, other: "Moments") -> "Moments":
        """Return the integrals over both areas."""
        return Moments(self.area + other.area, self.first + other.first, self.polar + other.polar)

    def scaled(self, factor: float) -> "Moments":
        """Return the integrals with a uniform weight."""
        return Moments(factor * self.area, factor * self.first, factor * self.polar)


@dataclass(frozen=True, slots=True)
class Edge:
    """A straight edge from start to stop [m]."""

    start: complex
    stop: complex

    @property
    def moments(self) -> Moments:
        """The share of the outline's integrals; y dz - z dy is constant along a straight edge."""
        cross = (self.start.conjugate() * self.stop).imag
        squares = abs(self.start) ** 2 + (self.start.conjugate() * self.stop).real + abs(self.stop) ** 2
        return Moments(cross / 2.0, cross * (self.start + self.stop) / 6.0, cross * squares / 12.0)

    def reach(self, direction: complex) -> float:
        """Return how far the edge extends in a direction, a unit vector [m]."""
        return max((point * direction.conjugate()).real for point in (self.start, self.stop))


@dataclass(frozen=True, slots=True)
class Arc:
    """An arc about a centre [m] with a radius [m], from an angle over a sweep [rad]."""

    centre: complex
    radius: float
    start: float
    sweep: float

    @property
    def moments(self) -> Moments:
        """The share of the outline's integrals: y dz - z dy = (R^2 + R c.e) dphi at the point c + R e(phi)."""
        c, radius, sweep = self.centre, self.radius, self.sweep
        # Integrals over phi of e, and of (c.e) e and (c.e)^2, which follow from that of e^2.
        once = _turned(self.start, sweep, 1)
        twice = _turned(self.start, sweep, 2)
        along = (c.conjugate() * once).real  # of c.e
        along_e = 0.5 * (c * sweep + c.conjugate() * twice)  # of (c.e) e
        along_squared = (c.conjugate() * along_e).real
        area = 0.5 * (radius**2 * sweep + radius * along)
        first = radius * (radius * c * sweep + c * along + radius**2 * once + radius * along_e) / 3.0
        reach = abs(c) ** 2 + radius**2
        polar = radius * (radius * reach * sweep + (reach + 2.0 * radius**2) * along + 2.0 * radius * along_squared)
        return Moments(area, first, 0.25 * polar)

    def reach(self, direction: complex) -> float:
        """Return how far the arc extends in a direction, a unit vector [m]."""
        ends = (cmath.rect(1.0, self.start), cmath.rect(1.0, self.start + self.sweep))
        beyond = math.remainder(cmath.phase(direction) - (self.start + 0.5 * self.sweep), 2.0 * math.pi)
        farthest = 1.0 if abs(beyond) <= 0.5 * abs(self.sweep) else max((e * direction.conjugate()).real for e in ends)
        return (self.centre * direction.conjugate()).real + self.radius * farthest


Outline = tuple[Edge | Arc, ...]


def circle(centre: complex, radius: float) -> Outline:
    """Return the outline of a disc."""
    return (Arc(centre, radius, 0.0, 2.0 * math.pi),)


def polygon(points: Sequence[complex]) -> Outline:
    """Return the outline that joins points and closes itself, in the sense in which w turns from y to z."""
    edges = tuple(Edge(a, b) for a, b in zip(points, (*points[1:], points[0]), strict=True))
    if moments(edges).area >= 0.0:
        return edges
    return tuple(Edge(edge.stop, edge.start) for edge in reversed(edges))


def moments(outline: Iterable[Edge | Arc]) -> Moments:
    """Return the integrals over the area that an outline encloses, positive if it turns from y to z."""
    return sum((part.moments for part in outline), Moments())


def extent(outline: Outline, direction: complex) -> float:
    """Return the width of an outline along a direction, a unit vector [m]."""
    forward = max(part.reach(direction) for part in outline)
    backward = max(part.reach(-direction) for part in outline)
    return forward + backward


def within_disc(edges: Iterable[Edge], radius: float) -> Moments:
    """Return the integrals over the part of a polygon's area that lies in a disc about the origin.

    Along each edge the part inside the disc counts as it stands, and the parts outside as the arcs that they cover.
    """
    total = Moments()
    for edge in edges:
        marks = [0.0, *_entry_and_exit(edge, radius), 1.0]
        points = [edge.start + mark * (edge.stop - edge.start) for mark in marks]
        for a, b in pairwise(points):
            inside = abs(0.5 * (a + b)) < radius
            turn = cmath.phase(b * a.conjugate()) if a and b else 0.0
            part = Edge(a, b) if inside else Arc(0j, radius, cmath.phase(a), turn)
            total = total + part.moments
    return total


def crossing_edges(points: ComplexArray) -> tuple[int, int] | None:
    """Return the numbers of two edges of a closed polygon (n,) that cross or touch, None if there are none.

    Edge i goes from point i to the next one; neighbours share a point, and cross only if one folds back on the other.
    """
    start, stop = points, np.roll(points, -1)
    along = stop - start
    count = points.size
    after = np.roll(along, -1)
    folds = (np.abs(_cross(along, after)) <= 1e-12 * np.abs(along * after)) & ((along.conj() * after).real < 0.0)
    if folds.any():
        return int(np.argmax(folds)), (int(np.argmax(folds)) + 1) % count
    # Sides of the ends of edge j as seen from edge i: crossing edges have their ends on both sides of each other.
    first = _cross(along[:, None], start[None, :] - start[:, None])
    second = _cross(along[:, None], stop[None, :] - start[:, None])
    parts = first * second <= 0.0
    i, j = np.indices((count, count))
    apart = (i < j) & (j - i > 1) & ~((i == 0) & (j == count - 1))
    found = np.argwhere(parts & parts.T & _boxes_meet(start, stop) & apart)
    return (int(found[0, 0]), int(found[0, 1])) if found.size else None


def _boxes_meet(start: ComplexArray, stop: ComplexArray) -> np.ndarray[tuple[int, int], np.dtype[np.bool_]]:
    """Return whether the bounding boxes of edges i and j meet: (n, n)."""
    meet = np.ones((start.size, start.size), dtype=np.bool_)
    for a, b in ((start.real, stop.real), (start.imag, stop.imag)):
        low, high = np.minimum(a, b), np.maximum(a, b)
        meet &= (low[:, None] <= high[None, :]) & (low[None, :] <= high[:, None])
    return meet


def _cross(a: ComplexArray, b: ComplexArray) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    return np.asarray((a.conj() * b).imag)


def _turned(start: float, sweep: float, order: int) -> complex:
    """Return the integral of exp(i order phi) from start over sweep."""
    middle = cmath.rect(1.0, order * (start + 0.5 * sweep))
    return middle * (2.0 / order) * math.sin(0.5 * order * sweep)


def _entry_and_exit(edge: Edge, radius: float) -> list[float]:
    """Return where along an edge (0 to 1) it crosses the circle about the origin, in rising order."""
    along = edge.stop - edge.start
    square, half = abs(along) ** 2, (edge.start.conjugate() * along).real
    root = half**2 - square * (abs(edge.start) ** 2 - radius**2)
    if square == 0.0 or root <= 0.0:
        return []
    ends = ((-half - math.sqrt(root)) / square, (-half + math.sqrt(root)) / square)
    return [end for end in ends if 0.0 < end < 1.0]
