"""Static twist: the angle at which torsional stiffness balances the weight of eccentric ice and pendulums.

The section may turn by any angle: sub-conductor i stands at (eta_i, zeta_i), which is (y_i, z_i) rotated by Theta, so
V_i' = V' - zeta_i Theta' and W_i' = W' + eta_i Theta'. The energy is that of theory section 3 with rotated positions,

    Pi = 1/2 int g^T D(Theta) g ds + end springs + n int m g (e_y cos Theta - e_z sin Theta) ds + energy of devices,

g = (U', V', W', Theta'). The weight at the bare centres does no net work: the tension of the catenary cancels it, since
(T y')' = m g. In D, T (V_i'^2 + W_i'^2) becomes T r_i^2 Theta'^2 at any twist. At zero twist the second
derivative is K of section 3 with its gravity term -n m g e_y; as there, the strain is the linear part of (7). Free
sections add what `free_sections` says to Pi.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, ObjectArray, filled, take_rows
from engine.mechanics.cross_sections import Sections, turned, turned_moments, turned_sums
from engine.mechanics.finite_elements import (
    FIELDS,
    THETA,
    Matrices,
    add_end_springs,
    assemble,
    elastic_density,
    held_freedoms,
    mass_matrix,
    mass_points,
    mounted,
)
from engine.mechanics.free_sections import Differences, differences
from engine.mechanics.interpolation import strain_points
from engine.mechanics.static_profile import StaticProfile
from engine.numerics.newton import NewtonOptions, downhill, newton, solve_systems
from engine.spec import GRAVITY, Line

FIRST_GUESS = 0.1  # rad at mid-span
LARGE_TWIST = math.radians(5.0)  # a smaller one may be neglected
OPTIONS = NewtonOptions(tolerance=1e-9, largest_step=0.25, iterations=100)


@dataclass(frozen=True, slots=True)
class TwistedState:
    """Static state of a stack of lines under eccentric weight: a minimum of the energy Pi.

    displacement: (lines, freedoms), U, V, W [m] and Theta [rad] of each node, NaN where none was found; outcome:
    (lines,) of Outcome, or None where the twist of a line is neglected.
    """

    displacement: FloatArray
    outcome: ObjectArray

    @property
    def angle(self) -> FloatArray:
        """The twist of each node, (lines, nodes) [rad]."""
        return self.displacement[:, THETA::FIELDS]


def twisted_state(lines: Sequence[Line], profile: StaticProfile, section_points: Sections) -> TwistedState:
    """Find the twisted static state of each line, a minimum of Pi, by Newton's method with descent steps.

    Where the tangent has negative eigenvalues, their absolute values are used, so every step reduces Pi to first order.
    The search starts on the side to which the weight turns the untwisted section.

    Parameters
    ----------
    lines : sequence of Line
        All with the same number of elements.
    profile : StaticProfile
        Of the same lines.
    section_points : Sections
        Of the same lines, without twist.

    Returns
    -------
    TwistedState
    """
    nodes = 2 * lines[0].span.elements + 1
    held = held_freedoms(profile, FIELDS * nodes)
    start = np.zeros((len(lines), FIELDS * nodes))
    gradient, _ = energy_derivatives(lines, profile, section_points, start)
    side = np.where(gradient[:, THETA::FIELDS].sum(axis=1) > 0.0, -1.0, 1.0)
    start[:, THETA::FIELDS] = FIRST_GUESS * side[:, None] * np.sin(np.pi * np.linspace(0.0, 1.0, nodes))

    def system(x: FloatArray, active: IntArray) -> tuple[FloatArray, FloatArray]:
        few = [lines[i] for i in active]
        gradient, tangent = energy_derivatives(few, take_rows(profile, active), take_rows(section_points, active), x)
        return np.where(held[active], 0.0, gradient), downhill(_held(tangent, held[active]))

    solution = newton(system, np.where(held, 0.0, start), np.ones_like(start), OPTIONS)
    displacement = np.where(solution.converged[:, None], np.where(held, 0.0, solution.x), np.nan)
    return TwistedState(displacement, solution.outcome)


def twisted_matrices(
    lines: Sequence[Line],
    profile: StaticProfile,
    section_points: Sections,
    state: TwistedState,
    *,
    fit: bool = True,
) -> tuple[Sections, Matrices]:
    """Linearize about the twisted state; return the twisted sections and the matrices there.

    A line whose state was not found keeps its untwisted sections and matrices. fit: whether tables of coefficients are
    fitted at the local angle.

    Raises
    ------
    InvalidSpec
        If a table of coefficients has too few rows around the local angle.
    """
    displacement = np.nan_to_num(state.displacement)
    angle = displacement[:, THETA::FIELDS]
    interpolation, weight = mass_points(lines, profile, section_points)
    twist = at_mass_points(interpolation, angle)
    here = turned(lines, profile, section_points, twist) if fit else turned_moments(section_points, twist)
    apart = differences(lines, profile, angle)
    _, stiffness = energy_derivatives(lines, profile, section_points, displacement, apart)
    mass = mass_matrix(lines, profile, here, apart, angle)
    return here, Matrices(stiffness, mass, held_freedoms(profile, mass.shape[-1]), interpolation, weight)


def linear_twist(
    lines: Sequence[Line], profile: StaticProfile, section_points: Sections, matrices: Matrices
) -> FloatArray:
    """Return the largest twist that eccentric weight would cause at the untwisted line's stiffness: (lines,) [rad].

    It is infinite where that stiffness is not positive definite. Beyond some ten degrees it is too large, because the
    weight pulls less and less sideways.
    """
    nodes = matrices.stiffness.shape[-1] // FIELDS
    load, values = _ice_load(lines, profile, section_points, np.zeros((len(lines), nodes)))
    gradient = _ice_moment(load, values)
    for line, here, values, device in mounted(lines, profile):
        gradient[line, here] -= np.kron(values, device.load())
    moment = -gradient[:, THETA::FIELDS][:, 1:-1]
    stiffness = matrices.stiffness[:, THETA::FIELDS, THETA::FIELDS][:, 1:-1, 1:-1]
    unstable = np.linalg.eigvalsh(stiffness)[:, 0] <= 0.0
    return np.where(unstable, np.inf, np.abs(solve_systems(stiffness, moment)).max(axis=-1))


def twisted_where_large(
    lines: Sequence[Line], profile: StaticProfile, section_points: Sections, matrices: Matrices
) -> TwistedState | None:
    """Find the twisted static state of the lines that eccentric weight turns by more than `LARGE_TWIST`.

    Returns
    -------
    TwistedState or None
        With no displacement and None as outcome for all other lines; None if there are only such lines.
    """
    large = np.flatnonzero(linear_twist(lines, profile, section_points, matrices) > LARGE_TWIST)
    if not large.size:
        return None
    found = twisted_state(
        [lines[i] for i in large.tolist()], take_rows(profile, large), take_rows(section_points, large)
    )
    displacement, outcome = np.zeros(matrices.stiffness.shape[:2]), filled(len(lines), None)
    displacement[large], outcome[large] = found.displacement, found.outcome
    return TwistedState(displacement, outcome)


def energy_derivatives(
    lines: Sequence[Line],
    profile: StaticProfile,
    section_points: Sections,
    displacement: FloatArray,
    apart: Differences | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Return the first and second derivatives of the energy Pi by the displacements.

    Parameters
    ----------
    lines : sequence of Line
        All with the same number of elements.
    profile : StaticProfile
    section_points : Sections
        Without twist.
    displacement : (lines, freedoms)
        U, V, W [m] and Theta [rad] of each node.
    apart : Differences, optional
        Of the sub-conductors at this twist, where they are known.

    Returns
    -------
    gradient : (lines, freedoms)
        [N, N m].
    tangent : (lines, freedoms, freedoms)
        [N/m, N, N m].
    """
    springs = np.zeros((*displacement.shape, displacement.shape[-1]))
    add_end_springs(lines, profile, springs)
    force, stiffness = _strain_energy(lines, profile, displacement)
    moment, gravity = _ice_energy(lines, profile, section_points, displacement[:, THETA::FIELDS])
    gradient = (springs @ displacement[..., None])[..., 0] + force + moment
    tangent = springs + stiffness + gravity
    if apart is None:
        apart = differences(lines, profile, displacement[:, THETA::FIELDS])
    gradient[:, THETA::FIELDS] += apart.gradient
    tangent[:, THETA::FIELDS, THETA::FIELDS] += apart.tangent
    for line, here, values, device in mounted(lines, profile):
        turn = float(values @ displacement[line, here][THETA::FIELDS])
        gradient[line, here] -= np.kron(values, device.load(turn))
        tangent[line, here, here] += np.kron(np.outer(values, values), device.stiffness(turn))
    return gradient, tangent


