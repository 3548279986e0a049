"""The relative wind at every sub-conductor against the unexpanded formulas of theory section 13."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.arrays import FloatArray
from engine.models.discretization import nodal_motion
from engine.models.relative_wind import arm_scale, bundle_table, largest_reach, relative_wind_table
from engine.numerics import polynomial
from engine.spec import AerodynamicModel, Bundle, Line, Wind
from tests.builders import discretized, hybrid, sorted_products, source_line
from tests.engine.unexpanded_wind import on_bundle, on_one

POSITIONS = ((0.21, 0.05), (-0.02, -0.31), (0.1, 0.17))  # not about their centroid


def irregular() -> Line:
    """Return a bundle of three whose reference curve is not its centroid."""
    return replace(source_line(3), bundle=Bundle(POSITIONS))


def expanded(line: Line, a: FloatArray, motion: FloatArray) -> FloatArray:
    """Return the same from the table."""
    table = bundle_table((line,), a[None, None], np.zeros((1, 1)))[0, 0]
    scale = np.array([1.0, 1.0, 1.0, arm_scale((line,))[0]])
    return np.asarray(table @ polynomial.powers(np.moveaxis(motion, 0, -1) * scale).T)


def coefficients(seed: int) -> FloatArray:
    return np.random.default_rng(seed).normal(size=(3, 4))


def of_source() -> FloatArray:
    """Return the coefficients of the source's Table 3 with drag alone at rest."""
    ice = source_line(1).ice.aerodynamics
    return np.array([(0.0, *ice.vertical), (1.0, *ice.horizontal), (0.0, *ice.torsional)])


@settings(max_examples=6)
@given(st.integers(0, 10**6))
def test_table_of_one_is_the_taylor_expansion_of_the_unexpanded_formula(seed: int) -> None:
    a = coefficients(seed)
    table = relative_wind_table(a)
    # A polynomial of degree 5 fitted through 11^3 points in a cube of 0.06 leaves sixth-order terms only.
    axis = 0.06 * np.cos(np.pi * (np.arange(11) + 0.5) / 11.0)
    points = np.array(list(product(axis, axis, axis)))
    values = on_one(a, *points.T).T - a[:, 0]
    exponents = [e for e in product(range(6), repeat=3) if 0 < sum(e) <= 5]
    scaled = points / 0.06
    design = np.stack([np.prod(scaled ** np.array(e), axis=-1) for e in exponents], axis=-1)
    fitted = np.linalg.lstsq(design, values, rcond=None)[0]
    for column, monomial in enumerate(sorted_products(3)):
        e = tuple(monomial.count(i) for i in range(3))
        expected = fitted[exponents.index(e)] / 0.06 ** len(monomial)
        assert table[:, column] == pytest.approx(expected, rel=1e-3, abs=2e-3)


def test_linear_part_is_that_of_the_theory() -> None:
    """Section 13: per sub-conductor F_y = (a_y1 - C_z0) Theta - a_y1 B - 2 C_y0 w and its companions, with arms."""
    line, a = irregular(), coefficients(3)
    (y_0, y_1), (z_0, z_1), (t_0, t_1) = a[:, :2]
    d = line.conductor.diameter
    expected = np.zeros((3, 4))
    for y, z in POSITIONS:
        rise, sway = np.array([0.0, 1.0, 0.0, 0.5 * d - z]), np.array([0.0, 0.0, 1.0, y])
        turn = np.array([1.0, 0.0, 0.0, 0.0])
        lift = (y_1 - z_0) * turn - y_1 * rise - 2.0 * y_0 * sway
        drag = (z_1 + y_0) * turn - z_1 * rise - 2.0 * z_0 * sway
        moment = t_1 * (turn - rise) - 2.0 * t_0 * sway
        expected += np.stack([lift, drag, moment + (y * drag - z * lift) / d]) / 3.0
    table = bundle_table((line,), a[None, None], np.zeros((1, 1)))[0, 0]
    scale = np.array([1.0, 1.0, 1.0, arm_scale((line,))[0]])
    assert table[:, :4] * scale == pytest.approx(expected, rel=1e-12, abs=1e-13)


def test_error_falls_as_the_fourth_power_of_the_motion() -> None:
    line, a = irregular(), coefficients(5)
    motion = np.random.default_rng(6).normal(size=(4, 40)) * np.array([1.0, 1.0, 1.0, 3.0])[:, None]
    size = [np.abs(expanded(line, a, s * motion) - on_bundle(line, a, s * motion)).max(axis=-1) for s in (2e-3, 1e-3)]
    assert np.log2(size[0] / size[1]) == pytest.approx(4.0, abs=0.05)


