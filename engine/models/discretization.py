"""From lines to finite element matrices, the basis of both reduced models. Theory sections 2, 3 and 15.

Everything structural (matrices, eigenproblems, mode shapes) is in the axes of the plane of the sag: along, up and out
of it, which are X, Y and Z without blow-out. Wind, devices and what is reported are in X, Y and Z.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import FloatArray, IntArray, merge_axes, take_rows
from engine.mechanics.along_span import wind_factor
from engine.mechanics.coefficient_curves import cubics_about, local_curves, reach
from engine.mechanics.cross_sections import PIECE_POINTS, Sections, sections
from engine.mechanics.finite_elements import FIELDS, THETA, Matrices, matrices
from engine.mechanics.interpolation import shape_functions
from engine.mechanics.modes import DirectionalShapes, turned_shapes
from engine.mechanics.static_profile import StaticProfile, horizontal_position, static_profile
from engine.mechanics.static_twist import TwistedState, twisted_matrices, twisted_state, twisted_where_large
from engine.mechanics.torsional_elements import torsional_elements
from engine.mechanics.wind_twist import WindTwist, wind_twist
from engine.models.relative_wind import NodalMotion, local_motion_forms, turned_arms
from engine.spec import AerodynamicModel, Line, StaticTwist

BLOCK_STATES = 256  # of lines, whose matrices may stand side by side
FIT_RANGE = np.radians(20.0)  # of the cubics that stand for curves in starts


@dataclass(frozen=True, slots=True)
class Discretization:
    """Static profile, sections and matrices of a stack of lines.

    matrices: in the axes of the plane of the sag; untwisted: the sections without static twist; twist: in still air,
    None if it is neglected; wind_twist: in the wind, from the state in still air on, None if it is not followed.
    """

    lines: tuple[Line, ...]
    profile: StaticProfile
    sections: Sections
    matrices: Matrices
    untwisted: Sections
    twist: TwistedState | None = None
    wind_twist: WindTwist | None = None

    @property
    def parts(self) -> tuple[tuple[Line, ...], StaticProfile, Sections, Matrices]:
        """Lines, profile, sections and matrices."""
        return self.lines, self.profile, self.sections, self.matrices


def discretize(
    lines: Sequence[Line], static_twist: StaticTwist = StaticTwist.NEGLECTED, points: int = PIECE_POINTS
) -> Discretization:
    """Discretize lines with equal numbers of elements, about the twisted static state if that is to be solved.

    points: as for `sections`.

    Raises
    ------
    InvalidSpec
        If a table of coefficients has too few rows around the angle to which its section is twisted.
    """
    profile = static_profile(lines)
    sections_of_lines = sections(lines, profile, points)
    if static_twist is StaticTwist.SOLVED:
        state = twisted_state(lines, profile, sections_of_lines)
    else:
        system = matrices(lines, profile, sections_of_lines)
        flat = _in_plane(profile, system)
        plain = Discretization(tuple(lines), profile, sections_of_lines, flat, sections_of_lines)
        large = None if static_twist is StaticTwist.NEGLECTED else twisted_where_large(*plain.parts)
        if large is None:
            return plain
        state = large
    turned, system = twisted_matrices(lines, profile, sections_of_lines, state)
    return Discretization(tuple(lines), profile, turned, _in_plane(profile, system), sections_of_lines, state)


def fields_in_space(profile: StaticProfile, fields: FloatArray) -> FloatArray:
    """Turn fields from the axes of the plane of the sag to X, Y and Z.

    Parameters
    ----------
    profile : StaticProfile
    fields : (lines, ..., fields, nodes)
        The last ones of U, V, W and Theta. Without U its part in V and W is left out; it is zero on level spans.

    Returns
    -------
    (lines, ..., fields, nodes)
    """
    if not profile.tilt.any():
        return fields
    count = fields.shape[-2]
    turn = _frames(profile)[:, -count:, -count:].swapaxes(-1, -2)
    return np.asarray(turn.reshape(turn.shape[0], *(1,) * (fields.ndim - 3), count, count) @ fields)


def _frames(profile: StaticProfile) -> FloatArray:
    """Return the axes of the plane as rows for U, V and W, and Theta unchanged: (lines, 4, 4)."""
    frames = np.zeros((profile.tilt.size, FIELDS, FIELDS))
    frames[:, :THETA, :THETA] = profile.axes
    frames[:, THETA, THETA] = 1.0
    return frames


def _in_plane(profile: StaticProfile, system: Matrices) -> Matrices:
    """Turn the freedoms of each node from X, Y and Z to the axes of the plane of the sag."""
    if not profile.tilt.any():
        return system
    back = _frames(profile).swapaxes(-1, -2)

    def turned(matrix: FloatArray) -> FloatArray:
        for _ in range(2):  # the columns, then the rows
            by_node = matrix.reshape(matrix.shape[0], -1, FIELDS) @ back
            matrix = by_node.reshape(matrix.shape).swapaxes(-1, -2)
        return matrix

    return replace(system, stiffness=turned(system.stiffness), mass=turned(system.mass))


def blocks_of_winds(lines: int, winds: int) -> Iterator[IntArray]:
    """Yield the indices of winds in blocks, of each of which the states of all lines may stand side by side."""
    size = max(1, BLOCK_STATES // lines)
    yield from (np.arange(first, min(first + size, winds)) for first in range(0, winds, size))


def in_wind(discretization: Discretization, winds: IntArray) -> Discretization:
    """Return the discretizations about the static states at wind speeds, as `states_in_wind`. Theory section 14.

    Coefficients fixed to the section are cubics fitted to the curves there.
    """
    state = states_in_wind(discretization, winds)
    here, local = state.sections, local_curves(state.lines, state.profile, state.sections)
    cubics = cubics_about(local.curves, local.which, local.angle, FIT_RANGE)
    fitted = replace(here, aerodynamics=cubics, fitted_range=reach(local, here.local_weight > 0.0))
    return replace(state, sections=fitted)


def states_in_wind(discretization: Discretization, winds: IntArray) -> Discretization:
    """Return all lines about their static states at wind speeds (winds,), given by index, as one stack, wind-major.

    Coefficients fixed to the section stay those of the untwisted one: only curves hold here.
    """
    found = discretization.wind_twist
    assert found is not None, "the twist in the wind was followed before"
    line = np.tile(np.arange(len(discretization.lines)), winds.size)
    displacement = np.zeros(discretization.matrices.stiffness.shape[:2])[line]
    if discretization.twist is not None:
        displacement += np.nan_to_num(discretization.twist.displacement)[line]
    displacement[:, THETA::FIELDS] += merge_axes(np.nan_to_num(found.angle[:, winds]).swapaxes(0, 1), -3, -2)
    lines, profile = discretization.lines * winds.size, take_rows(discretization.profile, line)
    untwisted = take_rows(discretization.untwisted, line)
    state = TwistedState(displacement, found.outcome[:, winds].T.ravel())
    here, system = twisted_matrices(lines, profile, untwisted, state, fit=False)
    return Discretization(lines, profile, here, _in_plane(profile, system), untwisted, state)


def shapes_in_wind(states: Discretization, still: DirectionalShapes) -> DirectionalShapes:
    """Return the shapes about the states of `states_in_wind`, given those of the same lines in still air."""
    line = np.resize(np.arange(still.nodal.shape[0]), len(states.lines))
    modes = tuple(take_rows(each, line) for each in still.modes)
    repeated = DirectionalShapes(still.loops, still.nodal[line], still.angular_frequency[line], modes)
    return turned_shapes(repeated, states.matrices, states.profile.arc_length)


def with_wind_twist(discretization: Discretization, wind_speeds: FloatArray, *, further: bool = True) -> Discretization:
    """Add the static twist at rising wind speeds (winds,) [m/s] of lines whose tables are curves. Theory section 14.

    further: whether further equilibria are searched, besides the one that a rising wind finds.
    """
    twist = discretization.twist
    still = np.zeros((len(discretization.lines), 2 * discretization.lines[0].span.elements + 1))
    elements = torsional_elements(*discretization.parts, still if twist is None else np.nan_to_num(twist.angle))
    asked = np.array([line.has_table and not any(line.curve_faults()) for line in discretization.lines])
    return replace(discretization, wind_twist=wind_twist(elements, wind_speeds, asked, further=further))


def nodal_motion(
    discretization: Discretization, line: IntArray, shapes: FloatArray, model: AerodynamicModel
) -> NodalMotion:
    """Return the local motion at the nodes of a stack of models.

    The nodes, unlike the quadrature points, stay where they are however the ice is divided into pieces.

    Parameters
    ----------
    discretization : Discretization
    line : (members,)
        Index of the line of each model.
    shapes : (members, m, 3, nodes)
        V, W and Theta of each generalized coordinate.
    model : AerodynamicModel
    """
    lines, profile, nodes = discretization.lines, discretization.profile, shapes.shape[-1]
    arc = profile.arc_length[:, None] * np.linspace(0.0, 1.0, nodes)
    positions = horizontal_position(profile, arc)
    factor = np.stack([wind_factor(*of_line) for of_line in zip(lines, positions, strict=True)])
    diameter = np.array([of_line.conductor.diameter for of_line in lines])
    twist = np.zeros((len(lines), 1)) if discretization.twist is None else np.nan_to_num(discretization.twist.angle)
    return NodalMotion(
        forms=local_motion_forms(shapes[:, None], np.ones((1, 1, 1)), factor[line, None])[:, 0],
        arms=turned_arms(lines, twist)[line],
        diameter=diameter[line],
        model=model,
    )


def shapes_at(shapes: FloatArray, share: FloatArray) -> FloatArray:
    """Return fields with evenly spaced nodes of quadratic elements (stack, ..., nodes) at one place each: (stack, ...).

    share: (stack,), the arc length from the left support over that of the span; 1/(2 k) at the first of k antinodes.
    """
    elements, every = (shapes.shape[-1] - 1) // 2, np.arange(share.size)
    element = np.minimum((share * elements).astype(np.intp), elements - 1)
    values, _ = shape_functions(2.0 * (share * elements - element) - 1.0)
    first, second, third = (
        shapes[every, ..., 2 * element + node] * values[:, node].reshape(-1, *(1,) * (shapes.ndim - 2))
        for node in range(3)
    )
    return np.asarray(first + second + third)
