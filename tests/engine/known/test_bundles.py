"""Bundles by spacing and arrangement."""

import math
from itertools import pairwise

import pytest

from engine.known.bundles import Arrangement, arranged
from engine.outcome import InvalidSpec
from engine.spec import CrossSection

SPACING = 0.457


@pytest.mark.parametrize("subconductors", [2, 3, 4, 6, 8])
@pytest.mark.parametrize("section", [None, CrossSection.FREE])
def test_neighbours_are_a_spacing_apart_around_the_reference_curve(
    subconductors: int, section: CrossSection | None
) -> None:
    bundle = arranged(subconductors, SPACING, None, section)
    points = [complex(*position) for position in bundle.positions]
    assert len(points) == subconductors
    distances = [abs(b - a) for a, b in pairwise([*points, points[0]])]
    assert distances == pytest.approx([SPACING] * subconductors)
    assert abs(sum(points)) < 1e-12
    assert bundle.section is section


@pytest.mark.parametrize(
    ("arrangement", "heights"),
    [
        (Arrangement.HORIZONTAL, [0.0, 0.0]),
        (Arrangement.VERTICAL, [-0.5, 0.5]),
        (Arrangement.TRIANGLE, [-math.sqrt(3.0) / 6.0, -math.sqrt(3.0) / 6.0, math.sqrt(3.0) / 3.0]),
        (Arrangement.INVERTED_TRIANGLE, [-math.sqrt(3.0) / 3.0, math.sqrt(3.0) / 6.0, math.sqrt(3.0) / 6.0]),
        (Arrangement.SQUARE, [-0.5, -0.5, 0.5, 0.5]),
        (Arrangement.DIAMOND, [-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]),
        (Arrangement.POLYGON, [-math.sqrt(0.75), -math.sqrt(0.75), 0.0, 0.0, math.sqrt(0.75), math.sqrt(0.75)]),
    ],
)
def test_an_arrangement_has_its_heights(arrangement: Arrangement, heights: list[float]) -> None:
    found = sorted(y for y, _ in arranged(len(heights), SPACING, arrangement).positions)
    assert found == pytest.approx([height * SPACING for height in heights], abs=1e-12)


def test_one_sub_conductor_is_at_the_reference_curve() -> None:
    assert arranged(1, None, None).positions == ((0.0, 0.0),)


@pytest.mark.parametrize(
    ("arguments", "fault"),
    [
        ((0, None, None), r"bundle\.subconductors must be at least 1, got 0"),
        ((2, None, None), r"bundle\.spacing must be given for more than one sub-conductor"),
        ((2, -0.4, None), r"bundle\.spacing must be a finite number greater than zero, got -0\.4"),
        ((1, 0.4, None), r"bundle\.spacing must be absent for one sub-conductor"),
        ((1, None, Arrangement.SQUARE), r"bundle\.arrangement must be absent for one sub-conductor"),
        ((3, 0.4, Arrangement.SQUARE), r"arrangement must fit .*: square means 4, there are 3, got 'square'"),
    ],
)
def test_a_broken_rule_is_named(arguments: tuple[int, float | None, Arrangement | None], fault: str) -> None:
    with pytest.raises(InvalidSpec, match=fault):
        arranged(*arguments)
