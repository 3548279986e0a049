"""Curves of coefficients against the series behind a table, cubics, and finite differences."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.arrays import FloatArray
from engine.mechanics.coefficient_curves import (
    coefficient_curves,
    cubics_about,
    evaluate,
    largest_moment_slopes,
    local_curves,
    outside,
)
from engine.mechanics.coefficients import fit_measured
from engine.spec import Aerodynamics, IceSegment, MeasuredCoefficients
from tests.builders import ICE_AT_40, discretized, source_line
from tests.engine.synthetic_table import measured, series, tabulated, with_table

AT_REST = replace(ICE_AT_40, at_rest=(0.3, 1.1, -0.2), fitted_range=0.5)


def stretch(table: MeasuredCoefficients, low: float, high: float) -> MeasuredCoefficients:
    """Return the rows of a table between two angles [deg]."""
    kept = [i for i, a in enumerate(table.angle) if math.radians(low) <= a <= math.radians(high)]
    angle, lift, drag, moment = (
        tuple(column[i] for i in kept) for column in (table.angle, table.lift, table.drag, table.moment)
    )
    return MeasuredCoefficients(angle, lift, drag, moment, table.static_angle, table.half_range)


def at(source: Aerodynamics, angle: FloatArray) -> tuple[FloatArray, FloatArray]:
    return evaluate(coefficient_curves((source,)), np.zeros(angle.shape, dtype=np.intp), angle)


def test_a_spline_of_the_circle_follows_the_series_behind_it_over_several_turns() -> None:
    angle = np.random.default_rng(0).uniform(-9.0, 9.0, 400)
    values, slopes = at(tabulated(0.0), angle)
    for i, name in enumerate(("cl", "cd", "cm")):
        value, slope = series(name, angle)
        assert values[:, i] == pytest.approx(value, abs=2e-6)
        assert slopes[:, i] == pytest.approx(slope, abs=2e-4)


def test_a_circle_whose_last_row_is_left_out_is_closed() -> None:
    whole = measured(0.0)
    angle = np.linspace(-3.2, 3.2, 50)
    shorter = MeasuredCoefficients(
        whole.angle[:-1], whole.lift[:-1], whole.drag[:-1], whole.moment[:-1], 0.0, whole.half_range
    )
    for found, expected in zip(at(fit_measured(shorter), angle), at(fit_measured(whole), angle), strict=True):
        assert found == pytest.approx(expected, abs=1e-12)


def test_a_stretch_goes_on_straight_beyond_its_ends_and_says_so() -> None:
    source = fit_measured(stretch(measured(0.0), -60.0, 45.0))
    ends = np.radians([-60.0, 45.0])
    values, slopes = at(source, ends)
    beyond = ends + np.array([-0.4, 1.3])
    there, slopes_there = at(source, beyond)
    assert there == pytest.approx(values + slopes * (beyond - ends)[:, None], rel=1e-12)
    assert slopes_there == pytest.approx(slopes, rel=1e-12)
    curves = coefficient_curves((source, tabulated(0.0), AT_REST))
    assert outside(curves, np.zeros(3, dtype=np.intp), np.radians([-60.1, 0.0, 45.1])).tolist() == [True, False, True]
    assert not outside(curves, np.ones(2, dtype=np.intp), np.array([-50.0, 50.0])).any()
    assert outside(curves, np.full(3, 2), np.array([-0.51, 0.49, 0.51])).tolist() == [True, False, True]


def test_slopes_are_the_derivatives_of_the_values_for_every_kind_of_curve() -> None:
    curves = coefficient_curves((tabulated(0.0), fit_measured(stretch(measured(0.0), -60.0, 45.0)), AT_REST))
    generator = np.random.default_rng(1)
    which, angle = generator.integers(0, 3, 600), generator.uniform(-2.0, 2.0, 600)
    up, down = (evaluate(curves, which, angle + step)[0] for step in (1e-6, -1e-6))
    assert evaluate(curves, which, angle)[1] == pytest.approx((up - down) / 2e-6, abs=1e-6)


@given(st.floats(-1.5, 1.5))
def test_cubics_are_turned_from_the_section_to_the_wind(angle: float) -> None:
    """(A18), (A19): C_y = C_L cos a + C_D sin a, C_z = -C_L sin a + C_D cos a."""
    (lift, drag, moment), _ = (part[0] for part in at(AT_REST, np.array([angle])))
    powers = angle ** np.arange(1, 4)
    assert lift * math.cos(angle) + drag * math.sin(angle) == pytest.approx(0.3 + powers @ AT_REST.vertical, abs=1e-9)
    assert drag * math.cos(angle) - lift * math.sin(angle) == pytest.approx(1.1 + powers @ AT_REST.horizontal, abs=1e-9)
    assert moment == pytest.approx(-0.2 + powers @ AT_REST.torsional, abs=1e-9)


def test_cubics_about_the_angle_of_the_source_are_the_sources() -> None:
    """The table has them by construction; a step of one degree leaves 5 % in the third derivative."""
    found = cubics_about(coefficient_curves((tabulated(0.0),)), np.zeros(1, dtype=np.intp), np.zeros(1))[0]
    assert found[:, 0] == pytest.approx([0.0, 1.0, 0.0], abs=1e-9)
    for row, expected in zip(found, (ICE_AT_40.vertical, ICE_AT_40.horizontal, ICE_AT_40.torsional), strict=True):
        assert row[1] == pytest.approx(expected[0], abs=2e-3)
        assert row[2] == pytest.approx(expected[1], abs=2e-2)
        assert row[3] == pytest.approx(expected[2], abs=0.05 * abs(expected[2]) + 0.05)


@pytest.mark.parametrize("source", [tabulated(0.0), AT_REST])
def test_fits_over_smaller_and_smaller_ranges_come_to_the_series(source: Aerodynamics) -> None:
    curves = coefficient_curves((source,))
    which, angle = np.zeros(3, dtype=np.intp), np.array([-0.4, 0.1003, 0.7])
    exact = cubics_about(curves, which, angle)
    fitted = cubics_about(curves, which, angle, 1e-3)
    assert fitted[..., :2] == pytest.approx(exact[..., :2], abs=1e-5)
    assert fitted[..., 2] == pytest.approx(exact[..., 2], abs=2e-2)


def test_cubics_about_another_angle_give_the_same_forces_there() -> None:
    """A cubic of the section is developed about a twisted section: both give the same C_L and C_D nearby."""
    curves = coefficient_curves((AT_REST, tabulated(0.0)))
    for which in (np.zeros(1, dtype=np.intp), np.ones(1, dtype=np.intp)):
        (row,) = cubics_about(curves, which, np.array([0.3005]))
        alpha = 1e-3
        (values,) = evaluate(curves, which, np.array([0.3005 + alpha]))[0]
        vertical, horizontal, moment = row @ alpha ** np.arange(4)
        c, s = math.cos(alpha), math.sin(alpha)
        assert values == pytest.approx(
            [vertical * c - horizontal * s, vertical * s + horizontal * c, moment], abs=1e-10
        )


def test_no_slope_of_the_moment_exceeds_the_largest() -> None:
    curves = coefficient_curves((tabulated(0.0), fit_measured(stretch(measured(0.0), -60.0, 45.0)), AT_REST))
    largest = largest_moment_slopes(curves)
    angle = np.linspace(-3.2, 3.2, 20001)
    for i in (0, 1):
        slopes = evaluate(curves, np.full(angle.shape, i), angle)[1][:, 2]
        assert slopes.max() <= largest[i] * (1.0 + 1e-9)
        assert slopes.max() == pytest.approx(largest[i], rel=1e-4)
    assert largest[2] == np.inf


def test_every_point_has_the_curve_of_its_ice_and_its_static_angle() -> None:
    line = with_table(source_line(2), 20.0)
    part = IceSegment(0.0, 30.0, aerodynamics=AT_REST)
    system = discretized(replace(line, ice=replace(line.ice, segments=(part,))), line)
    local = local_curves(system.lines, system.profile, system.sections)
    here = system.sections.local_weight[0] > 0.0
    share = (system.matrices.weight[0] * (local.which[0] == 1))[here].sum() / system.matrices.weight[0].sum()
    assert share == pytest.approx(30.0 / 125.88, rel=1e-3)
    assert (local.which[1] == 0).all()
    assert local.angle[1] == pytest.approx(math.radians(20.0))
    assert set(local.angle[0][local.which[0] == 1].tolist()) == {0.0}


def test_density_of_rows_at_equal_distances_and_of_others() -> None:
    table = measured(0.0)
    rows = [*range(20), *range(20, len(table.angle), 5)]
    angle, lift, drag, moment = (
        tuple(column[i] for i in rows) for column in (table.angle, table.lift, table.drag, table.moment)
    )
    uneven = MeasuredCoefficients(angle, lift, drag, moment, table.static_angle, table.half_range)
    sources = (fit_measured(table), fit_measured(stretch(table, -30.0, 40.0)), fit_measured(uneven), AT_REST)
    per_degree = 180.0 / math.pi
    assert coefficient_curves(sources).density == pytest.approx([per_degree, per_degree, 0.0, 0.0], rel=1e-9)
