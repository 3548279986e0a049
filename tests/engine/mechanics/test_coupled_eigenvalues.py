"""Eigenvalues of all freedoms from the modes of each direction, against the solution with all vectors."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.mechanics.coupled_eigenvalues import full_eigenvalues
from engine.mechanics.finite_elements import Matrices
from engine.mechanics.modes import DirectionalShapes, directional_shapes, full_modes
from engine.models.discretization import discretize
from engine.spec import CrossSection, Line, Span, Supports
from tests.builders import deep, random_line, source_line

LOOPS = (1, 2, 3)


@settings(max_examples=10)
@given(st.integers(0, 10**6))
def test_eigenvalues_are_those_of_the_full_modes(seed: int) -> None:
    generator = np.random.default_rng(seed)
    lines = [random_line(generator) for _ in range(4)]
    free = [replace(line, bundle=replace(line.bundle, section=CrossSection.FREE)) for line in lines]
    system, shapes = with_shapes(*lines, *free)
    for loops in ((1, 2), (2, 5)):
        expected = full_modes(system, loops).eigenvalues
        assert full_eigenvalues(system, shapes, loops) == pytest.approx(expected, rel=1e-9)


def test_labels_of_eigenvalues_are_right_where_the_lowest_modes_do_not_tell_them() -> None:
    """Torsional modes of a single conductor lie above many others, and a sag turns the vertical ones round."""
    soft = replace(source_line(1), supports=Supports(longitudinal_stiffness=600.0))
    system, shapes = with_shapes(source_line(1), soft, *(deep(sag, dead_end=True) for sag in (2.0, 2.5, 3.0, 4.0)))
    expected = full_modes(system, LOOPS).eigenvalues
    assert full_eigenvalues(system, shapes, LOOPS) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("loops", [(1, 2), (1, 5)])
def test_directions_that_do_not_couple_and_few_elements_need_no_case_of_their_own(loops: tuple[int, ...]) -> None:
    ice = replace(source_line(2).ice, eccentricity_y=0.0, eccentricity_z=0.0)
    plain = replace(source_line(2), ice=ice, span=Span(125.88, horizontal_tension=30_000.0, elements=3))
    system, shapes = with_shapes(plain, replace(source_line(3), span=plain.span))
    expected = full_modes(system, loops).eigenvalues
    assert full_eigenvalues(system, shapes, loops) == pytest.approx(expected, rel=1e-9)


def test_eigenvalues_do_not_depend_on_the_other_lines_of_a_stack() -> None:
    generator = np.random.default_rng(3)
    lines = [random_line(generator) for _ in range(3)]
    together = full_eigenvalues(*with_shapes(*lines), LOOPS)
    for line, found in zip(lines, together, strict=True):
        assert (full_eigenvalues(*with_shapes(line), LOOPS)[0] == found).all()


def with_shapes(*lines: Line) -> tuple[Matrices, DirectionalShapes]:
    """Return the matrices of lines side by side, and their shapes of one to three loops."""
    made = discretize(lines)
    return made.matrices, directional_shapes(made.matrices, made.profile.arc_length, LOOPS)
