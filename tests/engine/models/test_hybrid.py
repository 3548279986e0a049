"""Reduced models against dense algebra on the full matrices."""

from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.mechanics.finite_elements import FIELDS, THETA, U, V, W
from engine.mechanics.modes import directional_shapes
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.hybrid import hybrid_model
from engine.models.reduced_model import take
from engine.spec import (
    Analysis,
    BlowOut,
    Closure,
    DampingModel,
    DetuningPendulum,
    Ice,
    Line,
    LongitudinalInertia,
    Spacer,
    Span,
    Supports,
    Wind,
)
from tests.builders import ICE_AT_40, discretized, finite_element, hybrid, source_line

RATIOS = np.array([0.000515, 0.000515, 0.308])


def basis_of(line: Line, loops: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return f_u, f_v, f_w, f_theta as columns on all freedoms, with K and M."""
    discretization = discretized(line)
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, tuple(sorted({1, loops})))
    columns = np.zeros((84, 4))
    for kind in (U, V, W, THETA):
        columns[kind::FIELDS, kind] = shapes.nodal[0, shapes.loops.index(loops), kind]
    return columns, discretization.matrices.stiffness[0], discretization.matrices.mass[0]


def equipped(subconductors: int) -> Line:
    """Return a line with a pendulum and a spacer, so that nothing is symmetric about mid-span."""
    devices = (DetuningPendulum(40.0, 9.0, 0.4, 0.3), Spacer(20.0, 5.0, 0.4))
    return replace(source_line(subconductors), devices=devices)


@pytest.mark.parametrize("subconductors", [1, 2, 3])
@pytest.mark.parametrize("loops", [1, 2, 3])
@pytest.mark.parametrize("inertia", list(LongitudinalInertia))
def test_condensation_eliminates_f_u(subconductors: int, loops: int, inertia: LongitudinalInertia) -> None:
    line = equipped(subconductors)
    columns, stiffness, mass = basis_of(line, loops)
    full_k, full_m = columns.T @ stiffness @ columns, columns.T @ mass @ columns
    follow = np.vstack([-full_k[:1, 1:] / full_k[0, 0], np.eye(3)])
    if inertia is LongitudinalInertia.NEGLECTED:
        full_m[0, :] = full_m[:, 0] = 0.0
    else:
        follow[0, 0] = 1.0  # the vertical shape keeps the f_u of its mode
    model = hybrid(line, loops, Analysis(longitudinal_inertia=inertia))
    size = np.abs(full_k).max()
    # K_vv and its condensation cancel to EA/T = 1e-3 of their size.
    assert model.stiffness[0] == pytest.approx(follow.T @ full_k @ follow, abs=1e-12 * size)
    assert model.mass[0] == pytest.approx(follow.T @ full_m @ follow, rel=1e-10, abs=1e-9)


@pytest.mark.parametrize(
    ("length", "sag", "stiffness"), [(126.0, 0.012, None), (800.0, 0.08, None), (800.0, 0.04, 2e3)]
)
def test_condensed_model_has_the_vertical_frequencies_of_the_finite_elements(
    length: float, sag: float, stiffness: float | None
) -> None:
    """Also on slack spans with soft supports, where the longitudinal frequency comes close to that of two loops."""
    line = replace(
        source_line(2),
        span=Span(length, sag=sag * length, elements=16),
        supports=Supports(stiffness),
        ice=Ice(ICE_AT_40),
    )
    discretization = discretized(line)
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, (1, 2, 3))
    asked = Analysis(longitudinal_inertia=LongitudinalInertia.CONDENSED)
    model = take(hybrid_model(discretization, shapes, (1, 2, 3), asked), 0)
    assert np.sqrt(model.uncoupled_squares[:, 0]) == pytest.approx(shapes.angular_frequency[0, :, 0], rel=1e-6)


@pytest.mark.parametrize("loops", [1, 2, 3])
@pytest.mark.parametrize("kind", list(DampingModel))
def test_hybrid_damping_is_eq_11_with_the_frequencies_of_its_model(loops: int, kind: DampingModel) -> None:
    line = source_line(3)
    line = replace(line, damping=replace(line.damping, model=kind))
    model, one = hybrid(line, loops), hybrid(line, 1)
    frequencies_of = one if kind is DampingModel.CONSTANT_COEFFICIENT else model
    omega = np.sqrt(frequencies_of.uncoupled_squares[0])
    expected = np.diag(2.0 * RATIOS * omega * model.modal_masses[0])
    assert model.damping[0] == pytest.approx(expected, rel=1e-12, abs=1e-15)


def test_stacks_hold_what_each_line_has_alone() -> None:
    lines = (source_line(1), source_line(3), equipped(2))
    discretization = discretized(*lines)
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, (1, 2))
    stack = hybrid_model(discretization, shapes, (1, 2), Analysis())
    for i, line in enumerate(lines):
        for j, loops in enumerate((1, 2)):
            alone = hybrid(line, loops)
            for name in ("mass", "damping", "stiffness"):
                expected = getattr(alone, name)[0]
                assert getattr(stack, name)[i, j] == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())
            assert stack.load.table[i, j] == pytest.approx(alone.load.table[0], rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("closure", list(Closure))
def test_blown_out_hybrid_model_gallops_where_the_finite_elements_do(closure: Closure) -> None:
    # The full modes are the same in any axes, so they hold the load that the hybrid model turns.
    line = replace(source_line(1), wind=Wind(1.2929, blow_out=BlowOut(25.0, 1.2)))
    models = (hybrid(line, 1, Analysis(closure=closure)), finite_element(line, (1,)))
    found, expected = (critical_wind_speeds(model, 12.0) for model in models)
    assert len(expected.wind_speed) > 0
    assert found.wind_speed == pytest.approx(expected.wind_speed, rel=0.003)
    assert found.oscillation.tolist() == expected.oscillation.tolist()


def test_in_plane_motion_after_blow_out_rises_as_it_swings_upwind() -> None:
    line = replace(source_line(1), wind=Wind(1.2929, blow_out=BlowOut(25.0, 1.2)))
    tilt = discretized(line).profile.tilt[0]
    vertical, horizontal, _ = hybrid(line).shapes[0, 0, :, 10]
    assert vertical > 0.0
    assert horizontal / vertical == pytest.approx(-np.tan(tilt), rel=1e-12)
