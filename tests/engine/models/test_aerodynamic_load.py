"""The aerodynamic load against direct quadrature of eq. (16) and the unexpanded relative wind."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.arrays import FloatArray
from engine.mechanics.modes import at_points
from engine.models.aerodynamic_load import (
    by_points,
    force,
    force_gradient,
    integrate_along_span,
    integrate_each,
    span_load,
)
from engine.models.reduced_model import ReducedModel
from engine.spec import AerodynamicModel, Aerodynamics, AirflowSpoiler, Analysis, Bundle, IceSegment, Line, Wind
from tests.builders import discretized, finite_element, hybrid, random_line, source_line
from tests.engine.motions import relative_line
from tests.engine.unexpanded_wind import on_bundle

RELATIVE = Analysis(aerodynamic_model=AerodynamicModel.RELATIVE_WIND)
AT_REST = (0.05, 1.1, -0.2)
OTHER = Aerodynamics((-0.3, 1.0, 4.0), (0.5, 0.2, 0.1), (0.3, 0.2, 2.0), (0.1, 0.9, 0.3))
WITHOUT_REST = Aerodynamics((0.4, 1.0, -1.0), (0.5, 0.2, 0.1), (0.3, 0.2, 2.0))


def varied() -> Line:
    """Return a triple bundle off its centroid with segments, a spoiler and a wind profile."""
    line = source_line(3)
    ice = replace(
        line.ice,
        aerodynamics=replace(line.ice.aerodynamics, at_rest=AT_REST),
        segments=(IceSegment(0.0, 33.0, OTHER), IceSegment(80.0, 91.0, WITHOUT_REST)),
    )
    wind = Wind(1.2, profile=((10.0, 0.7), (62.94, 1.3), (100.0, 0.9)))
    bundle = Bundle(tuple((y + 0.05, z - 0.03) for y, z in line.bundle.positions))
    return replace(line, bundle=bundle, ice=ice, wind=wind, devices=(AirflowSpoiler(50.0, 61.0, OTHER),))


def pieces(line: Line) -> list[tuple[float, float, Aerodynamics]]:
    """List the stretches of the varied line on which the coefficients and the slope of the wind are constant."""
    marks = [0.0, 10.0, 33.0, 50.0, 61.0, 62.94, 80.0, 91.0, 100.0, line.span.length]
    own = {0.0: OTHER, 10.0: OTHER, 50.0: OTHER, 80.0: WITHOUT_REST}
    return [(a, b, own.get(a, line.ice.aerodynamics)) for a, b in pairwise(marks)]


def by_quadrature(line: Line, model: ReducedModel, state: FloatArray, relative: bool) -> FloatArray:
    """Integrate the load of one state over the span by the trapezoidal rule on 4000 points a piece."""
    discretization = discretized(line)
    c, arc_length = discretization.profile.catenary_parameter[0], discretization.profile.arc_length[0]
    d, rho, n = line.conductor.diameter, line.wind.air_density, len(line.bundle.positions)
    m = state.size // 2
    total = np.zeros(m)
    for start, stop, a in pieces(line):
        x = np.linspace(start, stop, 4001)
        s = c * (np.sinh((x - 62.94) / c) + np.sinh(62.94 / c))
        shapes = interpolated(model.shapes[0], s / arc_length)
        phi = np.interp(x, [10.0, 62.94, 100.0], [0.7, 1.3, 0.9])
        v, w, turn = shapes[:, 0], shapes[:, 1], shapes[:, 2]
        theta = state[:m] @ turn
        rise, sway, spin = (state[m:] @ shape / phi for shape in (v, w, turn))
        if relative:
            loads = on_bundle(line, table_of(a), np.stack([theta, rise, sway, spin]))
        else:
            loads = cubic(a, theta - rise - 0.5 * d * spin)
        density = loads[0] * v + loads[1] * w + d * loads[2] * turn
        total += np.trapezoid(0.5 * rho * d * n * phi**2 * density, s, axis=-1)
    return total


def interpolated(nodal: FloatArray, along: FloatArray) -> FloatArray:
    """Evaluate nodal values (..., 21) of quadratic elements at s/L: (..., points)."""
    element = np.minimum((along * 10.0).astype(int), 9)
    t = along * 10.0 - element
    weights = np.stack([(1.0 - t) * (1.0 - 2.0 * t), 4.0 * t * (1.0 - t), t * (2.0 * t - 1.0)])
    return np.asarray(sum(nodal[..., 2 * element + i] * weights[i] for i in range(3)))


def cubic(a: Aerodynamics, alpha: FloatArray) -> FloatArray:
    """Return the cubics in the angle of attack."""
    rows = (a.vertical, a.horizontal, a.torsional)
    return np.stack([r[0] * alpha + r[1] * alpha**2 + r[2] * alpha**3 for r in rows])


def table_of(a: Aerodynamics) -> FloatArray:
    """Return a_i0 to a_i3, those at rest of the span where a stretch has none."""
    rows = (a.vertical, a.horizontal, a.torsional)
    return np.array([(a_0, *row) for a_0, row in zip(a.at_rest or AT_REST, rows, strict=True)])


@pytest.mark.parametrize("loops", [1, 2])
def test_hybrid_load_is_the_integral_of_eq_16(loops: int) -> None:
    line = varied()
    model = hybrid(line, loops)
    rng = np.random.default_rng(loops)
    for scale in (0.01, 0.3):
        state = scale * rng.normal(size=6)
        expected = by_quadrature(line, model, state, relative=False)
        # 4000 trapezoids a piece err by 1e-7; a boundary's place on the curved element by 1e-6.
        assert force(model.load, state[None, None])[0, 0] == pytest.approx(expected, rel=1e-5, abs=1e-6 * scale)


def test_finite_element_load_is_the_integral_of_eq_16() -> None:
    line = varied()
    model = finite_element(line, (1, 2))
    state = np.random.default_rng(5).normal(size=12) * 0.3
    expected = by_quadrature(line, model, state, relative=False)
    found = force(model.load, state[None, None])[0, 0]
    assert found == pytest.approx(expected, rel=1e-5, abs=1e-6 * np.abs(expected).max())


@pytest.mark.parametrize(
    ("build", "largest"),
    [
        (lambda line: hybrid(line, 2, RELATIVE), 0.02),
        (lambda line: finite_element(line, (1, 2), RELATIVE), 0.3),  # modes of unit mass: smaller motion
    ],
)
def test_relative_wind_load_is_the_integral_of_the_unexpanded_one_to_third_order(
    build: Callable[[Line], ReducedModel], largest: float
) -> None:
    line = varied()
    model = build(line)
    state = np.random.default_rng(7).normal(size=2 * model.mass.shape[-1])
    error = []
    for scale in (largest, 0.5 * largest):
        expected = by_quadrature(line, model, scale * state, relative=True)
        error.append(np.abs(force(model.load, scale * state[None, None])[0, 0] - expected).max() / scale)
    size = np.abs(force(model.load, largest * state[None, None])).max() / largest
    # What is left out begins at fourth order, so half the motion leaves an eighth, relative to the motion.
    assert error[0] < 5e-3 * size
    assert np.log2(error[0] / error[1]) == pytest.approx(3.0, abs=0.3)


@settings(max_examples=8)
@given(st.integers(0, 10**6), st.sampled_from([Analysis(), RELATIVE]))
def test_gradient_is_the_derivative_of_the_force(seed: int, analysis: Analysis) -> None:
    rng = np.random.default_rng(seed)
    line = random_line(rng)
    line = replace(line, ice=replace(line.ice, aerodynamics=replace(line.ice.aerodynamics, at_rest=AT_REST)))
    for model in (hybrid(line, 2, analysis), finite_element(line, (1, 2), analysis)):
        size, step = model.load.forms.shape[-1], 1e-3
        state = 0.1 * rng.normal(size=(size,))
        gradient = force_gradient(model.load, state[None, None])[0, 0]
        shifts = step * np.eye(size)
        points = np.concatenate([state + shifts, state - shifts, state + 2.0 * shifts, state - 2.0 * shifts])
        plus, minus, far, back = force(model.load, points[None])[0].reshape(4, size, -1)
        # Four-point differences are exact for cubics.
        expected = ((8.0 * (plus - minus) - (far - back)) / (12.0 * step)).T
        assert gradient == pytest.approx(expected, rel=1e-8, abs=1e-9 * np.abs(expected).max())


def test_integrated_load_is_the_pointwise_one() -> None:
    line = varied()
    discretization = discretized(line)
    model = hybrid(line, 1)
    values = at_points(discretization.matrices, model.shapes)[:, None]
    pointwise = span_load(
        (line,), discretization.sections, discretization.matrices.weight, values, AerodynamicModel.PUBLISHED
    )
    active = (2, 3, 5)
    once = integrate_along_span(pointwise, active)
    state = 0.2 * np.random.default_rng(2).normal(size=(1, 1, 7, 6))
    expected = force(by_points(pointwise), state)
    assert force(once, state) == pytest.approx(expected, rel=1e-10, abs=1e-12 * np.abs(expected).max())
    assert force(model.load, state[:, 0]) == pytest.approx(expected[:, 0], rel=1e-10, abs=1e-9)


def test_load_whose_variables_are_components_is_integrated_alike() -> None:
    line = varied()
    discretization = discretized(line)
    values = at_points(discretization.matrices, hybrid(line, 1).shapes)[:, None]
    pointwise = span_load(
        (line,), discretization.sections, discretization.matrices.weight, values, AerodynamicModel.RELATIVE_WIND
    )
    each, general = (integrate(pointwise, (2, 3, 4, 5)) for integrate in (integrate_each, integrate_along_span))
    assert each.forms == pytest.approx(general.forms)
    assert each.table == pytest.approx(general.table, rel=1e-11, abs=1e-12 * np.abs(general.table).max())


@pytest.mark.parametrize(
    ("analysis", "loops", "points"),
    [
        (RELATIVE, (1, 2), 1),
        (RELATIVE, (1, 2, 3), 1),
        (Analysis(), (1, 2), 50),  # one variable at every point: less than the 454 monomials of twelve
    ],
)
def test_finite_element_load_is_one_polynomial_where_that_costs_less(
    analysis: Analysis, loops: tuple[int, ...], points: int
) -> None:
    line = relative_line(3)
    discretization = discretized(line)
    model = finite_element(line, loops, analysis)
    assert model.load.forms.shape[1] == points
    values = at_points(discretization.matrices, model.shapes)[:, None]
    pointwise = span_load(
        (line,), discretization.sections, discretization.matrices.weight, values, analysis.aerodynamic_model
    )
    state = 0.2 * np.random.default_rng(8).normal(size=(1, 5, 2 * model.mass.shape[-1]))
    expected = force(by_points(pointwise), state[:, None])[:, 0]
    assert force(model.load, state) == pytest.approx(expected, rel=1e-9, abs=1e-11 * np.abs(expected).max())


def test_uniform_wind_factor_scales_the_wind() -> None:
    line = source_line(2)
    slower = replace(line, wind=Wind(1.2929, profile=((0.0, 0.7), (125.88, 0.7))))
    state = 0.1 * np.random.default_rng(4).normal(size=6)
    scaled = state / np.array([1.0, 1.0, 1.0, 0.7, 0.7, 0.7])
    one, other = force(hybrid(slower).load, state[None, None]), force(hybrid(line).load, scaled[None, None])
    assert one == pytest.approx(0.49 * other, rel=1e-12)
