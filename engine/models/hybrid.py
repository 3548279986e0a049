"""The hybrid model: one finite element mode shape per direction.

Theory section 4; paper eqs. (10)-(20) and (A1)-(A9).
"""

from dataclasses import replace

import numpy as np

from engine.arrays import FloatArray
from engine.mechanics.finite_elements import FIELDS, Matrices, device_damping
from engine.mechanics.modes import DirectionalShapes, at_points
from engine.models.aerodynamic_load import (
    PolynomialLoad,
    integrate_along_span,
    integrate_each,
    published_load,
    span_load,
    take_load,
)
from engine.models.discretization import Discretization, fields_in_space
from engine.models.reduced_model import ReducedModel, damping_ratios, diagonal_matrices, diagonals
from engine.spec import AerodynamicModel, Analysis, Closure, DampingModel, LongitudinalInertia


def hybrid_model(
    discretization: Discretization, shapes: DirectionalShapes, loops: tuple[int, ...], analysis: Analysis
) -> ReducedModel:
    """Return the model reduced to one mode per direction, with leading axes (lines, loops).

    Parameters
    ----------
    discretization : Discretization
    shapes : DirectionalShapes
        Of these loops and of one loop at least.
    loops : tuple of int
    analysis : Analysis
        Its closure, aerodynamic model and longitudinal inertia are used.

    Returns
    -------
    ReducedModel
    """
    mass, stiffness = _condensed(discretization.matrices, shapes.nodal[:, :, :, None], analysis.longitudinal_inertia)
    squares = diagonals(stiffness) / diagonals(mass)
    selected = [shapes.loops.index(k) for k in loops]
    mass, stiffness = mass[:, selected], stiffness[:, selected]
    constant = np.array([line.damping.model is DampingModel.CONSTANT_COEFFICIENT for line in discretization.lines])
    square = np.where(constant[:, None, None], squares[:, [shapes.loops.index(1)]], squares[:, selected])
    rate = 2.0 * damping_ratios(discretization.lines)[:, None] * np.sqrt(np.maximum(square, 0.0))
    unstable = np.asarray((square <= 0.0).any(axis=-1) | (np.linalg.eigvalsh(stiffness)[..., 0] <= 0.0))
    nodal = fields_in_space(discretization.profile, _diagonal_fields(shapes.nodal[:, selected, 1:]))
    damping = diagonal_matrices(rate * diagonals(mass))  # (11)
    damping += device_damping(discretization.lines, discretization.profile, nodal)
    load = _hybrid_load(discretization, nodal, analysis)
    return ReducedModel(mass, damping, stiffness, load, nodal, np.arange(3), unstable)


def joint_model(
    discretization: Discretization, shapes: DirectionalShapes, loops: tuple[int, ...], analysis: Analysis
) -> ReducedModel:
    """Return the model in which the hybrid shapes of several loops move together, with the exact load.

    Parameters are those of `hybrid_model`; leading axis (lines,). The coordinates are f_v of each number of loops,
    then f_w, then f_theta; each has the structural damping of its own hybrid model.
    """
    alone = hybrid_model(discretization, shapes, loops, analysis)
    selected = [shapes.loops.index(k) for k in loops]
    together = np.moveaxis(shapes.nodal[:, selected], 1, 2)[:, None]
    mass, stiffness = (
        matrix[:, 0] for matrix in _condensed(discretization.matrices, together, analysis.longitudinal_inertia)
    )
    nodal = np.moveaxis(alone.shapes, 1, 2).reshape(len(discretization.lines), -1, *alone.shapes.shape[-2:])
    own = diagonals(alone.damping).swapaxes(-1, -2).reshape(len(discretization.lines), -1)  # with that of devices
    coupled = device_damping(discretization.lines, discretization.profile, nodal)
    values = at_points(discretization.matrices, nodal)
    load = span_load(
        discretization.lines,
        discretization.sections,
        discretization.matrices.weight,
        values[:, None],
        analysis.aerodynamic_model,
    )
    return ReducedModel(
        mass=mass,
        damping=diagonal_matrices(own - diagonals(coupled)) + coupled,
        stiffness=stiffness,
        load=take_load(load, (slice(None), 0)),
        shapes=nodal,
        direction=np.repeat(np.arange(3), len(loops)),
        statically_unstable=np.asarray(
            alone.statically_unstable.any(axis=1) | (np.linalg.eigvalsh(stiffness)[:, 0] <= 0.0)
        ),
    )


def with_published_load(discretization: Discretization, model: ReducedModel) -> ReducedModel:
    """Return the hybrid model with the load of the published closure, which section 7.1's formula needs."""
    values = at_points(discretization.matrices, model.shapes)
    load = published_load(
        discretization.lines,
        discretization.sections,
        discretization.matrices.weight,
        values,
        discretization.profile.arc_length,
    )
    return replace(model, load=load)


def _condensed(system: Matrices, nodal: FloatArray, inertia: LongitudinalInertia) -> tuple[FloatArray, FloatArray]:
    """Project onto f_u, f_v, f_w, f_theta and condense f_u, eqs. (18)-(20).

    nodal: (lines, groups, 4, k, nodes), k shapes per direction that move together; returns M and K
    (lines, groups, 3 k, 3 k).
    """
    lines, groups, _, k, nodes = nodal.shape
    spread = nodal[..., None] * np.eye(FIELDS)[:, None, None, :]
    basis = spread.reshape(lines, groups, FIELDS * k, nodes * FIELDS)
    stiffness = basis @ system.stiffness[:, None] @ basis.swapaxes(-1, -2)
    mass = basis @ system.mass[:, None] @ basis.swapaxes(-1, -2)
    follow = -np.linalg.solve(stiffness[..., :k, :k], stiffness[..., :k, k:])
    condensed = stiffness[..., k:, k:] + stiffness[..., k:, :k] @ follow
    reduced = mass[..., k:, k:]
    if inertia is LongitudinalInertia.CONDENSED:
        reduced = reduced + follow.swapaxes(-1, -2) @ mass[..., :k, :k] @ follow
    return reduced, condensed


def _hybrid_load(discretization: Discretization, nodal: FloatArray, analysis: Analysis) -> PolynomialLoad:
    values = at_points(discretization.matrices, nodal)
    if analysis.closure is Closure.PUBLISHED:
        return published_load(
            discretization.lines,
            discretization.sections,
            discretization.matrices.weight,
            values,
            discretization.profile.arc_length,
        )
    load = span_load(
        discretization.lines,
        discretization.sections,
        discretization.matrices.weight,
        values,
        analysis.aerodynamic_model,
    )
    q_theta, (v_rate, w_rate, theta_rate) = 2, range(nodal.shape[2], nodal.shape[2] + 3)
    active = (q_theta, v_rate, w_rate, theta_rate)
    if discretization.profile.tilt.any():  # both rates make each velocity
        return integrate_along_span(load, active)
    if analysis.aerodynamic_model is AerodynamicModel.PUBLISHED:
        return integrate_along_span(load, (q_theta, theta_rate, v_rate))
    return integrate_each(load, active)


def _diagonal_fields(shapes: FloatArray) -> FloatArray:
    """Return V, W, Theta of the coordinates with shapes f_v, f_w, f_theta (..., 3, nodes): (..., 3, 3, nodes)."""
    return shapes[..., None, :] * np.eye(3)[..., None]
