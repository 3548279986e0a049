"""Reduced models: the hybrid one with one mode a direction, and the finite element one with several.

Theory sections 4 and 7.4; paper eqs. (10)-(20) and (A1)-(A9).
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from engine.aerodynamics import PolynomialLoad, integrated, published_load, span_load
from engine.arrays import BoolArray, FloatArray, IntArray
from engine.fem import FIELDS, THETA, Matrices, U, V, W, matrices, shape_functions
from engine.modes import DirectionalShapes, FullModes, at_points
from engine.profile import StaticProfile, static_profile
from engine.sections import Sections, sections
from engine.spec import AerodynamicModel, Analysis, Closure, DampingModel, Line, LongitudinalInertia, StaticTwist
from engine.twist import TwistedState, twisted_matrices, twisted_state

TRANSVERSE = (V, W, THETA)


@dataclass(frozen=True, slots=True)
class ReducedModel:
    """M q'' + C q' + K q = U^2 f(q, q'/U) for a stack of models with m generalized co-ordinates.

    mass, damping, stiffness: (..., m, m); load: f, of the same leading axes; shapes: (..., m, 3, nodes), the fields V,
    W, Theta of each co-ordinate; direction: (m,), the direction of each co-ordinate (0 vertical, 1 horizontal,
    2 torsional); statically_unstable: (...), True where the stiffness is not positive: damping there has no meaning.
    """

    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    load: PolynomialLoad
    shapes: FloatArray
    direction: IntArray
    statically_unstable: BoolArray


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
    made_of = sections(lines, profile)
    if static_twist is StaticTwist.NEGLECTED:
        return Discretization(tuple(lines), profile, made_of, matrices(lines, profile, made_of))
    state = twisted_state(lines, profile, made_of)
    return Discretization(tuple(lines), profile, *twisted_matrices(lines, profile, made_of, state), state)


def hybrid_model(
    made: Discretization, shapes: DirectionalShapes, loops: tuple[int, ...], analysis: Analysis
) -> ReducedModel:
    """Reduce to one mode a direction; leading axes (lines, loops).

    Parameters
    ----------
    made : Discretization
    shapes : DirectionalShapes
        Of at least these loops and of one loop.
    loops : tuple of int
    analysis : Analysis
        Its closure, aerodynamic model and longitudinal inertia.

    Returns
    -------
    ReducedModel
    """
    mass, stiffness = _condensed(made.matrices, shapes.nodal[:, :, :, None], analysis.longitudinal_inertia)
    one_loop = np.diagonal(stiffness, axis1=-2, axis2=-1)[:, shapes.loops.index(1)]
    one_loop = one_loop / np.diagonal(mass, axis1=-2, axis2=-1)[:, shapes.loops.index(1)]
    picked = [shapes.loops.index(k) for k in loops]
    mass, stiffness = mass[:, picked], stiffness[:, picked]
    own = np.diagonal(stiffness, axis1=-2, axis2=-1) / np.diagonal(mass, axis1=-2, axis2=-1)
    constant = np.array([line.damping.model is DampingModel.CONSTANT_COEFFICIENT for line in made.lines])
    square = np.where(constant[:, None, None], one_loop[:, None], own)
    rate = 2.0 * _ratios(made.lines)[:, None] * np.sqrt(np.maximum(square, 0.0))
    damping = _diagonal(rate * np.diagonal(mass, axis1=-2, axis2=-1))  # (11)
    unstable = np.asarray((square <= 0.0).any(axis=-1) | (np.linalg.eigvalsh(stiffness)[..., 0] <= 0.0))
    nodal = _diagonal_fields(shapes.nodal[:, picked, 1:])
    load = _hybrid_load(made, nodal, analysis)
    return ReducedModel(mass, damping, stiffness, load, nodal, np.arange(3), unstable)


def joint_model(
    made: Discretization, shapes: DirectionalShapes, loops: tuple[int, ...], analysis: Analysis
) -> ReducedModel:
    """Reduce to the hybrid model's shapes of several loops that may move together, with the exact load.

    Parameters are those of `hybrid_model`; leading axis (lines,). The co-ordinates are f_v of each number of loops,
    then f_w, then f_theta; damping is that which each has alone.
    """
    alone = hybrid_model(made, shapes, loops, analysis)
    picked = [shapes.loops.index(k) for k in loops]
    together = np.moveaxis(shapes.nodal[:, picked], 1, 2)[:, None]
    mass, stiffness = (matrix[:, 0] for matrix in _condensed(made.matrices, together, analysis.longitudinal_inertia))
    rates = np.diagonal(alone.damping, axis1=-2, axis2=-1).swapaxes(-1, -2)
    nodal = np.moveaxis(alone.shapes, 1, 2).reshape(len(made.lines), -1, *alone.shapes.shape[-2:])
    values = at_points(made.matrices, nodal)
    load = span_load(made.lines, made.sections, made.matrices.weight, values[:, None], analysis.aerodynamic_model)
    return ReducedModel(
        mass=mass,
        damping=_diagonal(rates.reshape(len(made.lines), -1)),
        stiffness=stiffness,
        load=take_load(load, (slice(None), 0)),
        shapes=nodal,
        direction=np.repeat(np.arange(3), len(loops)),
        statically_unstable=np.asarray(
            alone.statically_unstable.any(axis=1) | (np.linalg.eigvalsh(stiffness)[:, 0] <= 0.0)
        ),
    )


def with_published_load(made: Discretization, model: ReducedModel) -> ReducedModel:
    """Return the hybrid model under the published closure, which the explicit formula of section 7.1 needs."""
    values = at_points(made.matrices, model.shapes)
    load = published_load(made.lines, made.sections, made.matrices.weight, values, made.profile.arc_length)
    return replace(model, load=load)


def finite_element_model(
    made: Discretization, modes: FullModes, shapes: DirectionalShapes, analysis: Analysis
) -> ReducedModel:
    """Reduce to the full modes of several loops a direction, with the exact load; leading axis (lines,).

    Damping is that of eq. (11) in the directional modes: C = sum over directions and loops of
    2 zeta omega (M psi)(M psi)^T / (psi^T M psi) with the directional shapes psi. Theory section 7.4.
    """
    vectors = modes.vectors.reshape(modes.vectors.shape[0], -1, modes.vectors.shape[-1])
    values = modes.eigenvalues.reshape(vectors.shape[:2])
    nodes = vectors.shape[-1] // FIELDS
    nodal = vectors.reshape(*vectors.shape[:2], nodes, FIELDS)[..., list(TRANSVERSE)].swapaxes(-1, -2)
    at = at_points(made.matrices, nodal)
    load = span_load(made.lines, made.sections, made.matrices.weight, at[:, None], analysis.aerodynamic_model)
    unstable = np.asarray((values <= 0.0).any(axis=-1) | np.isnan(shapes.angular_frequency).any(axis=(1, 2)))
    return ReducedModel(
        mass=np.broadcast_to(np.eye(values.shape[1]), (*values.shape, values.shape[1])),
        damping=_modal_damping(made, vectors, shapes, modes.loops),
        stiffness=_diagonal(values),
        load=take_load(load, (slice(None), 0)),
        shapes=nodal,
        direction=np.repeat(np.arange(3), len(modes.loops)),
        statically_unstable=unstable,
    )


def lowest_frequency(model: ReducedModel) -> FloatArray:
    """Return the root of the smallest |K_ii / M_ii| of each model: (members,) [rad/s]."""
    square = np.diagonal(model.stiffness, axis1=-2, axis2=-1) / np.diagonal(model.mass, axis1=-2, axis2=-1)
    return np.asarray(np.sqrt(np.abs(square).min(axis=-1)))


def take(model: ReducedModel, index: Any) -> ReducedModel:
    """Pick or repeat models along the leading axes; index is any numpy index of those axes."""
    return ReducedModel(
        mass=model.mass[index],
        damping=model.damping[index],
        stiffness=model.stiffness[index],
        load=take_load(model.load, index),
        shapes=model.shapes[index],
        direction=model.direction,
        statically_unstable=model.statically_unstable[index],
    )


def take_load(load: PolynomialLoad, index: Any) -> PolynomialLoad:
    """Pick or repeat loads along the leading axes."""
    return PolynomialLoad(*(getattr(load, field.name)[index] for field in fields(load)))


def observation(made: Discretization, shapes: FloatArray, loops: int) -> FloatArray:
    """Return V, W, Theta at s = L/(2 loops), (..., m, 3), of co-ordinates with shapes (..., m, 3, nodes)."""
    elements = made.lines[0].span.elements
    scaled = elements / (2.0 * loops)
    element = min(int(scaled), elements - 1)
    values, _ = shape_functions(np.array(2.0 * (scaled - element) - 1.0))
    return np.asarray(shapes[..., 2 * element : 2 * element + 3] @ values)


def _condensed(system: Matrices, nodal: FloatArray, inertia: LongitudinalInertia) -> tuple[FloatArray, FloatArray]:
    """Project onto f_u, f_v, f_w, f_theta and condense f_u, eqs. (18)-(20).

    nodal: (lines, groups, 4, k, nodes), k shapes of each direction that may move together; returns M and K
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