def _strain_energy(
    lines: Sequence[Line], profile: StaticProfile, displacement: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Differentiate 1/2 int g^T D(Theta) g ds, with D' and D'' from the derivatives of the turned sums."""
    at = strain_points(lines, profile)
    elements, points = at.weight.shape[1:]
    reader = np.zeros((len(lines), elements, points, FIELDS + 1, 3, FIELDS))
    for field in range(FIELDS):
        reader[..., field, :, field] = at.slopes
    reader[..., FIELDS, :, THETA] = at.values
    reader = reader.reshape(*reader.shape[:-2], 3 * FIELDS)
    read = (reader @ _by_element(displacement, FIELDS)[:, :, None, :, None])[..., 0]
    strain, angle = read[..., :FIELDS], read[..., FIELDS]
    sums = turned_sums(lines, angle)
    first, second = _slope(sums), _slope(_slope(sums))
    stress, turning, bending = (
        (elastic_density(lines, at, s) @ strain[..., None])[..., 0] for s in (sums, first, second)
    )
    force = np.concatenate([stress, 0.5 * (strain * turning).sum(axis=-1, keepdims=True)], axis=-1)
    density = np.zeros((*angle.shape, FIELDS + 1, FIELDS + 1))
    density[..., :FIELDS, :FIELDS] = elastic_density(lines, at, sums)
    density[..., :FIELDS, FIELDS] = density[..., FIELDS, :FIELDS] = turning
    density[..., FIELDS, FIELDS] = 0.5 * (strain * bending).sum(axis=-1)
    weighted = at.weight[..., None, None] * reader
    gradient = (force[..., None, :] @ weighted)[..., 0, :].sum(axis=2)
    tangent = (reader.swapaxes(-1, -2) @ density @ weighted).sum(axis=2)
    return _assembled_vector(gradient), assemble(tangent)


def _slope(sums: FloatArray) -> FloatArray:
    """Differentiate `turned_sums` by the angle; the map is linear, so it differentiates their derivatives too."""
    _, s_y, s_z, s_yy, s_zz, s_yz = sums
    return np.stack([np.zeros_like(s_y), -s_z, s_y, -2.0 * s_yz, 2.0 * s_yz, s_yy - s_zz])


def _ice_energy(
    lines: Sequence[Line], profile: StaticProfile, section_points: Sections, angle: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Differentiate n int m g (e_y cos Theta - e_z sin Theta) ds."""
    load, values = _ice_load(lines, profile, section_points, angle)
    tangent = (values * load[..., :1]).swapaxes(-1, -2) @ values
    return _ice_moment(load, values), assemble(tangent)


def _ice_moment(load: FloatArray, values: FloatArray) -> FloatArray:
    """Return the first derivatives of the energy of `_ice_load`: (lines, freedoms)."""
    return _assembled_vector((load[..., 1, None] * values).sum(axis=2))


def _ice_load(
    lines: Sequence[Line], profile: StaticProfile, section_points: Sections, angle: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return -n m g (e_y, e_z) ds turned by Theta and the values of Theta by the element's freedoms at the points.

    Shapes (lines, elements, points, 2) and (lines, elements, points, 12).
    """
    interpolation, weight = mass_points(lines, profile, section_points)
    moment = turned_moments(section_points, at_mass_points(interpolation, angle)).first_moment
    count = np.array([len(line.bundle.positions) for line in lines])[:, None, None]
    values = interpolation[..., None] * np.eye(FIELDS)[THETA]
    return -GRAVITY * (count * weight)[..., None] * moment, values.reshape(*values.shape[:-2], 3 * FIELDS)


def at_mass_points(interpolation: FloatArray, nodal: FloatArray) -> FloatArray:
    """Interpolate nodal values (lines, nodes) to the points of the sections: (lines, elements, points)."""
    return np.asarray((interpolation @ _by_element(nodal, 1)[..., None])[..., 0])


def _by_element(values: FloatArray, fields_a_node: int) -> FloatArray:
    """Gather values (lines, freedoms) by element: (lines, elements, freedoms of 3 nodes)."""
    elements = (values.shape[1] // fields_a_node - 1) // 2
    first = 2 * fields_a_node * np.arange(elements)[:, None]
    return np.asarray(values[:, first + np.arange(3 * fields_a_node)])


def _assembled_vector(element: FloatArray) -> FloatArray:
    """Add element vectors (lines, elements, 12) to (lines, freedoms)."""
    lines, elements, size = element.shape
    total = np.zeros((lines, FIELDS * (2 * elements + 1)))
    for e in range(elements):
        total[:, 2 * FIELDS * e : 2 * FIELDS * e + size] += element[:, e]
    return total


def _held(tangent: FloatArray, held: BoolArray) -> FloatArray:
    """Decouple held freedoms and give each a stiffness of one."""
    free = ~held
    return np.asarray(tangent * (free[:, :, None] & free[:, None, :]) + held[:, :, None] * np.eye(held.shape[1]))
