"""Cubic fits of tabulated coefficients against the relations (A18) and (A19)."""

import numpy as np
import pytest

from engine.mechanics.coefficients import CoefficientTable, den_hartog_coefficient, fit_coefficients
from engine.outcome import InvalidSpec

STATIC = 0.7
A_Y, A_Z, A_M = (0.3, -0.17, -4.1, 8.4), (1.2, 0.86, 0.83, 1.8), (-0.1, -0.73, 0.29, 6.0)


def table(rows: int = 41) -> CoefficientTable:
    """Return lift, drag and moment of exact cubics: C_L = C_y cos - C_z sin, C_D = C_y sin + C_z cos."""
    alpha = np.linspace(-0.4, 0.4, rows)
    c_y, c_z, c_m = (a[0] + a[1] * alpha + a[2] * alpha**2 + a[3] * alpha**3 for a in (A_Y, A_Z, A_M))
    lift, drag = c_y * np.cos(alpha) - c_z * np.sin(alpha), c_y * np.sin(alpha) + c_z * np.cos(alpha)
    return CoefficientTable(alpha + STATIC, lift, drag, c_m)


def test_cubics_are_recovered() -> None:
    found = fit_coefficients(table(), STATIC, 0.3)
    assert found.aerodynamics.vertical == pytest.approx(A_Y[1:], rel=1e-9)
    assert found.aerodynamics.horizontal == pytest.approx(A_Z[1:], rel=1e-9)
    assert found.aerodynamics.torsional == pytest.approx(A_M[1:], rel=1e-9)
    assert found.aerodynamics.at_rest == pytest.approx((A_Y[0], A_Z[0], A_M[0]), rel=1e-9)
    assert found.aerodynamics.fitted_range == pytest.approx(0.3, abs=1e-12)
    assert found.residual == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_residual_is_the_root_mean_square_of_what_is_left() -> None:
    exact = table()
    wobble = 0.01 * (-1.0) ** np.arange(exact.angle.size)
    found = fit_coefficients(CoefficientTable(exact.angle, exact.lift, exact.drag, exact.moment + wobble), STATIC, 0.4)
    assert found.residual[2] == pytest.approx(0.01, rel=0.01)
    assert found.residual[0] == pytest.approx(0.0, abs=1e-12)


def test_first_vertical_coefficient_is_den_hartogs() -> None:
    fine = table(4001)
    at = int(np.abs(fine.angle - STATIC).argmin())
    # a_y1 = dC_L/dalpha + C_D at the static angle, by (A18).
    assert den_hartog_coefficient(fine)[at] == pytest.approx(A_Y[1], abs=1e-5)


@pytest.mark.parametrize(("static", "half_range"), [(STATIC, 0.03), (STATIC + 0.5, 0.3), (5.0, 0.3)])
def test_too_few_rows_or_one_side_are_refused(static: float, half_range: float) -> None:
    with pytest.raises(InvalidSpec, match="half_range"):
        fit_coefficients(table(), static, half_range)


def from_40_deg_on(step: int) -> CoefficientTable:
    angle = np.radians(np.sort(40.0 + step * np.arange(11.0)))
    return CoefficientTable(angle, np.sin(angle), np.cos(angle), np.sin(2.0 * angle))


@pytest.mark.parametrize("step", [2, -2])
def test_rows_that_begin_or_end_at_the_static_angle_lie_on_one_side_of_it(step: int) -> None:
    """From 40 to 60 degrees about 40, and from 20 to 40."""
    with pytest.raises(InvalidSpec, match="on both sides of the static angle"):
        fit_coefficients(from_40_deg_on(step), np.radians(40.0), np.radians(20.0))
    assert fit_coefficients(from_40_deg_on(step), np.radians(40.0 + 1.5 * step), np.radians(20.0)).rows == 11


def test_table_must_be_finite_rising_and_of_one_length() -> None:
    good = np.linspace(0.0, 1.0, 6)
    with pytest.raises(InvalidSpec) as caught:
        CoefficientTable(good[::-1], good[:5], np.full(6, np.nan), good)
    assert [fault.field for fault in caught.value.faults] == ["table.lift", "table.drag", "table.angle"]
