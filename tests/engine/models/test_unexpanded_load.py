"""The unexpanded load against its formula written out, the expanded load, finite differences, and statics."""

import math
from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.mechanics.modes import at_points
from engine.models.discretization import Discretization, in_wind, with_wind_twist
from engine.models.reduced_model import ReducedModel, force, force_gradient, gradient_at_rest, take
from engine.models.unexpanded_load import UnexpandedLoad, unexpanded_load
from engine.spec import AerodynamicLoad, AerodynamicModel, Aerodynamics, Analysis, Bundle, IceSegment, Line
from tests.builders import ICE_AT_40, discretized, finite_element, hybrid, source_line
from tests.engine.synthetic_table import with_table
from tests.engine.unexpanded_wind import on_bundle

KNOWN = replace(ICE_AT_40, at_rest=(0.1, 1.0, -0.05))
RELATIVE = Analysis(aerodynamic_model=AerodynamicModel.RELATIVE_WIND)
UNEXPANDED = replace(RELATIVE, aerodynamic_load=AerodynamicLoad.UNEXPANDED)
TABLE = Analysis(aerodynamic_model=AerodynamicModel.TABLE)


def iced(line: Line, aerodynamics: Aerodynamics = KNOWN) -> Line:
    return replace(line, ice=replace(line.ice, aerodynamics=aerodynamics))


def off_centre(line: Line) -> Line:
    """Return a line whose reference curve is not the centroid of its bundle."""
    return replace(line, bundle=Bundle(((0.1, -0.2), (0.05, 0.25), (-0.2, 0.1))))


def random_states(model: ReducedModel, samples: int, size: float) -> FloatArray:
    """Return states whose angles of attack are of some size [rad]."""
    states = np.random.default_rng(5).normal(size=(1, samples, 2 * model.mass.shape[-1]))
    largest = np.abs(states @ model.load.angle.swapaxes(-1, -2)).max()
    return np.asarray(size / largest * states)


@pytest.mark.parametrize(("line", "loops"), [(source_line(1), 2), (source_line(2), 1), (off_centre(source_line(3)), 2)])
def test_load_is_the_integral_of_the_formula(line: Line, loops: int) -> None:
    line = iced(line)
    model, system = hybrid(line, loops, UNEXPANDED), discretized(line)
    state = random_states(model, 3, 0.8)
    shapes = at_points(system.matrices, model.shapes)[0]
    q, rate = state[0, :, :3], state[0, :, 3:]
    v, w, theta = (np.einsum("sm,mep->sep", rate, shapes[:, i]) for i in range(3))
    motion = np.stack([np.einsum("sm,mep->sep", q, shapes[:, 2]), v, w, theta])
    coefficients = np.array(
        [
            (a_0, *row)
            for a_0, row in zip((0.1, 1.0, -0.05), (KNOWN.vertical, KNOWN.horizontal, KNOWN.torsional), strict=True)
        ]
    )
    density = on_bundle(line, coefficients, motion)
    d, n = line.conductor.diameter, len(line.bundle.positions)
    density = 0.5 * line.wind.air_density * d * n * density * np.array([1.0, 1.0, d])[:, None, None, None]
    expected = np.einsum("isep,miep,ep->sm", density, shapes, system.matrices.weight[0])
    assert force(model, state)[0] == pytest.approx(expected, rel=1e-10, abs=1e-12)


@pytest.mark.parametrize(
    ("line", "asked"),
    [
        (iced(off_centre(source_line(3))), UNEXPANDED),
        (off_centre(with_table(source_line(3), 25.0)), TABLE),
        (with_table(source_line(1), -20.0), TABLE),
    ],
)
def test_gradient_is_that_of_finite_differences(line: Line, asked: Analysis) -> None:
    for model in (hybrid(line, 2, asked), finite_element(line, (1, 2), asked)):
        state = random_states(model, 2, 1.2)
        exact = force_gradient(model, state)
        for k in range(state.shape[-1]):
            step = 1e-6 * np.abs(state).max() * np.eye(state.shape[-1])[k]
            numerical = (force(model, state + step) - force(model, state - step)) / (2.0 * step[k])
            assert exact[..., k] == pytest.approx(numerical, rel=1e-5, abs=1e-7 * np.abs(exact[..., k]).max())


def test_mirror_images_are_evaluated_once_where_line_and_shapes_are_symmetric() -> None:
    line = with_table(source_line(2), 20.0)
    uneven = replace(line, ice=replace(line.ice, segments=(IceSegment(0.0, 40.0, aerodynamics=KNOWN),)))

    def count(line: Line, loops: int) -> int:
        load = hybrid(line, loops, TABLE).unexpanded
        assert load is not None
        return int((load.strength > 0.0).sum())

    assert [count(line, 1), count(line, 2), count(line, 3)] == [25, 50, 25]
    assert count(uneven, 1) > 50


