"""The static profile against the catenary's own identities and (A10)."""

import math
from dataclasses import replace

import numpy as np
import pytest

from engine.mechanics.static_profile import (
    arc_position,
    coordinates,
    end_steepness,
    horizontal_position,
    static_profile,
)
from engine.outcome import InvalidSpec
from engine.spec import BlowOut, Span, Support, Supports, Wind, Yoke
from tests.builders import source_line

WEIGHT = 2.379 * 9.81


def test_catenary_parameter_sag_and_tension_are_one_another() -> None:
    by_tension = static_profile((source_line(2),))
    c, sag = by_tension.catenary_parameter[0], by_tension.sag[0]
    assert c == pytest.approx(30_000.0 / WEIGHT, rel=1e-14)
    assert sag == pytest.approx(c * (math.cosh(62.94 / c) - 1.0), rel=1e-12)
    for span in (Span(125.88, catenary_parameter=float(c)), Span(125.88, sag=float(sag))):
        other = static_profile((replace(source_line(2), span=span),))
        assert other.horizontal_tension[0] == pytest.approx(30_000.0, rel=1e-12)
        assert other.arc_length[0] == pytest.approx(by_tension.arc_length[0], rel=1e-13)


def test_arc_and_position_are_inverse_and_measure_the_curve() -> None:
    profile = static_profile((replace(source_line(1), span=Span(300.0, sag=20.0)), source_line(2)))
    x = np.linspace(0.0, 1.0, 2001) * profile.span_length[:, None]
    arc = arc_position(profile, x)
    assert horizontal_position(profile, arc) == pytest.approx(x, abs=1e-10)
    assert arc[:, 0] == pytest.approx([0.0, 0.0], abs=1e-12)
    assert arc[:, -1] == pytest.approx(profile.arc_length, rel=1e-13)
    chords = np.linalg.norm(np.diff(coordinates(profile, arc), axis=1), axis=-1).sum(axis=1)
    assert chords == pytest.approx(profile.arc_length, rel=1e-8)  # 2000 chords: (h/c)^2/24


def test_coordinates_satisfy_the_equilibrium_of_the_cable() -> None:
    profile = static_profile((source_line(2),))
    x = np.linspace(0.0, 125.88, 401)[None]
    y = coordinates(profile, arc_position(profile, x))[0, :, 1]
    # H y'' = p sqrt(1 + y'^2); second differences of 0.3 m are good to 1e-8 here.
    step = x[0, 1]
    slope = np.gradient(y, step, edge_order=2)[1:-1]
    bend = np.diff(y, 2) / step**2
    assert 30_000.0 * bend == pytest.approx(WEIGHT * np.sqrt(1.0 + slope**2), rel=1e-6)
    assert y[[0, -1]] == pytest.approx([0.0, 0.0], abs=1e-12)
    assert -y.min() == pytest.approx(profile.sag[0], rel=1e-12)


def test_blow_out_turns_the_plane_of_the_sag_downwind() -> None:
    blown = replace(source_line(2), wind=Wind(1.25, blow_out=BlowOut(20.0, 1.1)))
    profile = static_profile((blown,))
    drag = 0.5 * 1.25 * 20.0**2 * 0.0286 * 1.1
    assert profile.tilt[0] == pytest.approx(math.atan(drag / WEIGHT), rel=1e-14)
    resultant = math.hypot(WEIGHT, drag)
    assert profile.catenary_parameter[0] == pytest.approx(profile.horizontal_tension[0] / resultant, rel=1e-13)
    arc = np.array([[0.5 * profile.arc_length[0]]])
    x, y, z = coordinates(profile, arc)[0, 0]
    assert x == pytest.approx(62.94, abs=1e-9)
    assert y == pytest.approx(-profile.sag[0] * WEIGHT / resultant, rel=1e-12)
    assert z == pytest.approx(profile.sag[0] * drag / resultant, rel=1e-12)


def by_hand(adjacent: float) -> float:
    """Return the first term of (A10) for an adjacent span of the same H and weight."""
    rigidity, tension = source_line(1).conductor.axial_rigidity, 30_000.0
    c = tension / WEIGHT
    arc = 2.0 * c * math.sinh(adjacent / (2.0 * c))
    return 12.0 * rigidity * tension**3 / (12.0 * arc * tension**3 + rigidity * WEIGHT**2 * adjacent**3)


def test_supports_follow_a10_with_the_string_and_unequal_spans() -> None:
    supports = Supports(left=Support(adjacent_span=200.0), right=Support(insulator_length=1.6, insulator_weight=350.0))
    found = static_profile((replace(source_line(1), supports=supports),)).end_stiffness[0]
    arc = static_profile((source_line(1),)).arc_length[0]
    assert found[0] == pytest.approx(by_hand(200.0), rel=1e-12)
    assert found[1] == pytest.approx(by_hand(125.88) + WEIGHT * arc / 1.6 + 350.0 / 3.2, rel=1e-12)


def test_string_between_unequal_spans_carries_half_of_each() -> None:
    supports = Supports(left=Support(adjacent_span=60.0, insulator_length=2.0))
    found = static_profile((replace(source_line(1), supports=supports),)).end_stiffness[0, 0]
    c = 30_000.0 / WEIGHT
    arcs = [2.0 * c * math.sinh(x / (2.0 * c)) for x in (125.88, 60.0)]
    assert found == pytest.approx(by_hand(60.0) + 0.5 * WEIGHT * sum(arcs) / 2.0, rel=1e-12)