def test_errors_are_those_of_the_theory() -> None:
    """First harmonic over a cycle of a horizontal twin at r/d = 8; section 13's figures are upper bounds of ours."""
    line = source_line(2)
    line = replace(line, bundle=Bundle.regular(2, 8.0 * line.conductor.diameter, 0.5 * np.pi))
    wave = np.cos(2.0 * np.pi * np.arange(64) / 64)
    radius = 8.0 * line.conductor.diameter

    def error(output: int, variable: int, size: float) -> float:
        motion = np.zeros((4, 64))
        motion[variable] = size * wave
        found, exact = (load(line, of_source(), motion)[output] @ wave for load in (expanded, on_bundle))
        return abs(float(found / exact) - 1.0)

    for size, bound in ((0.3, 0.0003), (0.5, 0.003), (0.7, 0.009), (1.0, 0.028)):
        assert 0.75 * bound < error(2, 3, size / radius) < bound
    assert error(0, 1, 0.5) == pytest.approx(0.002, abs=0.0005)
    assert error(0, 1, 1.0) == pytest.approx(0.024, abs=0.0005)
    assert error(1, 2, 1.0) < 1e-12  # quadratic, so exact


def test_a_twist_turns_the_bundle() -> None:
    """The load of a bundle turned by 0.7 rad is that of the positions turned by hand."""
    line, a = irregular(), coefficients(8)
    y, z = np.array(POSITIONS).T
    c, s = np.cos(0.7), np.sin(0.7)
    turned = replace(line, bundle=Bundle(tuple(zip((c * y - s * z).tolist(), (s * y + c * z).tolist(), strict=True))))
    both = np.broadcast_to(a, (1, 2, 3, 4))
    found = bundle_table((line,), both, np.array([[0.0, 0.7]]))[0]
    for table, expected in zip(found, (line, turned), strict=True):
        assert table == pytest.approx(bundle_table((expected,), a[None, None], np.zeros((1, 1)))[0, 0], rel=1e-12)


def test_a_smaller_bundle_beside_a_larger_one_has_its_own_load() -> None:
    lines, a = (source_line(2), irregular()), np.stack([coefficients(9), coefficients(10)])[:, None]
    together = bundle_table(lines, a, np.zeros((2, 1)))
    for i, line in enumerate(lines):
        assert together[i] == pytest.approx(bundle_table((line,), a[[i]], np.zeros((1, 1)))[0], rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("model", list(AerodynamicModel))
def test_reach_is_the_largest_of_all_sub_conductors(model: AerodynamicModel) -> None:
    """Every node, sample and sub-conductor one by one, in a wind that varies along the span."""
    line = replace(irregular(), wind=Wind(1.2, profile=((0.0, 0.6), (125.88, 1.4))))
    reduced = hybrid(line, 2)
    state = 0.3 * np.random.default_rng(11).normal(size=(1, 5, 6)) * np.array([1.0, 1.0, 1.0, 0.5, 0.5, 2.0])
    motion = nodal_motion(discretized(line), np.zeros(1, dtype=np.intp), reduced.shapes, model)
    angle, velocity = largest_reach(motion, np.zeros(1, dtype=np.intp), state)[:, 0]
    d, positions = line.conductor.diameter, np.linspace(0.0, 1.0, 21)
    angles, velocities = [], []
    for node, sample in product(range(21), range(5)):
        phi = 0.6 + 0.8 * positions[node]
        v, w, theta = np.einsum("m,mi->i", state[0, sample, 3:], reduced.shapes[0, :, :, node])
        turn = float(state[0, sample, :3] @ reduced.shapes[0, :, 2, node])
        angles += [turn - v / phi - 0.5 * d * theta / phi] if model is AerodynamicModel.PUBLISHED else []
        for y, z in POSITIONS:
            rise, sway = (v - z * theta) / phi, (w + y * theta) / phi
            velocities.append(np.hypot(rise, sway))
            if model is not AerodynamicModel.PUBLISHED:
                angles.append(turn - np.arctan2(rise + 0.5 * d * theta / phi, 1.0 - sway))
    assert velocity == pytest.approx(max(velocities), rel=1e-3)  # arc length is not quite proportional to position
    assert angle == pytest.approx(max(np.abs(angles)), rel=1e-3)
