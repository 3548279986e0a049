"""Shares of the time for which the wind across a line lies within given wind speeds, from Weibull winds by sector."""

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from engine.arrays import FloatArray
from engine.risk.winds import Interval
from engine.spec import Climate, Ranged, WindSector

_NODES = 32  # of the average over a quarter of a sector or less, where the integrand is smooth
_ENDS = 33  # values of shape and of scale from the lowest to the highest that are tried
_PARALLEL = 1e-12  # cosine below which no wind blows across


def share_of_time(climate: Climate, intervals: Sequence[Interval]) -> tuple[float, float, float]:
    """Return for which share of the time the wind across the line lies within any of the intervals.

    Across the line blows U |cos| of the angle between the wind and the line's normal, from either side. Over the
    width of a sector the exact share of each direction is averaged by Gauss's rule.

    Parameters
    ----------
    climate : Climate
    intervals : sequence of pairs
        Wind speeds across the line [m/s], disjoint.

    Returns
    -------
    value, lowest, highest : float
        With the values of the climate, and with those shapes and scales within their ranges, in each sector by itself,
        that give the smallest and the largest share [1].
    """
    rows = [_of_sector(climate, sector, intervals) for sector in climate.sectors]
    shares = np.array([sector.share for sector in climate.sectors])
    value, lowest, highest = (shares @ np.array(rows)).tolist()
    return value, lowest, highest


def _of_sector(climate: Climate, sector: WindSector, intervals: Sequence[Interval]) -> tuple[float, float, float]:
    angle, half = sector.direction - climate.azimuth, 0.5 * climate.width(sector)
    value = float(_within(angle, half, (sector.shape.value,), (sector.scale.value,), intervals)[0, 0])
    shapes, scales = _tried(sector.shape), _tried(sector.scale)
    if len(shapes) == len(scales) == 1:
        return value, value, value
    found = _within(angle, half, shapes, scales, intervals)
    return value, min(value, float(found.min())), max(value, float(found.max()))


def _tried(ranged: Ranged) -> tuple[float, ...]:
    """Return the values of a range that are tried: the one value where it is none."""
    lowest, highest = ranged.ends
    return (ranged.value,) if lowest == highest else tuple(np.linspace(lowest, highest, _ENDS).tolist())


@lru_cache(maxsize=64)
def _directions(angle: float, half: float) -> tuple[FloatArray, FloatArray]:
    """Return shares of the wind that blow across the line, and weights that sum to one, over a sector: (nodes,).

    Parameters
    ----------
    angle : float
        From the line to the middle of the sector [rad].
    half : float
        Half of its width [rad].
    """
    if half == 0.0:
        return np.abs(np.sin([angle])), np.ones(1)
    # The wind along the line, where its share across has a corner, divides a sector.
    corners = np.pi * np.arange(np.ceil((angle - half) / np.pi), np.floor((angle + half) / np.pi) + 1.0)
    ends = np.unique(np.concatenate([np.linspace(angle - half, angle + half, 5), corners]))
    node, weight = np.polynomial.legendre.leggauss(_NODES)
    length = np.diff(ends)[:, None]
    angles = ends[:-1, None] + 0.5 * length * (1.0 + node)
    weights = 0.5 * length * weight / (2.0 * half)
    return np.abs(np.sin(angles)).ravel(), weights.ravel()


_Values = tuple[float, ...]


def _within(angle: float, half: float, shapes: _Values, scales: _Values, intervals: Sequence[Interval]) -> FloatArray:
    """Return the share of the time within the intervals for each shape and scale [m/s]: (shapes, scales)."""
    total: FloatArray = np.zeros((len(shapes), len(scales)))
    for first, last in intervals:
        low, high = (_above(end, angle, half, shapes, scales) for end in (first, last))
        total += low - high
    return total


@lru_cache(maxsize=1024)
def _above(speed: float, angle: float, half: float, shapes: _Values, scales: _Values) -> FloatArray:
    """Return the share of the time with a wind across the line above a speed [m/s]: (shapes, scales).

    Intervals share their ends, and so do the motions and the samples of a line.
    """
    across, weight = _directions(angle, half)
    if speed <= 0.0:  # wind along the line leaves it in still air
        return np.ones((len(shapes), len(scales)))
    if math.isinf(speed):
        return np.zeros((len(shapes), len(scales)))
    crossing = across > _PARALLEL
    scaled = speed / (np.array(scales)[:, None] * across[crossing])
    exponent = scaled ** np.array(shapes)[:, None, None] if len(shapes) == 1 else _powers(scaled, shapes)
    return np.asarray(np.exp(-exponent) @ weight[crossing])


def _powers(base: FloatArray, shapes: _Values) -> FloatArray:
    """Return powers of a base (scales, nodes): (shapes, scales, nodes); exp is several times as fast as a power."""
    return np.asarray(np.exp(np.array(shapes)[:, None, None] * np.log(base)))
