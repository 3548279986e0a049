"""Shares of the time for which the wind across a line lies within given wind speeds, from Weibull winds by sector."""

from collections.abc import Sequence

import numpy as np

from engine.arrays import FloatArray
from engine.risk.winds import Interval
from engine.spec import Climate, WindSector

_NODES = 64  # of the average over a half or a quarter of a sector, where the integrand is smooth
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
    across, weight = _directions(climate, sector)
    shape, scale = (np.linspace(*ranged.ends, _ENDS) for ranged in (sector.shape, sector.scale))
    shapes = np.append(np.repeat(shape, _ENDS), sector.shape.value)
    scales = np.append(np.tile(scale, _ENDS), sector.scale.value)
    found = _within(across, shapes, scales, intervals) @ weight
    return float(found[-1]), float(found.min()), float(found.max())


def _directions(climate: Climate, sector: WindSector) -> tuple[FloatArray, FloatArray]:
    """Return shares of the wind that blow across the line, and weights that sum to one, over a sector: (nodes,)."""
    angle = sector.direction - climate.azimuth
    half = 0.5 * climate.width(sector)
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


def _within(across: FloatArray, shapes: FloatArray, scales: FloatArray, intervals: Sequence[Interval]) -> FloatArray:
    """Return the share of the time within the intervals for each shape, scale [m/s] and direction: (pairs, nodes)."""
    crossing = across > _PARALLEL
    scaled = scales[:, None] * np.where(crossing, across, 1.0)
    total = np.zeros_like(scaled)
    for first, last in intervals:
        low, high = (np.exp(-((end / scaled) ** shapes[:, None])) for end in (first, last))
        still = 1.0 if first <= 0.0 < last else 0.0  # wind along the line leaves it in still air
        total += np.where(crossing, low - high, still)
    return total
