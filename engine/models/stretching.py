"""Geometric stiffening: the force with which stretched sub-conductors resist large motion. Theory section 12.1.

Paper eq. (7) has the squares of the slopes, which (A5) drops. The dynamic tension N is uniform along a span because
longitudinal waves are much faster than galloping; what differs between the sub-conductors of a rigid section strains
them locally, and those of a free section have a tension each. The energy beyond that of the linear stiffness,

    P = n k/2 [(e + h)^2 - e^2] + EA/2 sum_i int (D_i^2 - D_i,lin^2) ds          (rigid)
                                + k_d/2 sum_i (J_i^2 - J_i,lin^2)                (free, see `free_stretching`),

is a polynomial of third and fourth degree in the generalized coordinates, integrated once per line.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from engine.arrays import FloatArray, IntArray, merge_axes, take_rows
from engine.mechanics.cross_sections import Sections, turned_sums
from engine.mechanics.interpolation import element_nodes, section_slopes, shape_functions
from engine.mechanics.static_profile import StaticProfile
from engine.models.discretization import Discretization
from engine.models.free_stretching import (
    TensionForms,
    TurningSlopes,
    has_own_tensions,
    own_stiffness,
    own_stretches,
    principal_stretches,
    shares,
    tension_forms,
    with_own,
)
from engine.numerics import polynomial
from engine.spec import Line

SLOPES = 3  # V', W', Theta'
TWIST = 2  # index of Theta' among them


@dataclass(frozen=True, slots=True)
class StretchingForce:
    """The force g(q) = dP/dq of a stack of models with m generalized coordinates, and the dynamic tensions.

    table: (..., m, monomials of degree 1 to 3), coefficients of g, those of the first degree zero; slopes:
    (..., m, m, lower monomials), derivatives of the table; linear: (..., n, m) and square: (..., n, m, m), dynamic
    tensions N_i = linear_i . q + q . square_i q / 2 [N] of the sub-conductors, or n = 1 where all share that of the
    mean. In an assembly these follow for one member after the other.
    """

    table: FloatArray
    slopes: FloatArray
    linear: FloatArray
    square: FloatArray


@dataclass(frozen=True, slots=True)
class SlopePoints:
    """The points of `Sections`, for integrals of slopes along the span.

    slopes: (lines, elements, points, 3), derivatives by s of the element's shape functions [1/m]; weight:
    (lines, elements, points) = ds [m]; direction: (lines, elements, points, 3) = (x', y', z'); section_slopes:
    (lines, elements, points, 2), the slopes against the normal of the cross-section.
    """

    slopes: FloatArray
    weight: FloatArray
    direction: FloatArray
    section_slopes: FloatArray


def slope_points(lines: Sequence[Line], profile: StaticProfile, section_points: Sections) -> SlopePoints:
    """Return the points of the sections of lines with equal numbers of elements."""
    _, derivative = shape_functions(section_points.local)
    metric = derivative @ element_nodes(profile, lines[0].span.elements)
    jacobian = np.linalg.norm(metric, axis=-1)
    direction = metric / jacobian[..., None]
    return SlopePoints(
        derivative / jacobian[..., None],
        section_points.local_weight * jacobian,
        direction,
        section_slopes(lines, direction),
    )


def stretching_of(
    discretization: Discretization, nodal: FloatArray, pulled: FloatArray | None = None
) -> StretchingForce:
    """Return the stretching of coordinates with given shapes.

    Parameters
    ----------
    discretization : Discretization
        Of lines with equal numbers of elements.
    nodal : (lines, groups, m, 3, nodes)
        V, W and Theta of each generalized coordinate.
    pulled : (lines, groups, m), optional
        U at the right end less that at the left end, where both are coordinates and no springs; theory section 16.

    Returns
    -------
    StretchingForce
        With leading axes (lines, groups).
    """
    lines, profile, section_points, _ = discretization.parts
    at = slope_points(lines, profile, section_points)
    slopes = merge_axes(_slopes_at(at, nodal), -2)  # (lines, groups, m, 3, points)
    stiffness = span_stiffness(lines, profile, at)[:, None, None, None]
    linear, square = _stretches(at, slopes, _mean_offset(lines, section_points.twist))
    if pulled is not None:
        linear = linear + pulled
    count = np.array([len(line.bundle.positions) for line in lines])
    table = count[:, None, None, None] * stiffness * _mean_table(linear, square)
    tension = TensionForms(stiffness * linear[:, :, None], stiffness[..., None] * square[:, :, None])
    free = np.array([has_own_tensions(line) for line in lines])
    rigid = np.flatnonzero((count > 1) & ~free)
    if rigid.size:
        some, here = [lines[i] for i in rigid], [_offsets(lines[i], section_points.twist[i]) for i in rigid]
        table[rigid] += _local_table(some, take_rows(at, rigid), slopes[rigid], here)
    if free.any():
        own, forms = _own_stretching(discretization, np.flatnonzero(free), at, nodal)
        table[free] += own
        tension = with_own(tension, forms, free)
    return StretchingForce(table, polynomial.slopes(table), tension.linear, tension.square)


def span_stiffness(lines: Sequence[Line], profile: StaticProfile, at: SlopePoints) -> FloatArray:
    """Return k of a sub-conductor between its end springs, 1/k = L_e/EA + 1/K_left + 1/K_right: (lines,) [N/m]."""
    rigidity = np.array([line.conductor.axial_rigidity for line in lines])
    return np.asarray(1.0 / (_effective_length(at) / rigidity + (1.0 / profile.end_stiffness).sum(axis=1)))


def _effective_length(at: SlopePoints) -> FloatArray:
    """Return L_e = int ds/x'^2: (lines,) [m]."""
    return np.asarray((at.weight / at.direction[..., 0] ** 2).sum(axis=(1, 2)))


def relieved_share(lines: Sequence[Line], profile: StaticProfile, section_points: Sections) -> FloatArray:
    """Return k_0/k, the share of the stiffness that is left when the sag follows statically: (lines,).

    1/k_0 = 1/k + (1/H) int y_x^2 dx, with slopes from the chord. Theory section 12.1.
    """
    at = slope_points(lines, profile, section_points)
    dx = at.weight * at.direction[..., 0]
    slope = at.direction[..., 1:] / at.direction[..., :1]
    chord = (slope * dx[..., None]).sum(axis=(1, 2), keepdims=True) / dx.sum(axis=(1, 2))[:, None, None, None]
    give = (((slope - chord) ** 2).sum(axis=-1) * dx).sum(axis=(1, 2)) / profile.horizontal_tension
    return np.asarray(1.0 / (1.0 + span_stiffness(lines, profile, at) * give))


def restoring_force(stretching: StretchingForce, q: FloatArray) -> FloatArray:
    """Evaluate g at coordinates (..., samples, m): (..., samples, m) [N, N m]."""
    return np.asarray(polynomial.powers(q) @ stretching.table.swapaxes(-1, -2))


def restoring_gradient(stretching: StretchingForce, q: FloatArray) -> FloatArray:
    """Differentiate g by q at coordinates (..., samples, m): (..., samples, m, m)."""
    m = q.shape[-1]
    terms = np.concatenate([np.ones((*q.shape[:-1], 1)), polynomial.powers(q, 2)], axis=-1)
    flat = terms @ merge_axes(stretching.slopes, -3, -2).swapaxes(-1, -2)
    return np.asarray(flat.reshape(*flat.shape[:-1], m, m))


def dynamic_tension(stretching: StretchingForce, q: FloatArray) -> FloatArray:
    """Return N_i, horizontal components of the sub-conductors, at (..., samples, m): (..., samples, n) [N].

    n is 1 where no line of the stack has free sections; all sub-conductors then have that tension.
    """
    half = polynomial.collected(0.5 * merge_axes(stretching.square, -2), q.shape[-1], 2)
    forms = np.concatenate([stretching.linear, half], axis=-1)
    return np.asarray((forms @ polynomial.powers(q, 2).swapaxes(-1, -2)).swapaxes(-1, -2))  # samples side by side


def tension_range(stretching: StretchingForce, q: FloatArray, spans: int = 1) -> FloatArray:
    """Return the smallest and the largest N_i of the sub-conductors of each span over samples q (..., samples, m).

    Returns (..., spans, 2) [N].
    """
    tension = dynamic_tension(stretching, q)
    by_span = tension.reshape(*tension.shape[:-1], spans, tension.shape[-1] // spans)
    return np.stack([by_span.min(axis=(-3, -1)), by_span.max(axis=(-3, -1))], axis=-1)


def take_stretching(stretching: StretchingForce | None, index: Any) -> StretchingForce | None:
    """Select or repeat along the leading axes; None where stretching is neglected."""
    return None if stretching is None else take_members(stretching, index)


def take_members(stretching: StretchingForce, index: Any) -> StretchingForce:
    """Select or repeat along the leading axes."""
    return StretchingForce(*(getattr(stretching, field.name)[index] for field in fields(stretching)))


def _slopes_at(at: SlopePoints, nodal: FloatArray) -> FloatArray:
    """Return the derivatives by s of nodal values (lines, ..., nodes) at the points: (lines, ..., elements, points)."""
    first = 2 * np.arange(at.weight.shape[1])[:, None] + np.arange(3)
    by_element = nodal[..., first]
    flat = by_element.reshape(nodal.shape[0], -1, *by_element.shape[-2:])
    values = np.einsum("lrea,lepa->lrep", flat, at.slopes, optimize=True)
    return np.asarray(values.reshape(*nodal.shape[:-1], *at.weight.shape[1:]))


def _offsets(line: Line, twist: FloatArray) -> FloatArray:
    """Return (-z_i, y_i, r_i^2/2) of each sub-conductor at points with a static twist [rad]: (points, n, 3).

    Their product with (y' + V', z' + W', Theta') times Theta' is the strain of sub-conductor i beyond that of the
    reference curve.
    """
    y, z = np.array(line.bundle.positions).T
    c, s = np.cos(twist).reshape(-1, 1), np.sin(twist).reshape(-1, 1)
    square = np.broadcast_to(0.5 * (y**2 + z**2), (twist.size, y.size))
    return np.stack([-(s * y + c * z), c * y - s * z, square], axis=-1)


def _mean_offset(lines: Sequence[Line], twist: FloatArray) -> FloatArray:
    """Return the mean of `_offsets` over the sub-conductors at points with a twist [rad]: (lines, 3, points)."""
    n, s_y, s_z, s_yy, s_zz, _ = merge_axes(turned_sums(lines, twist), -2)
    return np.asarray(np.stack([-s_z, s_y, 0.5 * (s_yy + s_zz)], axis=1) / n[:, None])


def _stretches(at: SlopePoints, slopes: FloatArray, mean: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the linear and square stretch of the sub-conductor with the mean offset: (lines, groups, m[, m])."""
    weight = merge_axes(at.weight / at.direction[..., 0], -2)
    curve, levers = (merge_axes(x, -3, -2).swapaxes(-1, -2) for x in (at.direction[..., 1:], at.section_slopes))
    row = np.append(curve, (levers * mean[:, :TWIST]).sum(axis=1, keepdims=True), axis=1) * weight[:, None]
    turn, across = slopes[..., TWIST, :], mean[:, None, None]
    weighted = slopes + across * turn[..., None, :]
    weighted[..., TWIST, :] = (slopes * across).sum(axis=-2) + across[..., TWIST, :] * turn
    weighted *= weight[:, None, None, None]
    flat = merge_axes(slopes, -2)
    linear = flat @ merge_axes(row, -2)[:, None, :, None]
    return linear[..., 0], merge_axes(weighted, -2) @ flat.swapaxes(-1, -2)


def _own_stretching(
    discretization: Discretization, free: IntArray, at: SlopePoints, nodal: FloatArray
) -> tuple[FloatArray, TensionForms]:
    """Return the table of the stretches beyond the mean of lines with free sections, and their parts of the tensions.

    free: which lines; the table has the shape (free lines, groups, m, monomials).
    """
    lines, points, moved = [discretization.lines[i] for i in free], take_rows(at, free), nodal[free]
    angle = np.zeros(nodal.shape[-1]) if discretization.twist is None else discretization.twist.angle[free, None, None]
    twist, turn = moved[..., TWIST, :], np.nan_to_num(angle)
    turning = np.stack([np.cos(turn) * twist, np.sin(turn) * twist], axis=-2)
    stretches = own_stretches(
        TurningSlopes(
            translation=merge_axes(_slopes_at(points, moved[..., :TWIST, :]), -2),
            turning=merge_axes(_slopes_at(points, turning), -2),
            curve=merge_axes(points.section_slopes, -3, -2),
            weight=merge_axes(points.weight / points.direction[..., 0], -2),
        )
    )
    share = shares(lines)
    stiffness = own_stiffness(lines, discretization.profile.yoke_stiffness[free], _effective_length(points))
    weight, principal = principal_stretches(stretches, share)
    each = _mean_table(principal.linear, principal.square)
    table = np.einsum("l,lr,lgrmk->lgmk", stiffness, weight, each, optimize=True)
    return table, tension_forms(stretches, stiffness[:, None, None] * share)


def _mean_table(linear: FloatArray, square: FloatArray) -> FloatArray:
    """Return the table of d/dq of [(e + h)^2 - e^2] / 2 = h de/dq + (e + h) dh/dq: (..., m, monomials)."""
    m = linear.shape[-1]
    half = polynomial.collected(0.5 * merge_axes(square, -2), m, 2)
    quadratic = half[..., None, :] * linear[..., None] + polynomial.multiply_forms(linear[..., None, :], square)
    cubic = polynomial.multiply_forms(half[..., None, :], square)
    return np.concatenate([np.zeros_like(square), quadratic, cubic], axis=-1)


def _local_table(lines: Sequence[Line], at: SlopePoints, slopes: FloatArray, offsets: list[FloatArray]) -> FloatArray:
    """Return the table of the strain of sub-conductors beyond the mean: (lines, groups, m, monomials)."""
    rigidity = np.array([line.conductor.axial_rigidity for line in lines])
    deviation = [offset - offset.mean(axis=1, keepdims=True) for offset in offsets]
    products = np.stack([d.swapaxes(-1, -2) @ d for d in deviation])  # (lines, points, 3, 3)
    levers = merge_axes(at.section_slopes, -3, -2)
    pull = 2.0 * (products[..., :TWIST] @ levers[..., None])[..., 0]
    strength = (rigidity[:, None] * merge_axes(at.weight, -2))[..., None, None]
    local = strength * _local_polynomials(pull, products)
    forms = np.moveaxis(slopes, -1, 2)  # (lines, groups, points, m, 3)
    return polynomial.substitute(forms @ local[:, None], forms.swapaxes(-1, -2))


def _local_polynomials(pull: FloatArray, products: FloatArray) -> FloatArray:
    """Return the derivatives of t^2 (pull . s + s . products s) / 2 by s = (V', W', t): (..., 3, 19), t = Theta'."""
    place = {monomial: i for i, monomial in enumerate(polynomial.monomials(SLOPES))}
    table = np.zeros((*pull.shape, len(place)))
    t = TWIST
    for j in range(SLOPES):
        table[..., j, place[t, t]] += 0.5 * pull[..., j]
        table[..., t, place[j, t]] += pull[..., j]
        for k in range(SLOPES):
            table[..., j, place[tuple(sorted((k, t, t)))]] += products[..., j, k]
            table[..., t, place[tuple(sorted((j, k, t)))]] += products[..., j, k]
    return table
