"""Reduced models of lines, and their equations of motion in the fastest plain numpy form, for the measurements."""

from collections.abc import Callable, Sequence

import numpy as np

from engine.arrays import FloatArray
from engine.mechanics.cross_sections import sections
from engine.mechanics.finite_elements import matrices
from engine.mechanics.modes import directional_shapes
from engine.mechanics.static_profile import static_profile
from engine.models.discretization import Discretization, shapes_at
from engine.models.hybrid import hybrid_model, with_published_load
from engine.models.reduced_model import ReducedModel, take
from engine.numerics import polynomial
from engine.spec import Analysis, Line

Rate = Callable[[float, FloatArray], FloatArray]


def discretized(lines: Sequence[Line]) -> Discretization:
    """Return the discretization from which the reduced models of lines are built."""
    profile = static_profile(lines)
    sections_of_lines = sections(lines, profile)
    system = matrices(lines, profile, sections_of_lines)
    return Discretization(tuple(lines), profile, sections_of_lines, system, sections_of_lines)


def hybrid_models(
    discretization: Discretization, loops: tuple[int, ...], analysis: Analysis | None = None
) -> tuple[ReducedModel, ReducedModel]:
    """Return the hybrid models (lines x loops,), line-major, with an analysis' load and with the published one."""
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, tuple(sorted({1, *loops})))
    grid = hybrid_model(discretization, shapes, loops, analysis or Analysis(loops=loops))
    index = np.divmod(np.arange(len(discretization.lines) * len(loops)), len(loops))
    return take(grid, index), take(with_published_load(discretization, grid), index)


def first_antinode(shapes: FloatArray, loops: int) -> FloatArray:
    """Return V, W and Theta of shapes (stack, m, 3, nodes) where the source observes motions, s = L/(2 loops)."""
    return shapes_at(shapes, np.full(len(shapes), 1.0 / (2.0 * loops)))


def plain_rate(model: ReducedModel, wind_speed: float) -> Rate:
    """Return the right side of the first-order equations of one hybrid model, with as few numpy calls as possible."""
    m = model.mass.shape[-1]
    inverse = np.linalg.inv(model.mass)
    linear = np.block([[np.zeros((m, m)), np.eye(m)], [-inverse @ model.stiffness, -inverse @ model.damping]])
    active = np.flatnonzero(model.load.forms[0].any(axis=0))
    scale = np.where(active < m, 1.0, 1.0 / wind_speed)
    cubic = wind_speed**2 * inverse @ model.load.table[0]
    order = [int(np.flatnonzero(row)[0]) for row in model.load.forms[0]]
    back = np.searchsorted(active, order)
    index, scale = active[back], scale[back]

    def rate(_: float, y: FloatArray) -> FloatArray:
        result = linear @ y
        result[m:] += cubic @ polynomial.powers(y[index] * scale)
        return result

    return rate
