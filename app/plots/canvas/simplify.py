"""Leave out the points of a path that no one would miss."""

from typing import TypeAlias

import numpy as np

Points: TypeAlias = np.ndarray[tuple[int, int], np.dtype[np.float64]]
Kept: TypeAlias = np.ndarray[tuple[int], np.dtype[np.bool_]]


def kept_points(points: Points, tolerance: float) -> Kept:
    """Tell which points to keep so that the path stays within a tolerance of the given one.

    The algorithm of Ramer (1972), Douglas and Peucker (1973): a stretch is replaced by its chord if no point of it is
    farther than the tolerance from the chord, and is divided at its farthest point otherwise.

    Parameters
    ----------
    points : (points, 2)
        The path, finite, in the unit of the tolerance.
    tolerance : float

    Returns
    -------
    (points,) of bool
        The first and the last point are always kept.
    """
    kept = np.zeros(len(points), dtype=np.bool_)
    kept[[0, -1]] = True
    stretches = [(0, len(points) - 1)]
    while stretches:
        first, last = stretches.pop()
        if last - first < 2:
            continue
        distances = _distances(points[first + 1 : last], points[first], points[last])
        farthest = int(distances.argmax())
        if distances[farthest] > tolerance:
            middle = first + 1 + farthest
            kept[middle] = True
            stretches += [(first, middle), (middle, last)]
    return kept


def _distances(points: Points, start: Points, end: Points) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return the distances of points from the segment between two points."""
    chord, away = end - start, points - start
    length = float(chord @ chord)
    along = np.clip(away @ chord / length, 0.0, 1.0) if length > 0.0 else np.zeros(len(points))
    return np.asarray(np.hypot(*(away - along[:, None] * chord).T))
