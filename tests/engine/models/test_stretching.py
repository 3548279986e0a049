"""The stretching of sub-conductors against their energy, integrated sub-conductor by sub-conductor."""

import math
from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.models.stretching import (
    StretchingForce,
    dynamic_tension,
    relieved_share,
    restoring_force,
    restoring_gradient,
    slope_points,
    span_stiffness,
    stretching_of,
    take_stretching,
    tension_range,
)
from engine.spec import Bundle, Line, Support, Supports
from tests.builders import discretized, source_line

UNEVEN = Bundle(((0.1, 0.05), (-0.2, 0.3), (0.05, -0.25)))
CASES = {
    "twin": source_line(2),
    "uneven": replace(source_line(3), bundle=UNEVEN),
    "dead ends": replace(source_line(1), supports=Supports(None, Support(dead_end=True), Support(dead_end=True))),
}


def shapes(line: Line, coordinates: int = 4) -> FloatArray:
    """Return arbitrary smooth shapes that vanish at the supports: (1, 1, coordinates, 3, nodes)."""
    waves = np.sin(np.pi * np.outer(np.arange(1, 4), np.linspace(0.0, 1.0, 2 * line.span.elements + 1)))
    weights = np.random.default_rng(1).normal(size=(1, 1, coordinates, 3, 3))
    return np.asarray((weights @ waves) * np.array([1.0, 1.0, 0.5])[:, None], dtype=np.float64)


def energy(line: Line, nodal: FloatArray, q: FloatArray) -> float:
    """Return P by its definition: the strain of every sub-conductor at every point. Theory section 12.1."""
    made = discretized(line)
    at = slope_points((line,), made.profile, made.sections)
    elements = line.span.elements
    moved = np.tensordot(q, nodal[0, 0], axes=1)
    slope = np.zeros((3, *at.weight.shape[1:]))
    for e in range(elements):
        slope[:, e] = moved[:, 2 * e : 2 * e + 3] @ at.slopes[0, e].T
    x, y, _ = np.moveaxis(at.direction[0], -1, 0)
    ds, n = at.weight[0], len(line.bundle.positions)
    linear, square, local, local_linear = [], [], [], []
    for y_i, z_i in line.bundle.positions:
        v, w = slope[0] - z_i * slope[2], slope[1] + y_i * slope[2]
        linear.append((y / x * v * ds).sum())
        square.append((0.5 * (v**2 + w**2) / x * ds).sum())
        turning = 0.5 * (y_i**2 + z_i**2) * slope[2] ** 2
        local_linear.append(-z_i * y * slope[2])
        local.append(-z_i * (y + slope[0]) * slope[2] + y_i * slope[1] * slope[2] + turning)
    e, h = np.mean(linear), np.mean(square)
    effective = (ds / x**2).sum()
    k = 1.0 / (effective / line.conductor.axial_rigidity + (1.0 / made.profile.end_stiffness).sum())
    beyond = (np.array(local) - np.mean(local, axis=0)) ** 2
    beyond = beyond - (np.array(local_linear) - np.mean(local_linear, axis=0)) ** 2
    return float(n * k / 2.0 * ((e + h) ** 2 - e**2) + 0.5 * line.conductor.axial_rigidity * (beyond * ds).sum())


@pytest.mark.parametrize("name", CASES)
def test_the_force_is_the_slope_of_the_energy(name: str) -> None:
    line = CASES[name]
    made, nodal = discretized(line), shapes(line)
    stretching = take_stretching(stretching_of(made, nodal), (0, 0))
    assert stretching is not None
    q = np.array([0.4, -0.3, 0.8, 0.2])
    step = 1e-4
    slopes = [(energy(line, nodal, q + step * d) - energy(line, nodal, q - step * d)) / (2.0 * step) for d in np.eye(4)]
    found = restoring_force(stretching, q[None])[0]
    assert found == pytest.approx(slopes, rel=1e-6, abs=1e-6 * np.abs(slopes).max())
    gradient = restoring_gradient(stretching, q[None])[0]
    around = [restoring_force(stretching, (q + s * step * np.eye(4))) for s in (1.0, -1.0)]
    assert gradient == pytest.approx(((around[0] - around[1]) / (2.0 * step)).T, rel=1e-6, abs=1e-6 * gradient.max())
    assert gradient == pytest.approx(gradient.T, rel=1e-9)


def test_it_has_no_linear_part() -> None:
    line = source_line(2)
    made = discretized(line)
    stretching = stretching_of(made, shapes(line))
    assert not stretching.table[..., :4].any()
    assert stretching.table[..., 4:].any()


def test_upward_motion_slackens_and_sideways_motion_tightens() -> None:
    line = source_line(1)
    made = discretized(line)
    nodal = np.zeros((1, 1, 2, 3, 2 * line.span.elements + 1))
    nodal[0, 0, 0, 0] = nodal[0, 0, 1, 1] = np.sin(np.pi * np.linspace(0.0, 1.0, nodal.shape[-1]))
    stretching = take_stretching(stretching_of(made, nodal), (0, 0))
    assert stretching is not None
    up, down, sideways = dynamic_tension(stretching, np.array([[0.1, 0.0], [-0.1, 0.0], [0.0, 0.1]]))[:, 0]
    assert up < 0.0 < sideways < down
    parameter, arc = made.profile.catenary_parameter[0], made.profile.arc_length[0]
    # a_v = -(p/H) int f ds of the level catenary, and B of a sine, up to the sag's share of the slopes
    stiffness = span_stiffness((line,), made.profile, slope_points((line,), made.profile, made.sections))[0]
    assert stretching.linear[0, 0] == pytest.approx(-2.0 * stiffness * arc / math.pi / parameter, rel=1e-4)
    assert stretching.square[0, 1, 1] == pytest.approx(0.5 * stiffness * math.pi**2 / arc, rel=1e-3)


def test_the_range_of_tension_is_over_sub_conductors_and_samples() -> None:
    linear = np.array([[[2.0, 0.0], [0.0, -3.0]]])
    stretching = StretchingForce(np.zeros(0), np.zeros(0), linear, np.zeros((1, 2, 2, 2)))
    assert tension_range(stretching, np.array([[[1.0, 2.0], [-4.0, 1.0]]])) == pytest.approx(np.array([[[-8.0, 2.0]]]))


def test_the_sag_relieves_a_parabola_by_its_slopes() -> None:
    line = CASES["dead ends"]
    made = discretized(line)
    at = slope_points((line,), made.profile, made.sections)
    length, parameter = line.span.length, made.profile.catenary_parameter[0]
    k, tension = span_stiffness((line,), made.profile, at)[0], made.profile.horizontal_tension[0]
    expected = 1.0 / (1.0 + k / tension * length**3 / (12.0 * parameter**2))
    assert relieved_share((line,), made.profile, made.sections)[0] == pytest.approx(expected, rel=2e-3)


def test_end_springs_yield_to_tension() -> None:
    line = source_line(1)
    made = discretized(line)
    at = slope_points((line,), made.profile, made.sections)
    own = line.conductor.axial_rigidity / (at.weight / at.direction[..., 0] ** 2).sum()
    springs = made.profile.end_stiffness[0]
    expected = 1.0 / (1.0 / own + 1.0 / springs[0] + 1.0 / springs[1])
    assert span_stiffness((line,), made.profile, at)[0] == pytest.approx(expected, rel=1e-12)
    held = discretized(CASES["dead ends"])
    assert span_stiffness(held.lines, held.profile, at)[0] == pytest.approx(own, rel=1e-12)
