"""Torsional finite elements of a line in the wind, and the energy of their twist. Theory section 14.

The twist Theta_0(s) counts from the state in still air. In equilibrium

    K_tt Theta_0 = U^2 m_wind(Theta_0) + m_weight(Theta_0),

with the moment 1/2 rho d phi^2 (n d C_M + C_D sum y_i - C_L sum z_i) ds of the wind, positions turned with the section,
and what the weight of ice and pendulums adds to its linear part, which K_tt holds. Each moment depends on the twist of
its own section only, so equilibria are the stationary points of an energy, and the stable ones its minima.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.mechanics.coefficient_curves import (
    DRAG,
    LIFT,
    MOMENT,
    LocalCurves,
    evaluate,
    largest_moment_slopes,
    local_curves,
)
from engine.mechanics.cross_sections import Sections, turned_sums
from engine.mechanics.finite_elements import FIELDS, THETA, Matrices, mounted
from engine.mechanics.static_profile import StaticProfile
from engine.mechanics.static_twist import at_mass_points
from engine.spec import GRAVITY, Line, PointDevice

CENTRED = 1e-9  # of n d: the sums of y_i and z_i of a bundle about its centroid, which turns without lift and drag


@dataclass(frozen=True, slots=True)
class TorsionalElements:
    """Torsional finite elements of a stack of lines in the wind, about their state in still air.

    stiffness: (lines, nodes, nodes), K_tt of the twist of the nodes; the first and the last are held. values:
    (lines, elements, points, 3), shape functions at the quadrature points; pressure: (lines, elements, points),
    1/2 rho d phi^2 ds [kg/m]; chord: (lines,), n d [m]; arms: (lines, elements, points, 2), sums of y_i and z_i [m];
    weight: (lines, elements, points, 2), n m g (e_y, e_z) ds [N m]; curves: the coefficients at the points; devices:
    line, first node, shape functions (3,) and static twist [rad] of each point device.
    """

    stiffness: FloatArray
    values: FloatArray
    pressure: FloatArray
    chord: FloatArray
    arms: FloatArray
    weight: FloatArray
    curves: LocalCurves
    devices: tuple[tuple[int, int, FloatArray, float, PointDevice], ...]


def torsional_elements(
    lines: Sequence[Line], profile: StaticProfile, section_points: Sections, matrices: Matrices, twist: FloatArray
) -> TorsionalElements:
    """Return the torsional elements of lines about their state in still air.

    Parameters
    ----------
    lines : sequence of Line
        All with the same number of elements.
    profile : StaticProfile
    section_points : Sections
        Turned by the static twist in still air, if that was solved for.
    matrices : Matrices
        About the same state.
    twist : (lines, nodes)
        Static twist in still air [rad].

    Returns
    -------
    TorsionalElements
    """
    count = np.array([len(line.bundle.positions) for line in lines], dtype=np.float64)
    diameter, density = (
        np.array(column) for column in zip(*((x.conductor.diameter, x.wind.air_density) for x in lines), strict=True)
    )
    pressure = (0.5 * density * diameter)[:, None, None] * section_points.wind_factor**2 * matrices.weight
    _, s_y, s_z, *_ = turned_sums(lines, section_points.twist)
    weight = GRAVITY * (count[:, None, None] * matrices.weight)[..., None] * section_points.first_moment
    devices = tuple(
        (line, here.start // FIELDS, values, float(values @ twist[line, here.start // FIELDS :][:3]), device)
        for line, here, values, device in mounted(lines, profile)
    )
    return TorsionalElements(
        stiffness=matrices.stiffness[:, THETA::FIELDS, THETA::FIELDS],
        values=matrices.interpolation,
        pressure=pressure,
        chord=count * diameter,
        arms=np.stack([s_y, s_z], axis=-1),
        weight=weight,
        curves=local_curves(lines, profile, section_points),
        devices=devices,
    )


def energy_derivatives(
    elements: TorsionalElements, line: IntArray, wind_speed: FloatArray, angle: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return first and second derivatives of the energy by the twist of the nodes (k, nodes): (k, nodes) and square."""
    values = elements.values[line]
    theta = at_mass_points(values, angle)
    moment, slope = _moment(elements, line, theta)
    square = wind_speed[:, None, None] ** 2
    weight_y, weight_z = np.moveaxis(elements.weight[line], -1, 0)
    c, s = np.cos(theta), np.sin(theta)
    total = square * moment + weight_y * (s - theta) + weight_z * (c - 1.0)
    turning = square * slope + weight_y * (c - 1.0) - weight_z * s
    stiffness = elements.stiffness[line].copy()
    gradient = (stiffness @ angle[..., None])[..., 0]
    element = (total[..., None, :] @ values)[..., 0, :]
    for e in range(values.shape[1]):
        gradient[:, 2 * e : 2 * e + 3] -= element[:, e]
    _subtract_from_nodes(stiffness, turning, values)
    _add_devices(elements, line, angle, (gradient, stiffness))
    return gradient, stiffness


