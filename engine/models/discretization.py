"""From lines to finite element matrices: what both reduced models are made from. Theory sections 2 and 3."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray
from engine.mechanics.cross_sections import Sections, sections
from engine.mechanics.finite_elements import Matrices, matrices, shape_functions
from engine.mechanics.static_profile import StaticProfile, static_profile
from engine.mechanics.static_twist import TwistedState, twisted_matrices, twisted_state
from engine.spec import Line, StaticTwist


@dataclass(frozen=True, slots=True)
class Discretization:
    """Everything of a stack of lines that both reduced models are made from; twist is None where it is neglected."""

    lines: tuple[Line, ...]
    profile: StaticProfile
    sections: Sections
    matrices: Matrices
    twist: TwistedState | None = None


def discretize(lines: Sequence[Line], static_twist: StaticTwist = StaticTwist.NEGLECTED) -> Discretization:
    """Go from lines with equal numbers of elements to their matrices, about the twisted state if it is to be solved.

    Raises
    ------
    InvalidSpec
        If a table of coefficients does not reach around the angle to which its section is twisted.
    """
    profile = static_profile(lines)
    sections_of_lines = sections(lines, profile)
    if static_twist is StaticTwist.NEGLECTED:
        return Discretization(tuple(lines), profile, sections_of_lines, matrices(lines, profile, sections_of_lines))
    state = twisted_state(lines, profile, sections_of_lines)
    return Discretization(tuple(lines), profile, *twisted_matrices(lines, profile, sections_of_lines, state), state)


def observation(discretization: Discretization, shapes: FloatArray, loops: int) -> FloatArray:
    """Return V, W, Theta at s = L/(2 loops), (..., m, 3), of coordinates with shapes (..., m, 3, nodes)."""
    elements = discretization.lines[0].span.elements
    scaled = elements / (2.0 * loops)
    element = min(int(scaled), elements - 1)
    values, _ = shape_functions(np.array(2.0 * (scaled - element) - 1.0))
    return np.asarray(shapes[..., 2 * element : 2 * element + 3] @ values)
