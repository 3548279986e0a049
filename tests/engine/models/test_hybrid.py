"""Reduced models against dense algebra on the full matrices."""

from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.mechanics.finite_elements import FIELDS, THETA, U, V, W
from engine.mechanics.modes import directional_shapes, full_modes
from engine.models.discretization import observation
from engine.models.hybrid import hybrid_model
from engine.models.reduced_model import take
from engine.spec import Analysis, DampingModel, DetuningPendulum, Line, LongitudinalInertia, Spacer
from tests.builders import discretized, finite_element, hybrid, random_line, source_line

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
def test_condensation_is_static_elimination_of_f_u(
    subconductors: int, loops: int, inertia: LongitudinalInertia
) -> None:
    line = equipped(subconductors)
    columns, stiffness, mass = basis_of(line, loops)
    full_k, full_m = columns.T @ stiffness @ columns, columns.T @ mass @ columns
    follow = np.vstack([-full_k[:1, 1:] / full_k[0, 0], np.eye(3)])
    if inertia is LongitudinalInertia.NEGLECTED:
        full_m[0, :] = full_m[:, 0] = 0.0
    model = hybrid(line, loops, Analysis(longitudinal_inertia=inertia))
    size = np.abs(full_k).max()
    # K_vv and its condensation cancel to EA/T = 1e-3 of their size.
    assert model.stiffness[0] == pytest.approx(follow.T @ full_k @ follow, abs=1e-12 * size)
    assert model.mass[0] == pytest.approx(follow.T @ full_m @ follow, rel=1e-10, abs=1e-9)


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


@pytest.mark.parametrize("kind", list(DampingModel))
def test_finite_element_damping_is_diagonal_in_the_directional_modes(kind: DampingModel) -> None:
    # The single conductor with its ice balanced has no coupling: full modes are the directional ones.
    line = source_line(1)
    line = replace(
        line,
        ice=replace(line.ice, eccentricity_y=0.0, eccentricity_z=0.0),
        damping=replace(line.damping, model=kind),
    )
    model = finite_element(line)
    omega = np.sqrt(np.diagonal(model.stiffness[0]))
    taken = omega.reshape(3, 3)[:, :1] if kind is DampingModel.CONSTANT_COEFFICIENT else omega.reshape(3, 3)
    expected = np.diag((2.0 * RATIOS[:, None] * np.broadcast_to(taken, (3, 3))).ravel())
    assert model.damping[0] == pytest.approx(expected, rel=1e-7, abs=1e-7 * expected[0, 0])


def test_finite_element_damping_takes_energy_from_every_mode() -> None:
    for seed in range(5):
        model = finite_element(random_line(np.random.default_rng(seed)))
        assert model.damping[0] == pytest.approx(model.damping[0].T, abs=1e-12 * np.abs(model.damping).max())
        assert np.linalg.eigvalsh(model.damping[0]).min() > 0.0


def test_finite_element_model_is_diagonal_in_its_modes() -> None:
    line = source_line(2)
    discretization = discretized(line)
    modes = full_modes(discretization.matrices, (1, 2, 3))
    vectors = modes.vectors[0].reshape(9, -1)
    model = finite_element(line)
    assert model.mass[0] == pytest.approx(np.eye(9), abs=1e-15)
    projected = vectors @ discretization.matrices.stiffness[0] @ vectors.T
    assert model.stiffness[0] == pytest.approx(projected, abs=1e-8 * np.abs(projected).max())
    assert model.direction.tolist() == [0, 0, 0, 1, 1, 1, 2, 2, 2]


@pytest.mark.parametrize("loops", [1, 2, 3, 4])
def test_observation_reads_shapes_at_the_first_crest(loops: int) -> None:
    line = source_line(1)
    discretization = discretized(line)
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, (1, 2, 3, 4))
    model = take(hybrid_model(discretization, shapes, (loops,), Analysis()), 0)
    seen = observation(discretization, model.shapes, loops)[0]
    assert seen == pytest.approx(np.diag(np.diagonal(seen)), abs=1e-15)
    # W and the single conductor's Theta are sines of unit amplitude; four loops have 2.5 elements a half wave.
    assert np.diagonal(seen)[1:] == pytest.approx([1.0, 1.0], abs=4e-3)


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
