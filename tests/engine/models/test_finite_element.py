from dataclasses import replace

import numpy as np
import pytest

from benchmarks.free_vibration import SPANS, finite_element_shift
from engine.mechanics.modes import full_modes
from engine.spec import Analysis, DampingModel, Stretching
from tests.builders import discretized, finite_element, random_line, source_line

RATIOS = np.array([0.000515, 0.000515, 0.308])


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


def test_without_the_modes_of_one_loop_a_relief_coordinate_takes_their_place() -> None:
    line = SPANS["source's line, springs"]
    shifts = [finite_element_shift(line, 0.95, loops) for loops in ((2,), (2, 4), (2, 3), (1, 2, 3, 5))]
    assert shifts[:3] == pytest.approx([shifts[3]] * 3, rel=2e-3)
    stretched = Analysis(stretching=Stretching.INCLUDED)
    model = finite_element(source_line(2), (2, 3), stretched)
    assert model.mass.shape == (1, 7, 7)
    assert not model.shapes[0, 6].any()
    assert model.direction.tolist() == [0, 0, 1, 1, 2, 2, 0]
    natural = np.sqrt(model.stiffness[0, 6, 6] / model.mass[0, 6, 6])
    assert model.damping[0, 6] == pytest.approx(np.eye(7)[6] * 0.2 * natural * model.mass[0, 6, 6])
    for loops, analysis in (((1, 2), stretched), ((2, 3), Analysis())):
        assert finite_element(source_line(2), loops, analysis).mass.shape == (1, 6, 6)
