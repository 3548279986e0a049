"""Envelopes and ellipses against published examples, circles, and brute force over points."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull
from scipy.spatial.distance import cdist

from engine.arrays import FloatArray
from engine.clearance import (
    DIRECTIONS,
    FOOT,
    Ellipse,
    EllipseMethod,
    clearance,
    directions,
    ellipse_support,
    extents,
    galloping_ellipse,
    path_support,
    subconductor_paths,
)
from engine.outcome import InvalidSpec

D = 0.0281432


@pytest.mark.parametrize(
    ("method", "sag_ft", "others", "expected_ft"),
    [
        (EllipseMethod.CIGRE, 5.72, {"diameter": D}, (16.9, 6.8, 5.1)),
        (EllipseMethod.CIGRE, 20.65, {"diameter": D, "subconductors": 2}, (20.0, 8.0, 6.0)),
        (EllipseMethod.DAVISON, 7.9, {}, (10.9, 4.35, 2.0)),
        (EllipseMethod.TOYE, 24.99, {"span_length": 1000.0 * FOOT}, (9.8, 5.9, 2.0)),
    ],
)
def test_published_examples_come_out(
    method: EllipseMethod, sag_ft: float, others: dict[str, float], expected_ft: tuple[float, ...]
) -> None:
    found = galloping_ellipse(method, sag_ft * FOOT, **others)  # type: ignore[arg-type]
    assert found is not None
    got = np.array([found.major_axis, found.minor_axis, found.b_distance]) / FOOT
    np.testing.assert_allclose(got, expected_ft, atol=0.051)


def test_aeso_has_two_slender_ellipses_of_cigres_length() -> None:
    cigre = galloping_ellipse(EllipseMethod.CIGRE, 2.0, diameter=D)
    aeso = galloping_ellipse(EllipseMethod.AESO, 2.0, diameter=D)
    assert cigre is not None
    assert aeso is not None
    assert aeso.major_axis == cigre.major_axis
    assert (aeso.minor_axis, aeso.b_distance) == pytest.approx((0.2 * aeso.major_axis, 0.25 * aeso.major_axis))
    assert aeso.tilts == pytest.approx((math.radians(5.0), math.radians(-5.0)))
    axis = np.array([math.cos(aeso.tilts[0]), -math.sin(aeso.tilts[0])])
    tip = aeso.major_axis - aeso.b_distance
    along = int((directions() @ axis).argmax())
    assert ellipse_support(aeso)[along] == pytest.approx(tip, rel=1e-4)


def test_there_is_no_ellipse_where_its_axis_is_not_positive() -> None:
    assert galloping_ellipse(EllipseMethod.CIGRE, 50.0 * D / 8.0, diameter=D) is None
    assert galloping_ellipse(EllipseMethod.AESO, 1.0, diameter=D, subconductors=2) is None


@pytest.mark.parametrize(
    ("method", "others", "field"),
    [
        (EllipseMethod.TOYE, {"sag": 1.0}, "span_length"),
        (EllipseMethod.CIGRE, {"sag": 1.0}, "diameter"),
        (EllipseMethod.AESO, {"sag": 1.0, "diameter": 0.0}, "diameter"),
        (EllipseMethod.DAVISON, {"sag": -1.0}, "sag"),
        (EllipseMethod.DAVISON, {"sag": math.nan}, "sag"),
        (EllipseMethod.CIGRE, {"sag": 1.0, "diameter": D, "subconductors": 0}, "subconductors"),
    ],
)
def test_what_is_missing_is_named(method: EllipseMethod, others: dict[str, float], field: str) -> None:
    with pytest.raises(InvalidSpec) as caught:
        galloping_ellipse(method, **others)  # type: ignore[arg-type]
    assert [fault.field for fault in caught.value.faults] == [field]


def test_toyes_ellipse_uses_up_the_slack_of_a_parabola() -> None:
    """Half the span as a straight cord, from the support to mid-span, rises by sqrt(3 a slack / 8) above its chord."""
    length, sag = 300.0, 4.0
    found = galloping_ellipse(EllipseMethod.TOYE, sag, span_length=length)
    assert found is not None
    x = np.linspace(0.0, length, 200_001)
    arc = np.hypot(1.0, 8.0 * sag / length**2 * (x - length / 2.0)).mean() * length
    chord = math.hypot(length / 2.0, sag)
    assert found.major_axis - FOOT == pytest.approx(math.sqrt(0.375 * chord * (arc - 2.0 * chord)), rel=2e-3)


def circle(radius: float) -> FloatArray:
    return ellipse_support(Ellipse(2.0 * radius, 2.0 * radius, radius))


@pytest.mark.parametrize(("y", "z"), [(4.0, 0.0), (0.0, -3.0), (2.5, 2.5), (0.7, -0.4)])
def test_circles_are_apart_by_their_distance_less_their_radii(y: float, z: float) -> None:
    """Negative for circles that overlap, by what one must move until they part."""
    found = clearance(circle(1.0), circle(0.5), np.array([y, z]))
    assert found == pytest.approx(math.hypot(y, z) - 1.5, abs=2e-5 * math.hypot(y, z))


def hull_distance(a: FloatArray, b: FloatArray) -> float:
    """Return the distance of two hulls by brute force over points laid densely along their edges."""

    def edges(points: FloatArray) -> FloatArray:
        corners = points[ConvexHull(points).vertices]
        share = np.linspace(0.0, 1.0, 400)[:, None, None]
        return np.asarray(((1.0 - share) * corners + share * np.roll(corners, -1, axis=0)).reshape(-1, 2))

    return float(cdist(edges(a), edges(b)).min())


@given(st.integers(0, 10_000))
def test_hulls_of_points_are_apart_as_brute_force_finds(seed: int) -> None:
    rng = np.random.default_rng(seed)
    a, b = rng.normal(size=(12, 2)), rng.normal(size=(9, 2)) * [0.5, 2.0]
    offset = 12.0 * np.array([math.cos(seed), math.sin(seed)])
    found = clearance(path_support(a), path_support(b), offset)
    # Between two directions the support functions turn by no more than the reach of the points.
    reach = np.hypot(*a.T).max() + np.hypot(*b.T).max()
    assert found == pytest.approx(hull_distance(a, b + offset), abs=math.pi / DIRECTIONS * reach + 1e-4)


def test_overlapping_regions_part_when_moved_by_the_overlap() -> None:
    rng = np.random.default_rng(5)
    a, b = path_support(rng.normal(size=(30, 2))), path_support(rng.normal(size=(30, 2)))
    overlap = clearance(a, b, np.zeros(2))
    assert overlap < 0.0
    moved = clearance(a, b, -overlap * directions())
    assert moved.max() == pytest.approx(0.0, abs=1e-3)
    assert (clearance(a, b, -0.9 * overlap * directions()) < 0.0).all()


def test_stacks_of_regions_take_leading_axes() -> None:
    points = np.random.default_rng(1).normal(size=(3, 4, 7, 2))
    support = path_support(points)
    offset = np.array([9.0, 1.0])
    found = clearance(support, circle(1.0), offset)
    assert support.shape == (3, 4, DIRECTIONS)
    assert found.shape == (3, 4)
    assert found[1, 2] == pytest.approx(clearance(path_support(points[1, 2]), circle(1.0), offset))


def test_paths_of_a_twin_follow_its_rotation() -> None:
    """Eq. (3): a horizontal twin that only rotates moves up on one side and down on the other."""
    radius, angle = 0.2, 0.1
    series = np.zeros((3, 3))
    series[2, 1] = angle
    positions = np.array([[0.0, radius], [0.0, -radius]])
    paths = subconductor_paths(series, positions)
    np.testing.assert_allclose(paths[0, :, 0], -paths[1, :, 0], atol=1e-15)
    np.testing.assert_allclose(paths[..., 1], [[radius] * 360, [-radius] * 360], atol=1e-15)
    np.testing.assert_allclose(extents(paths), [2.0 * radius * angle, 2.0 * radius], rtol=1e-12)


def test_extents_are_twice_the_amplitudes_of_a_single_conductor() -> None:
    series = np.array([[0.5, 0.3, 0.4], [0.1, 0.0, -0.2], [0.0, 0.7, 0.0]])
    paths = subconductor_paths(series, np.zeros((1, 2)))
    np.testing.assert_allclose(extents(paths), [2.0 * 0.5, 2.0 * 0.2], rtol=1e-4)
    height = path_support(paths[0])[0] + path_support(paths[0])[DIRECTIONS // 2]
    assert height == pytest.approx(1.0, rel=1e-4)


def test_two_phases_that_gallop_alike_above_each_other_come_as_near_as_their_height_leaves() -> None:
    series = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 0.2], [0.0, 0.0, 0.0]])
    support = path_support(subconductor_paths(series, np.zeros((1, 2)))[0])
    assert clearance(support, support, np.array([3.0, 0.0])) == pytest.approx(1.0, abs=1e-3)
    assert clearance(support, support, np.array([0.0, -3.0])) == pytest.approx(2.6, abs=1e-3)
