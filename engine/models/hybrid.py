"""The hybrid model: one finite element mode shape per direction.

Theory section 4; paper eqs. (10)-(20) and (A1)-(A9).
"""

from dataclasses import replace

import numpy as np

from engine.arrays import FloatArray, merge_axes
from engine.mechanics.finite_elements import FIELDS, device_damping
from engine.mechanics.modes import DirectionalShapes, at_points
from engine.models.aerodynamic_load import (
    PolynomialLoad,
    SpanLoad,
    by_points,
    cheapest_load,
    integrate_along_span,
    integrate_each,
    no_load,
    published_load,
    span_angles,
    span_load,
    take_load,
)
from engine.models.discretization import Discretization, fields_in_space
from engine.models.mirror_image import with_parity
from engine.models.reduced_model import ReducedModel, damping_ratios, diagonal_matrices, diagonals, take
from engine.models.relief import DAMPING_RATIO, relief_displacement
from engine.models.stretching import StretchingForce, stretching_of, take_stretching
from engine.models.unexpanded_load import load_as_it_stands, take_unexpanded
from engine.spec import AerodynamicModel, Analysis, Closure, DampingModel, LongitudinalInertia, Stretching


def loop_groups(loops: tuple[int, ...], analysis: Analysis) -> list[tuple[int, ...]]:
    """Divide numbers of loops into groups whose hybrid models have equally many coordinates.

    With stretching, one loop stands alone: its own vertical motion relieves the tension, all others need a coordinate
    for that.
    """
    if analysis.stretching is Stretching.NEGLECTED:
        return [loops]
    parts = tuple(k for k in loops if k == 1), tuple(k for k in loops if k != 1)
    return [part for part in parts if part]


def hybrid_model(
    discretization: Discretization,
    shapes: DirectionalShapes,
    loops: tuple[int, ...],
    analysis: Analysis,
    *,
    whole: bool = True,
) -> ReducedModel:
    """Return the model reduced to one mode per direction, with leading axes (lines, loops).

    With stretching, a relief coordinate follows as the fourth, but for one loop. Theory section 12.1.

    Parameters
    ----------
    discretization : Discretization
    shapes : DirectionalShapes
        Of these loops and of one loop at least.
    loops : tuple of int
        One of the groups of `loop_groups`.
    analysis : Analysis
        Its closure, aerodynamic model, longitudinal inertia and stretching are used.
    whole : bool
        False leaves out what the linear equations of a model whose load stands do not hold.

    Returns
    -------
    ReducedModel
    """
    relief = _relief(discretization, loops, analysis)
    needed = sorted({1, *loops})  # the damping of one loop may be that of all
    basis = _basis(shapes.nodal[:, [shapes.loops.index(k) for k in needed], :, None], relief)
    system = discretization.matrices.stiffness, discretization.matrices.mass
    mass, stiffness, _ = condensed(system, basis, 1, analysis.longitudinal_inertia)
    squares = diagonals(stiffness) / diagonals(mass)
    own = [needed.index(k) for k in loops]
    mass, stiffness = mass[:, own], stiffness[:, own]
    constant = np.array([line.damping.model is DampingModel.CONSTANT_COEFFICIENT for line in discretization.lines])
    square = np.where(constant[:, None, None], squares[:, :1], squares[:, own])
    ratios = damping_ratios(discretization.lines)
    if relief is not None:
        ratios = np.append(ratios, np.full((len(ratios), 1), DAMPING_RATIO), axis=-1)
    rate = 2.0 * ratios[:, None] * np.sqrt(np.maximum(square, 0.0))
    unstable = np.asarray((square <= 0.0).any(axis=-1) | (np.linalg.eigvalsh(stiffness)[..., 0] <= 0.0))
    selected = [shapes.loops.index(k) for k in loops]
    nodal = fields_in_space(discretization.profile, diagonal_fields(shapes.nodal[:, selected, 1:]))
    fields = _with_relief(discretization, nodal, None if relief is None else np.zeros_like(relief))
    damping = diagonal_matrices(rate * diagonals(mass))  # (11)
    damping += device_damping(discretization.lines, discretization.profile, fields)
    values = at_points(discretization.matrices, fields)
    load = _hybrid_load(discretization, values, analysis) if whole else no_load(mass.shape)
    unexpanded = load_as_it_stands(discretization, values, analysis)
    moving = _with_relief(discretization, nodal, relief)
    stretching = _stretching(discretization, moving, analysis) if whole else None
    direction = np.arange(fields.shape[2]) % 3
    model = ReducedModel(mass, damping, stiffness, load, fields, direction, unstable, stretching, unexpanded)
    return with_parity(model, moving)


