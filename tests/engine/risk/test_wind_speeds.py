"""Shares of the time within wind speeds, against Weibull's distribution and draws from it."""

import math
from dataclasses import replace

import numpy as np
import pytest

from engine.risk.wind_speeds import share_of_time
from engine.spec import Climate, Icing, Ranged, WindSector

ICING = (Icing("glaze", hours=Ranged(40.0)),)
NORTH = WindSector(direction=0.0, share=1.0, shape=Ranged(2.0), scale=Ranged(6.0), width=0.0)
ACROSS = Climate(azimuth=math.radians(90.0), sectors=(NORTH,), icing=ICING)


def below(speed: float, shape: float, scale: float) -> float:
    return 1.0 - math.exp(-((speed / scale) ** shape))


def test_wind_across_the_line_has_weibulls_distribution() -> None:
    expected = below(9.0, 2.0, 6.0) - below(3.0, 2.0, 6.0)
    assert share_of_time(ACROSS, ((3.0, 9.0),)) == pytest.approx((expected,) * 3, rel=1e-14)


def test_of_oblique_wind_only_the_part_across_counts_from_either_side() -> None:
    oblique = replace(NORTH, direction=math.radians(60.0))
    expected = below(9.0, 2.0, 3.0) - below(3.0, 2.0, 3.0)
    for turned in (60.0, -60.0, 120.0, 240.0):
        climate = replace(ACROSS, sectors=(replace(oblique, direction=math.radians(turned)),))
        assert share_of_time(climate, ((3.0, 9.0),))[0] == pytest.approx(expected, rel=1e-12)
    along = replace(ACROSS, sectors=(replace(NORTH, direction=math.radians(90.0)),))
    assert share_of_time(along, ((3.0, math.inf),))[0] == pytest.approx(0.0, abs=1e-15)
    assert share_of_time(along, ((0.0, 3.0),))[0] == pytest.approx(1.0, rel=1e-12)


def test_sectors_add_by_their_share_and_intervals_add() -> None:
    two = (replace(NORTH, share=0.25), replace(NORTH, direction=math.pi, share=0.75, shape=Ranged(1.6)))
    climate = replace(ACROSS, sectors=two)
    parts = [share_of_time(climate, (part,))[0] for part in ((2.0, 4.0), (7.0, math.inf))]
    expected = 0.25 * (below(4.0, 2.0, 6.0) - below(2.0, 2.0, 6.0)) + 0.75 * (
        below(4.0, 1.6, 6.0) - below(2.0, 1.6, 6.0)
    )
    assert parts[0] == pytest.approx(expected, rel=1e-13)
    assert share_of_time(climate, ((2.0, 4.0), (7.0, math.inf)))[0] == pytest.approx(sum(parts), rel=1e-13)


@pytest.mark.parametrize("width", [30.0, 90.0, 360.0])
def test_a_wide_sector_agrees_with_drawn_winds(width: float) -> None:
    sector = replace(NORTH, direction=math.radians(70.0), width=math.radians(width))
    draw = np.random.default_rng(7)
    n = 400_000
    angle = math.radians(70.0) + math.radians(width) * (draw.random(n) - 0.5)
    across = 6.0 * draw.weibull(2.0, n) * np.abs(np.cos(angle))
    drawn = float(np.mean((across > 3.0) & (across < 9.0)))
    found = share_of_time(replace(ACROSS, sectors=(sector,)), ((3.0, 9.0),))[0]
    assert found == pytest.approx(drawn, abs=4.0 * math.sqrt(0.25 / n))


def test_the_range_holds_every_wind_within_the_ranges_of_shape_and_scale() -> None:
    sector = replace(NORTH, shape=Ranged(2.0, 1.6, 2.4), scale=Ranged(6.0, 4.0, 12.0))
    value, lowest, highest = share_of_time(replace(ACROSS, sectors=(sector,)), ((5.0, 7.0),))
    draw = np.random.default_rng(1)
    shape, scale = draw.uniform(1.6, 2.4, 20_000), draw.uniform(4.0, 12.0, 20_000)
    shares = np.exp(-((5.0 / scale) ** shape)) - np.exp(-((7.0 / scale) ** shape))
    assert value == pytest.approx(below(7.0, 2.0, 6.0) - below(5.0, 2.0, 6.0), rel=1e-13)
    assert 0.98 * shares.min() < lowest <= shares.min() < value < highest < 1.005 * shares.max()
    assert highest >= 0.999 * shares.max()


def test_many_values_are_those_of_each_by_itself() -> None:
    """Ends that intervals share are computed once, for all shapes and scales together."""
    wide = replace(NORTH, direction=0.4, shape=Ranged(2.0, 1.5, 3.0), scale=Ranged(6.0, 4.0, 9.0), width=math.pi / 2.0)
    intervals = ((0.0, 2.0), (5.0, 7.0), (9.0, math.inf))
    value, lowest, highest = share_of_time(replace(ACROSS, sectors=(wide,)), intervals)
    alone = [
        share_of_time(replace(ACROSS, sectors=(replace(wide, shape=Ranged(k), scale=Ranged(c)),)), intervals)
        for k in (1.5, 2.0, 3.0)
        for c in (4.0, 6.0, 9.0)
    ]
    assert all(one[0] == one[1] == one[2] for one in alone)
    assert value == alone[4][0]
    assert lowest * (1.0 - 1e-12) <= min(one[0] for one in alone)
    assert highest * (1.0 + 1e-12) >= max(one[0] for one in alone)
    apart = sum(share_of_time(replace(ACROSS, sectors=(wide,)), (part,))[0] for part in intervals)
    assert value == pytest.approx(apart, rel=1e-13)
