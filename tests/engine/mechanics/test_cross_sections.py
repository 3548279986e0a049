"""Pieces of ice, spoilers and wind: quadrature is exact on both sides of every boundary."""

import math
from dataclasses import astuple, replace
from typing import Any

import numpy as np
import pytest

from engine.mechanics.cross_sections import bundle_sums, padded_positions, turned_sums
from engine.mechanics.finite_elements import FIELDS, THETA, V, W
from engine.result import Result
from engine.spec import Aerodynamics, AirflowSpoiler, Analysis, Ice, IceSegment, Line, Wind
from tests.builders import ICE_AT_40, discretized, run, source_line

OTHER = Aerodynamics((-0.3, 1.0, 4.0), (0.5, 0.2, 0.1), (0.3, 0.2, 2.0), fitted_range=0.4)
BUNDLES = [source_line(count) for count in (4, 1, 3, 2)]


def numbers(result: Result) -> list[float]:
    """Return every number of every row, in order."""
    rows: list[Any] = [*result.frequencies, *result.critical_wind_speeds, *result.limit_cycles]
    return [value for row in rows for value in astuple(row) if isinstance(value, float)]


def test_splitting_ice_into_equal_pieces_changes_nothing() -> None:
    line = source_line(2)
    same = IceSegment(0.0, 31.0, ICE_AT_40, *(line.ice.eccentricity_y, line.ice.eccentricity_z), mass=2.379)
    pieces = tuple(replace(same, start=a, stop=b) for a, b in ((0.0, 31.0), (31.0, 47.3), (47.3, 50.0), (90.0, 125.88)))
    analysis = Analysis(wind_speeds=(5.0,))
    whole, split = (run(x, analysis) for x in (line, replace(line, ice=replace(line.ice, segments=pieces))))
    assert len(numbers(whole)) == len(numbers(split))
    # The matrices agree to rounding (below). EA/T = 1e3 and the detuning of the 1:1 resonance (5e-4) magnify that, and
    # the critical speeds of the finite element model feel it most: 5e-9.
    assert numbers(split) == pytest.approx(numbers(whole), rel=1e-7, abs=1e-10)
    one_loop = [[row for row in x.critical_wind_speeds if row.loops == 1] for x in (whole, split)]
    assert one_loop[0][0].wind_speed_m_per_s == pytest.approx(one_loop[1][0].wind_speed_m_per_s, rel=1e-11)
    for name in ("mass", "stiffness"):
        a, b = (
            getattr(discretized(x).matrices, name)
            for x in (line, replace(line, ice=replace(line.ice, segments=pieces)))
        )
        assert a == pytest.approx(b, abs=1e-12 * np.abs(a).max())


def segmented() -> Line:
    """Return a line with boundaries inside of elements and a segment shorter than an element."""
    line = source_line(1)
    segments = (
        IceSegment(5.0, 20.0, mass=3.0),
        IceSegment(20.0, 23.0, eccentricity_y=1e-3),
        IceSegment(100.1, 101.3, OTHER, mass=1.9),
    )
    spoiler = AirflowSpoiler(60.0, 70.0, OTHER, 0.4)
    wind = Wind(1.2, profile=((30.0, 0.8), (62.94, 1.2)))
    return replace(line, ice=replace(line.ice, segments=segments), devices=(spoiler,), wind=wind)


def test_mass_and_moment_of_pieces_are_exact() -> None:
    line = segmented()
    discretization = discretized(line)
    c = discretization.profile.catenary_parameter[0]

    def arc(start: float, stop: float) -> float:
        return float(c * (math.sinh((stop - 62.94) / c) - math.sinh((start - 62.94) / c)))

    up, turn = (np.arange(84) % FIELDS == kind for kind in (V, THETA))
    mass = 2.379 * arc(0.0, 125.88) + 0.621 * arc(5.0, 20.0) - 0.479 * arc(100.1, 101.3) + 0.4 * arc(60.0, 70.0)
    # The isoparametric element stretches its curve by up to (h/c)^2/12 = 1e-5 unevenly; the mass sees 1e-7 of that.
    assert up @ discretization.matrices.mass[0] @ up == pytest.approx(mass, rel=1e-7)
    e_z = line.ice.eccentricity_z
    moment = e_z * (mass - 0.4 * arc(60.0, 70.0))  # a spoiler sits about the centre
    assert up @ discretization.matrices.mass[0] @ turn == pytest.approx(-moment, rel=1e-7)
    across = np.arange(84) % FIELDS == W
    e_y_moment = 2.05e-3 * (mass - 0.4 * arc(60.0, 70.0)) - 1.05e-3 * 2.379 * arc(20.0, 23.0)
    assert across @ discretization.matrices.mass[0] @ turn == pytest.approx(e_y_moment, rel=1e-7)


