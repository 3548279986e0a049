"""Section integrals against closed forms, sums over fine polygons and random points."""

import cmath
import math
from itertools import pairwise

import numpy as np
import pytest

from engine.known.outlines import (
    Arc,
    Edge,
    circle,
    crossing_edges,
    extent,
    moments,
    polygon,
    within_disc,
)

SQUARE = [1 + 1j, 3 + 1j, 3 + 3j, 1 + 3j]


def test_a_disc_off_the_origin_has_the_moments_of_its_centre() -> None:
    centre, radius = 0.3 - 0.2j, 1.1
    found = moments(circle(centre, radius))
    area = math.pi * radius**2
    assert found.area == pytest.approx(area, rel=1e-14)
    assert found.first == pytest.approx(area * centre, rel=1e-14)
    assert found.polar == pytest.approx(area * (0.5 * radius**2 + abs(centre) ** 2), rel=1e-14)


def test_a_half_disc_has_its_centroid_at_four_thirds_of_the_radius_over_pi() -> None:
    radius, turn = 0.7, cmath.rect(1.0, 0.4)
    half = (Arc(0j, radius, 0.4 - 0.5 * math.pi, math.pi), Edge(1j * radius * turn, -1j * radius * turn))
    found = moments(half)
    assert found.area == pytest.approx(0.5 * math.pi * radius**2)
    assert found.first / found.area == pytest.approx(4.0 * radius / (3.0 * math.pi) * turn)
    assert found.polar == pytest.approx(0.25 * math.pi * radius**4)


def test_a_square_off_the_origin_has_the_moments_of_its_centre() -> None:
    found = moments(polygon(SQUARE))
    assert found.area == pytest.approx(4.0)
    assert found.first == pytest.approx(4.0 * (2 + 2j))
    assert found.polar == pytest.approx(4.0 * (8.0 + 4.0 / 6.0))


def test_the_sense_of_the_points_does_not_matter() -> None:
    forward, backward = moments(polygon(SQUARE)), moments(polygon(SQUARE[::-1]))
    assert backward.area == pytest.approx(forward.area)
    assert backward.first == pytest.approx(forward.first)
    assert backward.polar == pytest.approx(forward.polar)


def test_an_arc_is_the_limit_of_its_chords() -> None:
    arc = Arc(0.5 + 0.2j, 0.8, 2.0, -1.3)
    points = [arc.centre + cmath.rect(arc.radius, arc.start + arc.sweep * i / 4000) for i in range(4001)]
    chords = moments(Edge(a, b) for a, b in pairwise(points))
    assert arc.moments.area == pytest.approx(chords.area, rel=1e-6)
    assert arc.moments.first == pytest.approx(chords.first, rel=1e-6)
    assert arc.moments.polar == pytest.approx(chords.polar, rel=1e-6)


@pytest.mark.parametrize("radius", [0.5, 1.2, 1.8, 5.0])
def test_the_part_within_a_disc_is_that_of_random_points(radius: float) -> None:
    outline = polygon([-1 - 1.5j, 1.5 - 0.5j, 1 + 1j, 0.2 + 0.9j, -1.2 + 1.1j])
    edges = tuple(part for part in outline if isinstance(part, Edge))
    found = within_disc(edges, radius)
    rng = np.random.default_rng(5)
    points = rng.uniform(-1.6, 1.6, 400_000) + 1j * rng.uniform(-1.6, 1.6, 400_000)
    inside = np.abs(points) < radius
    inside &= _even_odd(points, edges)
    area = 3.2**2
    assert found.area == pytest.approx(area * inside.mean(), abs=0.02)
    assert found.first == pytest.approx(area * np.where(inside, points, 0.0).mean(), abs=0.02)
    assert found.polar == pytest.approx(area * np.where(inside, np.abs(points) ** 2, 0.0).mean(), abs=0.02)


def _even_odd(points: np.ndarray, edges: tuple[Edge, ...]) -> np.ndarray:
    odd = np.zeros(points.shape, dtype=bool)
    for edge in edges:
        a, b = edge.start, edge.stop
        between = (a.imag > points.imag) != (b.imag > points.imag)
        with np.errstate(divide="ignore", invalid="ignore"):
            here = a.real + (points.imag - a.imag) / (b.imag - a.imag) * (b.real - a.real)
        odd ^= between & (points.real < here)
    return odd


def test_a_disc_within_a_polygon_and_a_polygon_within_a_disc_are_whole() -> None:
    edges = tuple(part for part in polygon([-2 - 2j, 2 - 2j, 2 + 2j, -2 + 2j]) if isinstance(part, Edge))
    disc = within_disc(edges, 1.0)
    assert (disc.area, disc.polar) == pytest.approx((math.pi, 0.5 * math.pi))
    assert disc.first == pytest.approx(0.0, abs=1e-14)
    assert within_disc(edges, 9.0).area == pytest.approx(16.0)


def test_the_extent_of_an_arc_ends_at_its_ends_unless_it_faces_the_direction() -> None:
    quarter = Arc(0j, 2.0, 0.0, 0.5 * math.pi)
    assert quarter.reach(cmath.rect(1.0, 0.25 * math.pi)) == pytest.approx(2.0)
    assert quarter.reach(-1.0 + 0j) == pytest.approx(0.0, abs=1e-15)
    assert extent((quarter, Edge(2j, 0j), Edge(0j, 2 + 0j)), 1.0 + 0j) == pytest.approx(2.0)


def test_crossing_edges_are_found_by_number() -> None:
    bow_tie = np.array([0j, 2 + 2j, 2 + 0j, 0 + 2j])
    assert crossing_edges(bow_tie) == (0, 2)
    assert crossing_edges(np.array(SQUARE)) is None
    assert crossing_edges(np.array([0j, 2 + 0j, 2 + 2j, 1 + 0j, 0 + 2j])) is not None  # touches the first edge
    assert crossing_edges(np.array([0j, 3 + 0j, 1 + 0j, 1 + 2j])) == (0, 1)  # folds back
