"""Modes: orthogonality, normalization, and one mode a label wherever frequencies cross."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.mechanics.finite_elements import FIELDS, THETA, U, V, W
from engine.mechanics.modes import (
    assign,
    at_points,
    directional_shapes,
    full_modes,
    longitudinal_share,
)
from engine.spec import Span, Supports
from tests.builders import deep, discretized, random_line, source_line

LOOPS = (1, 2, 3)


@settings(max_examples=10)
@given(st.integers(0, 10**6))
def test_full_modes_solve_the_eigenproblem_and_are_orthonormal(seed: int) -> None:
    discretization = discretized(random_line(np.random.default_rng(seed)))
    modes = full_modes(discretization.matrices, LOOPS)
    vectors, values = modes.vectors[0].reshape(9, -1), modes.eigenvalues[0].ravel()
    mass, stiffness, free = (
        discretization.matrices.mass[0],
        discretization.matrices.stiffness[0],
        ~discretization.matrices.fixed[0],
    )
    assert vectors @ mass @ vectors.T == pytest.approx(np.eye(9), abs=1e-9)
    rest = (vectors @ stiffness - values[:, None] * (vectors @ mass))[:, free]
    assert np.abs(rest).max() < 1e-8 * np.abs(vectors @ stiffness).max()
    assert np.abs(vectors[:, ~free]).max() == 0.0


@settings(max_examples=10)
@given(st.integers(0, 10**6))
def test_every_label_gets_a_mode_of_its_own(seed: int) -> None:
    discretization = discretized(random_line(np.random.default_rng(seed)))
    modes = full_modes(discretization.matrices, (1, 2, 3, 4))
    gram = modes.vectors[0].reshape(12, -1)
    overlap = gram @ discretization.matrices.mass[0] @ gram.T
    assert np.abs(overlap - np.diag(np.diagonal(overlap))).max() < 1e-8  # a mode taken twice would give 1


def test_shapes_are_normalized_aligned_and_solve_their_own_problems() -> None:
    discretization = discretized(source_line(3))
    length = discretization.profile.arc_length[0]
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, LOOPS)
    sines = np.sin(np.pi * np.outer(LOOPS, np.linspace(0.0, 1.0, 21)))
    for i, (rows, last) in enumerate((((U, V), V), ((W,), W), ((THETA,), THETA))):
        for j in range(3):
            values = at_points(discretization.matrices, shapes.nodal[:, j, last])[0]
            assert 2.0 / length * (values**2 * discretization.matrices.weight[0]).sum() == pytest.approx(1.0, rel=1e-12)
            assert shapes.nodal[0, j, last] @ sines[j] > 0.0
            whole = np.zeros((21, FIELDS))
            whole[:, rows] = shapes.nodal[0, j, list(rows)].T
            vector = whole.ravel()
            keep = np.isin(np.arange(84) % FIELDS, rows) & ~discretization.matrices.fixed[0]
            stiffness, mass = (
                m[0][np.ix_(keep, keep)] for m in (discretization.matrices.stiffness, discretization.matrices.mass)
            )
            square = shapes.angular_frequency[0, j, i] ** 2
            force = stiffness @ vector[keep]
            assert force == pytest.approx(square * (mass @ vector[keep]), abs=1e-8 * np.abs(stiffness).max() * 1e-3)


@pytest.mark.parametrize("dead_end", [False, True])
@pytest.mark.parametrize("sag", [0.5, 1.5, 2.0, 2.5, 3.0, 4.0])
def test_labels_follow_the_shape_and_not_the_order(sag: float, dead_end: bool) -> None:
    discretization = discretized(deep(sag, dead_end))
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, LOOPS)
    vertical = shapes.nodal[0, :, V]
    # One and three loops are symmetric about mid-span, two loops antisymmetric.
    for shape, parity in zip(vertical, (1.0, -1.0, 1.0), strict=True):
        assert shape == pytest.approx(parity * shape[::-1], abs=1e-6)
    # The antisymmetric mode does not feel the sag: a string's frequency but for the inertia of U (1 % at 4 m).
    weight = 9.81 * 2.379
    speed = np.sqrt(discretization.profile.horizontal_tension[0] / 2.379)
    assert shapes.angular_frequency[0, 1, 0] == pytest.approx(2.0 * np.pi * speed / 125.88, rel=0.01)
    assert weight * 125.88**2 / (8.0 * discretization.profile.horizontal_tension[0]) == pytest.approx(sag, rel=5e-3)


def test_first_symmetric_mode_crosses_the_antisymmetric_one() -> None:
    ratio = []
    for sag in (1.0, 4.0):
        discretization = discretized(deep(sag, dead_end=True))
        frequency = directional_shapes(
            discretization.matrices, discretization.profile.arc_length, LOOPS
        ).angular_frequency[0, :, 0]
        ratio.append(frequency[0] / frequency[1])
    assert ratio[0] < 1.0 < ratio[1]


def test_longitudinal_mode_is_never_taken() -> None:
    # Soft end springs put the mode in which the whole span slides among the vertical ones.
    line = replace(source_line(1), supports=Supports(longitudinal_stiffness=600.0))
    discretization = discretized(line)
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, LOOPS)
    along, up = shapes.nodal[0, :, U], shapes.nodal[0, :, V]
    assert (np.abs(along).max(axis=-1) < 0.3 * np.abs(up).max(axis=-1)).all()


def test_assignment_takes_the_surest_label_first() -> None:
    score = np.array([[[0.6, 0.5, 0.0], [0.9, 0.0, 0.1], [0.2, 0.3, 0.1]]])
    assert assign(score).tolist() == [[1, 0, 2]]


def test_longitudinal_share_is_that_of_the_energy() -> None:
    """By quadrature over the span, and what it does to the frequency if the inertia is dropped: 1/sqrt(1 - share)."""
    line = replace(source_line(1), span=Span(126.0, sag=10.08), supports=Supports(2e3))
    discretization = discretized(line)
    system = discretization.matrices
    shapes = directional_shapes(system, discretization.profile.arc_length, (1, 2))
    (share,) = longitudinal_share(system, shapes)
    along, upward = ((at_points(system, shapes.nodal[:, :, i]) ** 2 * system.weight[:, None])[0] for i in (U, V))
    squares = [part.sum(axis=(-1, -2)) for part in (along, upward)]
    assert share == pytest.approx(squares[0] / (squares[0] + squares[1]), rel=1e-9)
    assert share[1] == pytest.approx(0.165, abs=0.002)