def joint_model(
    discretization: Discretization, shapes: DirectionalShapes, loops: tuple[int, ...], analysis: Analysis
) -> ReducedModel:
    """Return the model in which the hybrid shapes of several loops move together, with the exact load.

    Parameters are those of `hybrid_model`; leading axis (lines,). The coordinates are f_v of each number of loops, then
    f_w, then f_theta, each with the structural damping of its own hybrid model; then, with stretching and without one
    loop among them, the relief coordinate.
    """
    groups = {k: group for group in loop_groups(loops, analysis) for k in group}
    models = {group: hybrid_model(discretization, shapes, group, analysis) for group in set(groups.values())}
    alone = [take(models[groups[k]], (slice(None), groups[k].index(k))) for k in loops]
    relief = _relief(discretization, loops, analysis)
    selected = [shapes.loops.index(k) for k in loops]
    basis = _basis(np.moveaxis(shapes.nodal[:, selected], 1, 2)[:, None], relief)
    system = discretization.matrices.stiffness, discretization.matrices.mass
    mass, stiffness = (m[:, 0] for m in condensed(system, basis, len(loops), analysis.longitudinal_inertia)[:2])
    nodal = np.stack([model.shapes[:, :3] for model in alone], axis=2).reshape(
        len(mass), -1, *alone[0].shapes.shape[-2:]
    )
    fields = _with_relief(discretization, nodal, None if relief is None else np.zeros_like(relief))
    own = np.stack([diagonals(model.damping)[:, :3] for model in alone], axis=2).reshape(len(mass), -1)
    if relief is not None:
        own = np.append(own, diagonals(alone[0].damping)[:, 3:], axis=-1)
    coupled = device_damping(discretization.lines, discretization.profile, fields)  # in `own` as well
    values = at_points(discretization.matrices, fields)
    along_span = span_load(
        discretization.lines,
        discretization.sections,
        discretization.matrices.weight,
        values[:, None],
        analysis.aerodynamic_model,
    )
    load = by_points(along_span) if analysis.load_stands else cheapest_load(along_span)
    unstable = np.any([model.statically_unstable for model in alone], axis=0)
    return ReducedModel(
        mass=mass,
        damping=diagonal_matrices(own - diagonals(coupled)) + coupled,
        stiffness=stiffness,
        load=take_load(load, (slice(None), 0)),
        shapes=fields,
        direction=np.append(np.repeat(np.arange(3), len(loops)), np.zeros(fields.shape[1] - 3 * len(loops), np.intp)),
        statically_unstable=np.asarray(unstable | (np.linalg.eigvalsh(stiffness)[:, 0] <= 0.0)),
        stretching=take_stretching(
            _stretching(discretization, _with_relief(discretization, nodal[:, None], relief), analysis),
            (slice(None), 0),
        ),
        unexpanded=take_unexpanded(load_as_it_stands(discretization, values[:, None], analysis), (slice(None), 0)),
    )


def three_coordinates(model: ReducedModel) -> ReducedModel:
    """Return the hybrid model without stretching and without its relief coordinate."""
    three = slice(3)
    return replace(
        model,
        mass=model.mass[..., three, three],
        damping=model.damping[..., three, three],
        stiffness=model.stiffness[..., three, three],
        shapes=model.shapes[..., three, :, :],
        direction=model.direction[three],
        stretching=None,
        unexpanded=None,
        parity=None,
    )


def with_published_load(discretization: Discretization, model: ReducedModel) -> ReducedModel:
    """Return the hybrid model with the load of the published closure, which section 7.1's formula needs.

    Without stretching and relief coordinate: the formula treats three linear coordinates.
    """
    model = three_coordinates(model)
    values = at_points(discretization.matrices, model.shapes)
    load = published_load(
        discretization.lines,
        discretization.sections,
        discretization.matrices.weight,
        values,
        discretization.profile.arc_length,
    )
    return replace(model, load=load)


def _relief(discretization: Discretization, loops: tuple[int, ...], analysis: Analysis) -> FloatArray | None:
    """Return the displacement of the relief coordinate (lines, freedoms), None where the loops need none."""
    if analysis.stretching is Stretching.NEGLECTED or 1 in loops:
        return None
    return relief_displacement(discretization)


def _basis(nodal: FloatArray, relief: FloatArray | None) -> FloatArray:
    """Return the displacements of coordinates: f_u, f_v, f_w, f_theta of k shapes each, then the relief coordinate.

    nodal: (lines, groups, 4, k, nodes), k shapes per direction that move together; returns (lines, groups,
    coordinates, freedoms).
    """
    lines, groups, _, k, nodes = nodal.shape
    spread = nodal[..., None] * np.eye(FIELDS)[:, None, None, :]
    basis = spread.reshape(lines, groups, FIELDS * k, nodes * FIELDS)
    if relief is None:
        return basis
    return np.append(basis, np.broadcast_to(relief[:, None, None], (lines, groups, 1, nodes * FIELDS)), axis=-2)


