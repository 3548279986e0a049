"""Where along a span a motion is largest. Theory section 8.

The source observes motions at s = L/(2 k), the first antinode of k loops. A device, uneven ice or wind makes another
antinode larger, or moves the largest motion away from all of them.
"""

from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.models.discretization import shapes_at

MORE = 1e-3  # of the motion at the antinodes, by which it must be larger elsewhere to be observed there
ALIKE = 1.0 - 1e-6  # of the largest motion, from which on the first place counts


@dataclass(frozen=True, slots=True)
class WidestPlaces:
    """Where motions are largest.

    share: (motions,), arc length from the left support over that of the span; shapes: (motions, m, 3), V, W and Theta
    of each coordinate there.
    """

    share: FloatArray
    shapes: FloatArray


def widest_places(
    shapes: FloatArray, direction: IntArray, loops: IntArray, coordinate: IntArray, displacement: FloatArray
) -> WidestPlaces:
    """Return where motions are largest in the direction of the coordinate that moves most.

    That is one of the k antinodes s = (2 j - 1) L/(2 k), the first of equal ones, unless the motion is larger elsewhere
    by more than a thousandth; there it is the vertex of the parabola through the largest node and its neighbours.

    Parameters
    ----------
    shapes : (motions, m, 3, nodes)
        V, W and Theta of the coordinates of each motion, at evenly spaced nodes.
    direction, loops, coordinate : (motions,)
        The coordinate that moves most, with its direction (0, 1, 2 for V, W, Theta) and number of loops.
    displacement : (motions, samples, m)
        q over time. Where nothing moves, the place is that of the coordinate by itself.
    """
    every = np.arange(loops.size)
    own = shapes[every, :, direction]
    share, largest = _antinodes(own, loops, coordinate, displacement)
    elsewhere, larger = _vertices(_sizes(own, coordinate, displacement))
    share = np.where(larger > (1.0 + MORE) * largest, elsewhere, share)
    return WidestPlaces(share, shapes_at(shapes, share))


def _antinodes(
    own: FloatArray, loops: IntArray, coordinate: IntArray, displacement: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the share of the arc length at which the antinode of largest motion stands, and the motion there."""
    share, largest = np.empty(loops.size), np.empty(loops.size)
    for k in np.unique(loops).tolist():
        here = np.flatnonzero(loops == k)
        places = (2.0 * np.arange(k) + 1.0) / (2.0 * k)
        there = np.stack([shapes_at(own[here], np.full(here.size, place)) for place in places.tolist()], axis=-1)
        sizes = _sizes(there, coordinate[here], displacement[here])
        largest[here] = sizes.max(axis=-1)
        share[here] = places[_first_largest(sizes)]
    return share, largest


def _vertices(sizes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the share of the arc length of the vertex about the largest inner node, and the motion there."""
    node = 1 + _first_largest(sizes[:, 1:-1])
    before, at, after = (np.take_along_axis(sizes, (node + step)[:, None], axis=-1)[:, 0] for step in (-1, 0, 1))
    curvature = before - 2.0 * at + after
    curved = curvature < 0.0
    offset = np.where(curved, 0.5 * (before - after) / np.where(curved, curvature, -1.0), 0.0).clip(-0.5, 0.5)
    return (node + offset) / (sizes.shape[-1] - 1), at - 0.25 * (before - after) * offset


def _first_largest(sizes: FloatArray) -> IntArray:
    return np.asarray((sizes >= ALIKE * sizes.max(axis=-1, keepdims=True)).argmax(axis=-1))


def _sizes(own: FloatArray, coordinate: IntArray, displacement: FloatArray) -> FloatArray:
    """Return the peak-to-peak motion at places where coordinates have shapes (motions, m, places): (motions, places).

    A coordinate that has a direction for itself, or that nothing moves, gives the size of its shape.
    """
    sizes = np.abs(own[np.arange(coordinate.size), coordinate])
    together = np.flatnonzero((own.any(axis=-1).sum(axis=-1) > 1) & displacement.any(axis=(-2, -1)))
    if together.size:
        sizes[together] = np.ptp(displacement[together] @ own[together], axis=1)
    return np.asarray(sizes)