def _hybrid_load(made: Discretization, nodal: FloatArray, analysis: Analysis) -> PolynomialLoad:
    values = at_points(made.matrices, nodal)
    if analysis.closure is Closure.PUBLISHED:
        return published_load(made.lines, made.sections, made.matrices.weight, values, made.profile.arc_length)
    load = span_load(made.lines, made.sections, made.matrices.weight, values, analysis.aerodynamic_model)
    published = analysis.aerodynamic_model is AerodynamicModel.PUBLISHED
    return integrated(load, (2, 5, 3) if published else (2, 5, 3, 4))


def _ratios(lines: Sequence[Line]) -> FloatArray:
    return np.array([(d.vertical_ratio, d.horizontal_ratio, d.torsional_ratio) for d in (x.damping for x in lines)])


def _diagonal(values: FloatArray) -> FloatArray:
    return values[..., None] * np.eye(values.shape[-1])


def _diagonal_fields(shapes: FloatArray) -> FloatArray:
    """Spread f_v, f_w, f_theta (..., 3, nodes) to the fields of three co-ordinates (..., 3, 3, nodes)."""
    return shapes[..., None, :] * np.eye(3)[..., None]


def _modal_damping(
    made: Discretization, vectors: FloatArray, shapes: DirectionalShapes, loops: tuple[int, ...]
) -> FloatArray:
    constant = np.array([line.damping.model is DampingModel.CONSTANT_COEFFICIENT for line in made.lines])
    picked = [shapes.loops.index(k) for k in loops]
    own, first = shapes.angular_frequency[:, picked], shapes.angular_frequency[:, [shapes.loops.index(1)]]
    rate = 2.0 * _ratios(made.lines)[:, None] * np.nan_to_num(np.where(constant[:, None, None], first, own))
    damping = np.zeros((*vectors.shape[:2], vectors.shape[1]))
    for i, own_fields in enumerate(((U, V), (W,), (THETA,))):
        # Only the mass of the direction itself: the momentum that eccentric ice lends to the others is not damped.
        own_field = np.isin(np.arange(vectors.shape[-1]) % FIELDS, own_fields)
        mass = made.matrices.mass * (own_field[:, None] & own_field)
        psi = np.swapaxes(shapes.nodal[:, picked], -1, -2).reshape(vectors.shape[0], len(loops), -1) * own_field
        momentum = psi @ mass
        own_mass = np.einsum("lkf,lkf->lk", momentum, psi)
        share = vectors @ momentum.swapaxes(-1, -2)
        damping += (share * (rate[..., i] / own_mass)[:, None, :]) @ share.swapaxes(-1, -2)
    return damping