def test_given_stiffness_wins_at_both_ends_and_a_dead_end_over_its_neighbour() -> None:
    # The contract: "a given stiffness (per sub-conductor, both ends) wins; else (A10) at each end".
    ends = Supports(left=Support(dead_end=True), right=Support(insulator_length=1.0))
    given = replace(ends, longitudinal_stiffness=7e4)
    assert static_profile((replace(source_line(1), supports=given),)).end_stiffness[0].tolist() == [7e4, 7e4]
    left, right = static_profile((replace(source_line(1), supports=ends),)).end_stiffness[0]
    assert left == math.inf
    assert right < math.inf


def test_end_springs_keep_the_stiffness_of_still_air() -> None:
    line = replace(source_line(1), span=Span(300.0, sag=9.0))
    blown = replace(line, wind=Wind(1.25, blow_out=BlowOut(30.0, 1.2)))
    still, profile = static_profile((line,)), static_profile((blown,))
    assert profile.end_stiffness.tolist() == still.end_stiffness.tolist()


def test_level_difference_is_measured_from_left_to_right() -> None:
    span = Span(300.0, horizontal_tension=30_000.0, level_difference=60.0)
    line = replace(source_line(1), span=span)
    profile = static_profile((line,))
    ends = np.array([[0.0, profile.arc_length[0]]])
    assert coordinates(profile, ends)[0] == pytest.approx(np.array([[0.0, 0.0, 0.0], [300.0, 60.0, 0.0]]), abs=1e-9)
    assert profile.horizontal_tension[0] == pytest.approx(30_000.0, rel=1e-14)
    by_sag = replace(span, horizontal_tension=None, sag=float(profile.sag[0]))
    assert static_profile((replace(line, span=by_sag),)).horizontal_tension[0] == pytest.approx(30_000.0, rel=1e-12)


@pytest.mark.parametrize("rise", [-60.0, 0.0, 120.0])
def test_blown_out_curve_hangs_between_the_supports_in_the_plane_of_its_load(rise: float) -> None:
    span = Span(300.0, horizontal_tension=30_000.0, level_difference=rise)
    line = replace(source_line(1), span=span, wind=Wind(1.25, blow_out=BlowOut(25.0, 1.1)))
    profile = static_profile((line,))
    arc = np.linspace(0.0, profile.arc_length, 4001, axis=-1)
    place = coordinates(profile, arc)[0]
    assert place[0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)
    assert place[-1] == pytest.approx([300.0, rise, 0.0], abs=1e-9)
    assert horizontal_position(profile, arc)[0] == pytest.approx(place[:, 0], abs=1e-9)
    # Equilibrium: d(T r')/ds balances weight and drag, with H along X the same everywhere.
    step = arc[0, 1]
    tangent = np.diff(place, axis=0) / step
    force = profile.horizontal_tension[0] * tangent / tangent[:, :1]
    load = np.diff(force, axis=0) / step
    drag = 0.5 * 1.25 * 25.0**2 * 0.0286 * 1.1
    assert load == pytest.approx(np.broadcast_to([0.0, WEIGHT, -drag], load.shape), abs=2e-5 * WEIGHT)


def test_uplift_of_an_insulator_string_is_a_fault() -> None:
    supports = Supports(left=Support(insulator_length=2.0), right=Support(insulator_length=2.0))
    steep = Span(300.0, horizontal_tension=30_000.0, level_difference=120.0)
    line = replace(source_line(1), span=steep, supports=supports)
    with pytest.raises(InvalidSpec) as refused:
        static_profile((line,))
    assert [fault.field for fault in refused.value.faults] == ["supports.left.insulator_length"]
    heavy = replace(supports, left=Support(insulator_length=2.0, insulator_weight=30_000.0))
    held = static_profile((replace(line, supports=heavy),)).end_stiffness[0]
    c = 30_000.0 / WEIGHT
    low = 150.0 - c * math.asinh(120.0 / (2.0 * c * math.sinh(150.0 / c)))
    own, other = (30_000.0 * math.sinh(x / c) for x in (low, 150.0))
    assert held[0] == pytest.approx(by_hand(300.0) + (own + other + 15_000.0) / 2.0, rel=1e-12)


def test_tension_at_the_steeper_end_follows_from_the_slope_of_the_curve() -> None:
    line = replace(source_line(1), span=replace(source_line(1).span, level_difference=40.0))
    windy = replace(line, wind=replace(line.wind, blow_out=BlowOut(20.0, 1.0)))
    profile = static_profile((source_line(1), line, windy))
    ends = np.array([[0.0, 1e-4], [1.0 - 1e-4, 1.0]]) * profile.arc_length[:, None, None]
    points = coordinates(profile, ends.reshape(3, -1)).reshape(3, 2, 2, 3)
    steps = np.diff(points, axis=2)[:, :, 0]
    steepness = np.linalg.norm(steps, axis=-1) / steps[..., 0]
    assert end_steepness(profile) == pytest.approx(steepness.max(axis=-1), rel=1e-5)


def test_free_yoke_feels_the_adjacent_span_without_the_string() -> None:
    loose = Support(dead_end=True, yoke=Yoke.FREE)
    for left, right, expected in (
        (Support(), Support(dead_end=True), [math.inf, math.inf]),
        (Support(insulator_length=1.6, adjacent_span=200.0), loose, [by_hand(200.0), 0.0]),
        (Support(yoke=Yoke.FREE), Support(insulator_length=1.6, yoke=Yoke.HELD), [by_hand(125.88), math.inf]),
    ):
        line = replace(source_line(2), supports=Supports(left=left, right=right))
        assert static_profile((line,)).yoke_stiffness[0] == pytest.approx(expected, rel=1e-12)
    line = replace(source_line(2), supports=Supports(7e4, Support(yoke=Yoke.FREE), Support()))
    assert static_profile((line,)).yoke_stiffness[0].tolist() == [7e4, math.inf]