def test_the_gradient_at_rest_is_kept() -> None:
    model = hybrid(off_centre(with_table(source_line(3), 25.0)), 2, TABLE)
    still = force_gradient(model, np.zeros((1, 1, 6)))[:, 0]
    assert gradient_at_rest(model) == pytest.approx(still, rel=1e-12)
    plain = hybrid(source_line(2), 1)
    assert gradient_at_rest(plain) == pytest.approx(force_gradient(plain, np.zeros((1, 1, 6)))[:, 0], rel=1e-12)


def test_difference_from_the_expanded_load_falls_as_the_fourth_power_of_the_motion() -> None:
    line = iced(off_centre(source_line(3)))
    expanded, whole = hybrid(line, 1, RELATIVE), hybrid(line, 1, UNEXPANDED)
    state = random_states(whole, 5, 0.2)
    residual = [np.abs(force(whole, s * state) - force(expanded, s * state)).max() for s in (1.0, 0.5, 0.25)]
    assert 14.0 < residual[0] / residual[1] < 18.5
    assert 15.0 < residual[1] / residual[2] < 17.0
    linear = force_gradient(expanded, np.zeros_like(state))
    assert force_gradient(whole, np.zeros_like(state)) == pytest.approx(linear, abs=1e-10 * np.abs(linear).max())


def test_a_table_agrees_with_its_own_cubic_as_the_motion_goes_to_zero() -> None:
    line = with_table(source_line(2), 0.0)
    cubic = iced(source_line(2), replace(ICE_AT_40, at_rest=(0.0, 1.0, 0.0)))
    table, expanded = hybrid(line, 2, TABLE), hybrid(cubic, 2, RELATIVE)
    state = random_states(table, 5, 0.02)
    size = np.abs(force(expanded, state)).max(axis=(0, 1))
    assert (np.abs(force(table, state) - force(expanded, state)).max(axis=(0, 1)) < 2e-3 * size).all()


def test_load_stays_bounded_where_cubics_do_not() -> None:
    line = with_table(source_line(1), 0.0)
    table, expanded = hybrid(line, 1, TABLE), hybrid(line, 1, replace(RELATIVE))
    state = np.zeros((1, 1, 6))
    state[..., 2] = 3.0
    assert np.abs(force(table, state)).max() < 0.1 * np.abs(force(expanded, state)).max()


def test_every_point_has_its_own_curve_and_lines_of_a_stack_do_not_touch() -> None:
    part = IceSegment(0.0, 40.0, aerodynamics=KNOWN)
    mixed = with_table(source_line(2), 10.0)
    mixed = replace(mixed, ice=replace(mixed.ice, segments=(part,)))
    lines = (mixed, iced(source_line(4)), with_table(off_centre(source_line(3)), 25.0))
    together, load = _loads(discretized(*lines))
    state = np.random.default_rng(2).normal(scale=0.2, size=(1, 2, 6))
    for i, line in enumerate(lines):
        _, alone = _loads(discretized(line))
        mine = replace(together, unexpanded=load.take((slice(i, i + 1), 0)))
        its = replace(together, unexpanded=alone.take((slice(None), 0)))
        assert force(mine, state) == pytest.approx(force(its, state))


def _loads(system: Discretization) -> tuple[ReducedModel, UnexpandedLoad]:
    """Return some model, and the load on sine shapes of a stack of lines."""
    wave = np.sin(np.pi * np.linspace(0.0, 1.0, 21))
    shapes = np.broadcast_to((np.eye(3)[..., None] * wave), (len(system.lines), 1, 3, 3, 21))
    load = unexpanded_load(system, np.stack([at_points(system.matrices, shapes[:, 0])], axis=1))
    return take(hybrid(source_line(1), 1), [0]), load


def test_load_about_the_twisted_state_is_that_of_a_section_that_rests_there() -> None:
    """Where bundle and ice hardly turn, the twist is a shift of the table."""
    line = with_table(source_line(2), 20.0)
    twisted = in_wind(with_wind_twist(discretized(line), np.array([30.0])), np.array([0]))
    _, load = _loads(twisted)
    _, still = _loads(discretized(line))
    state = np.random.default_rng(3).normal(scale=0.1, size=(1, 1, 3, 6))
    model = take(hybrid(source_line(1), 1), [0])

    def at(load: UnexpandedLoad) -> FloatArray:
        return force(replace(model, unexpanded=load), state)

    change = at(load) - at(still)
    turn = float(twisted.sections.twist[0].min())
    assert -0.02 < turn < -0.003
    shifted = with_table(source_line(2), 20.0 + math.degrees(turn))
    _, there = _loads(discretized(shifted))
    largest = np.abs(at(there) - at(still)).max()
    assert 0.2 * largest < np.abs(change).max() < largest