def condensed(
    system: tuple[FloatArray, FloatArray], basis: FloatArray, longitudinal: int, inertia: LongitudinalInertia
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Project K and M onto bases (..., groups, coordinates, freedoms) and condense their first ones, eqs. (18)-(20).

    system: K and M, (..., freedoms, freedoms) each; longitudinal: how many coordinates come first, those of f_u.

    Where their inertia counts, each vertical shape moves with its own f_u as in the mode that both come from; the
    static condensation would be off by a third of a percent where longitudinal and vertical frequencies come close.

    Returns
    -------
    mass, stiffness : (..., kept, kept)
    moving : (..., kept, coordinates)
        The motion of the basis in each coordinate that is kept.
    """
    rows = merge_axes(basis, -3, -2)  # of all groups, so that a matrix is read once
    stiffness, mass = ((rows @ matrix).reshape(basis.shape) @ basis.swapaxes(-1, -2) for matrix in system)
    along, across = slice(longitudinal), slice(longitudinal, None)
    follow = np.asarray(-np.linalg.solve(stiffness[..., along, along], stiffness[..., along, across]))
    kept = follow.shape[-1]
    rest = np.broadcast_to(np.eye(kept), (*follow.shape[:-2], kept, kept))
    if inertia is LongitudinalInertia.NEGLECTED:
        remaining = stiffness[..., across, across] + stiffness[..., across, along] @ follow
        return mass[..., across, across], remaining, np.concatenate([follow, rest], axis=-2).swapaxes(-1, -2)
    follow[..., along] = np.eye(longitudinal)
    moving = np.concatenate([follow, rest], axis=-2).swapaxes(-1, -2)
    back = moving.swapaxes(-1, -2)
    return moving @ mass @ back, moving @ stiffness @ back, moving


def _stretching(discretization: Discretization, moving: FloatArray, analysis: Analysis) -> StretchingForce | None:
    """Return the stretching of coordinates that move as (lines, groups, m, 3, nodes), None where it is neglected."""
    if analysis.stretching is Stretching.NEGLECTED:
        return None
    return stretching_of(discretization, moving)


def _hybrid_load(discretization: Discretization, values: FloatArray, analysis: Analysis) -> PolynomialLoad:
    """Return the load on coordinates whose fields at the quadrature points are (lines, groups, m, 3, ...)."""
    if analysis.load_stands:  # nothing but the angle of attack is read
        shape = (*values.shape[:3], values.shape[2])
        return no_load(shape, span_angles(discretization.lines, discretization.sections, values))
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
    return integrated(load, values.shape[2], analysis, turned=bool(discretization.profile.tilt.any()))


def integrated(load: SpanLoad, coordinates: int, analysis: Analysis, *, turned: bool) -> PolynomialLoad:
    """Integrate the load on f_v, f_w and f_theta, the first ones of some coordinates, along the span.

    turned: whether the plane of the sag is, so that the rates of both f_v and f_w make each velocity.
    """
    q_theta, (v_rate, w_rate, theta_rate) = 2, range(coordinates, coordinates + 3)
    active = (q_theta, v_rate, w_rate, theta_rate)
    if turned:
        return integrate_along_span(load, active)
    if analysis.aerodynamic_model is AerodynamicModel.PUBLISHED:
        return integrate_along_span(load, (q_theta, theta_rate, v_rate))
    return integrate_each(load, active)


def diagonal_fields(shapes: FloatArray) -> FloatArray:
    """Return V, W, Theta of the coordinates with shapes f_v, f_w, f_theta (..., 3, nodes): (..., 3, 3, nodes)."""
    return shapes[..., None, :] * np.eye(3)[..., None]


def _with_relief(discretization: Discretization, nodal: FloatArray, relief: FloatArray | None) -> FloatArray:
    """Append V, W, Theta of the relief coordinate (lines, freedoms) to fields in space (lines, ..., m, 3, nodes)."""
    if relief is None:
        return nodal
    in_plane = relief.reshape(len(relief), -1, FIELDS).swapaxes(-1, -2)
    fields = fields_in_space(discretization.profile, in_plane)[:, 1:]
    extra = fields.reshape(len(relief), *(1,) * (nodal.ndim - 3), *fields.shape[1:])
    return np.append(nodal, np.broadcast_to(extra, (*nodal.shape[:-3], 1, *nodal.shape[-2:])), axis=-3)
