"""What a line has along its span: means over pieces, wind factor, boundaries."""

import math
from dataclasses import replace

import numpy as np
import pytest

from engine.mechanics.along_span import boundaries, mean_drag, mean_mass, wind_factor
from engine.spec import Aerodynamics, AirflowSpoiler, BlowOut, IceSegment, Wind
from tests.builders import ICE_AT_40, source_line

AT_REST = replace(ICE_AT_40, at_rest=(0.1, 1.2, 0.0))
OTHER = Aerodynamics((-0.3, 1.0, 4.0), (0.5, 0.2, 0.1), (0.3, 0.2, 2.0), at_rest=(0.0, 0.8, 0.0))


def test_boundaries_are_listed_once_in_rising_order() -> None:
    line = source_line(1)
    segments = (IceSegment(0.0, 20.0, mass=3.0), IceSegment(20.0, 23.0, eccentricity_y=1e-3))
    line = replace(line, ice=replace(line.ice, segments=segments), devices=(AirflowSpoiler(60.0, 70.0, OTHER, 0.4),))
    line = replace(line, wind=Wind(profile=((0.0, 0.8), (62.94, 1.2), (125.88, 1.0))))
    assert boundaries(line) == [20.0, 23.0, 60.0, 62.94, 70.0]


def test_mean_mass_takes_segments_by_their_length() -> None:
    line = source_line(1)
    ice = replace(line.ice, segments=(IceSegment(0.0, 31.47, mass=3.379), IceSegment(94.41, 125.88, mass=1.379)))
    assert mean_mass(replace(line, ice=ice)) == pytest.approx(2.379, rel=1e-14)
    one = replace(line.ice, segments=(IceSegment(10.0, 72.94, mass=3.379),))
    assert mean_mass(replace(line, ice=one)) == pytest.approx(2.879, rel=1e-14)


def test_mean_drag_of_a_given_coefficient_is_the_dynamic_pressure_on_the_diameter() -> None:
    line = replace(source_line(2), wind=Wind(1.25, blow_out=BlowOut(20.0, 1.1)))
    assert mean_drag(line) == pytest.approx(0.5 * 1.25 * 400.0 * 0.0286 * 1.1, rel=1e-14)
    assert mean_drag(source_line(2)) == 0.0


def test_mean_drag_without_a_coefficient_is_the_drag_at_rest_of_every_stretch() -> None:
    line = source_line(1)
    segments = (IceSegment(0.0, 31.47, OTHER), IceSegment(31.47, 62.94, ICE_AT_40))  # the second one: not known
    line = replace(line, ice=replace(line.ice, aerodynamics=AT_REST, segments=segments))
    line = replace(line, wind=Wind(1.25, blow_out=BlowOut(20.0)))
    share = (0.8 + 3 * 1.2) / 4.0
    assert mean_drag(line) == pytest.approx(0.5 * 1.25 * 400.0 * 0.0286 * share, rel=1e-14)


def test_mean_drag_follows_the_square_of_wind_profile_and_yaw() -> None:
    profile = ((0.0, 0.5), (125.88, 1.5))
    line = replace(source_line(1), wind=Wind(1.25, profile, BlowOut(20.0, 1.0), yaw=math.radians(30.0)))
    square = (1.5**3 - 0.5**3) / 3.0 * math.cos(math.radians(30.0)) ** 2
    assert mean_drag(line) == pytest.approx(0.5 * 1.25 * 400.0 * 0.0286 * square, rel=1e-13)


def test_only_the_component_across_the_line_blows() -> None:
    x = np.array([0.0, 50.0, 125.88])
    assert wind_factor(replace(source_line(1), wind=Wind(yaw=math.radians(60.0))), x) == pytest.approx(0.5, rel=1e-14)
    profile = ((0.0, 0.8), (100.0, 1.2))
    yawed = replace(source_line(1), wind=Wind(1.25, profile, yaw=math.radians(-60.0)))
    assert wind_factor(yawed, x) == pytest.approx([0.4, 0.5, 0.6], rel=1e-14)