def _moment(elements: TorsionalElements, line: IntArray, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the moment of the wind over U^2 at the points of lines (k,) and its slope by the twist there."""
    local = elements.curves
    values, slopes = evaluate(local.curves, local.which[line], local.angle[line] + theta)
    s_y, s_z = np.moveaxis(elements.arms[line], -1, 0)
    c, s = np.cos(theta), np.sin(theta)
    y, z = c * s_y - s * s_z, s * s_y + c * s_z
    chord, pressure = elements.chord[line, None, None], elements.pressure[line]
    moment = chord * values[..., MOMENT] + y * values[..., DRAG] - z * values[..., LIFT]
    slope = chord * slopes[..., MOMENT] + y * slopes[..., DRAG] - z * slopes[..., LIFT]
    return pressure * moment, pressure * (slope - z * values[..., DRAG] - y * values[..., LIFT])


def _add_devices(
    elements: TorsionalElements, line: IntArray, angle: FloatArray, totals: tuple[FloatArray, FloatArray]
) -> None:
    """Add what the weight of devices does beyond its linear part to gradient and tangent, in place."""
    gradient, tangent = totals
    for owner, first, values, still, device in elements.devices:
        here = np.s_[first : first + 3]
        for k in np.flatnonzero(line == owner).tolist():
            turn = float(values @ angle[k, here])
            linear = device.stiffness(still)[THETA][THETA]
            beyond = device.load(still + turn)[THETA] - device.load(still)[THETA] + linear * turn
            gradient[k, here] -= beyond * values
            tangent[k, here, here] += (device.stiffness(still + turn)[THETA][THETA] - linear) * np.outer(values, values)


def is_convex(elements: TorsionalElements, wind_speed: float) -> BoolArray:
    """Return the lines (lines,) whose energy is surely convex: bounds of every slope leave K_tt positive definite."""
    steepest = largest_moment_slopes(elements.curves.curves)[elements.curves.which]
    off_centre = np.abs(elements.arms).max(axis=-1) > CENTRED * elements.chord[:, None, None]
    unbounded = (elements.pressure > 0.0) & (off_centre | np.isinf(steepest))
    slope = elements.pressure * np.where(np.isinf(steepest), 0.0, steepest)
    bound = wind_speed**2 * elements.chord[:, None, None] * slope
    bound += np.sqrt((elements.weight**2).sum(axis=-1)) - elements.weight[..., 0]
    stiffness = elements.stiffness.copy()
    _subtract_from_nodes(stiffness, bound, elements.values)
    hung = [owner for owner, *_, device in elements.devices if device.load(1.0)[THETA]]
    surely = ~unbounded.any(axis=(1, 2)) & ~np.isin(np.arange(stiffness.shape[0]), hung)
    return np.asarray(surely & (np.linalg.eigvalsh(stiffness[:, 1:-1, 1:-1])[:, 0] > 0.0))


def _subtract_from_nodes(stiffness: FloatArray, density: FloatArray, values: FloatArray) -> None:
    """Subtract a density (k, elements, points) over shape functions from (k, nodes, nodes), in place."""
    by_element = (values * density[..., None]).swapaxes(-1, -2) @ values
    for e in range(values.shape[1]):
        here = np.s_[2 * e : 2 * e + 3]
        stiffness[:, here, here] -= by_element[:, e]