def test_properties_hold_where_they_are_said_to() -> None:
    line = segmented()
    discretization = discretized(line)
    here = discretization.sections
    arc = (np.arange(10)[:, None] + 0.5 * (here.local[0] + 1.0)) * discretization.profile.arc_length[0] / 10.0
    c = discretization.profile.catenary_parameter[0]
    x = 62.94 + c * np.arcsinh((arc - 0.5 * discretization.profile.arc_length[0]) / c)
    expected = np.full(x.shape, 2.379)
    expected[(x > 5.0) & (x < 20.0)] = 3.0
    expected[(x > 100.1) & (x < 101.3)] = 1.9
    expected[(x > 60.0) & (x < 70.0)] += 0.4
    weighty = here.local_weight[0] > 0.0
    assert here.mass[0][weighty] == pytest.approx(expected[weighty], rel=1e-14)
    assert here.wind_factor[0] == pytest.approx(np.interp(x, [30.0, 62.94], [0.8, 1.2]), rel=1e-12)
    spoiled = (x > 60.0) & (x < 70.0) | (x > 100.1) & (x < 101.3)
    vertical = here.aerodynamics[0, ..., 0, 1][weighty]
    assert vertical == pytest.approx(np.where(spoiled, -0.3, -0.1667)[weighty], rel=1e-14)
    assert here.fitted_range[0] == 0.4
    assert here.local_weight[0].sum(axis=-1) == pytest.approx(np.full(10, 2.0), rel=1e-13)


def test_lines_with_different_boundaries_stack_without_touching_one_another() -> None:
    plain, cut = source_line(1), segmented()
    together = discretized(plain, cut).matrices
    for i, line in enumerate((plain, cut)):
        alone = discretized(line).matrices
        assert together.mass[i] == pytest.approx(alone.mass[0], abs=1e-13 * np.abs(alone.mass).max())
        assert together.stiffness[i] == pytest.approx(alone.stiffness[0], abs=1e-13 * np.abs(alone.stiffness).max())


def test_ice_on_the_whole_span_as_a_segment_is_the_ice_of_the_span() -> None:
    line = source_line(2)
    bare = Ice(OTHER, segments=(IceSegment(0.0, 125.88, ICE_AT_40, *(2.05e-3, -0.63e-3), mass=2.379),))
    analysis = Analysis(loops=(1,), wind_speeds=(5.0,))
    one, other = run(line, analysis), run(replace(line, ice=bare), analysis)
    assert numbers(other) == pytest.approx(numbers(one), rel=1e-7, abs=1e-10)


def test_positions_are_padded_with_zeros() -> None:
    positions, present = padded_positions(BUNDLES)
    assert positions.shape == (4, 4, 2)
    for line, own, here in zip(BUNDLES, positions, present, strict=True):
        assert own[here].tolist() == [list(position) for position in line.bundle.positions]
        assert not own[~here].any()


def test_sums_are_those_of_each_bundle_by_itself() -> None:
    for line, sums in zip(BUNDLES, bundle_sums(BUNDLES).T, strict=True):
        y, z = np.array(line.bundle.positions).T
        expected = (y.size, y.sum(), z.sum(), (y**2).sum(), (z**2).sum(), (y * z).sum())
        assert sums == pytest.approx(expected, abs=1e-15)


def test_turned_sums_are_those_of_the_turned_positions() -> None:
    angle = np.random.default_rng(0).uniform(-3.0, 3.0, size=(4, 2, 3))
    sums = turned_sums(BUNDLES, angle)
    for i, line in enumerate(BUNDLES):
        y, z = np.array(line.bundle.positions).T
        c, s = np.cos(angle[i])[..., None], np.sin(angle[i])[..., None]
        eta, zeta = c * y - s * z, s * y + c * z
        expected = [
            np.full(angle[i].shape, y.size),
            *(x.sum(axis=-1) for x in (eta, zeta, eta**2, zeta**2, eta * zeta)),
        ]
        assert sums[:, i] == pytest.approx(np.array(expected), abs=1e-15)
