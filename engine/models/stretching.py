"""Geometric stiffening: the force with which stretched sub-conductors resist large motion. Theory section 12.1.

Paper eq. (7) has the squares of the slopes, which (A5) drops. The dynamic tension N is uniform along a span because
longitudinal waves are much faster than galloping; what differs between the sub-conductors of a rigid section strains
them locally. The energy beyond that of the linear stiffness,

    P = n k/2 [(e + h)^2 - e^2] + EA/2 sum_i int (D_i^2 - D_i,lin^2) ds,

is a polynomial of third and fourth degree in the generalized coordinates, integrated once per line.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from engine.arrays import FloatArray, merge_axes
from engine.mechanics.cross_sections import Sections
from engine.mechanics.interpolation import element_nodes, section_slopes, shape_functions
from engine.mechanics.static_profile import StaticProfile
from engine.numerics import polynomial
from engine.spec import Line

SLOPES = 3  # V', W', Theta'
TWIST = 2  # index of Theta' among them


@dataclass(frozen=True, slots=True)
class StretchingForce:
    """The force g(q) = dP/dq of a stack of models with m generalized coordinates, and the dynamic tension.

    table: (..., m, monomials of degree 1 to 3), coefficients of g, those of the first degree zero; slopes:
    (..., m, m, lower monomials), derivatives of the table; stiffness: (...,), k per sub-conductor [N/m]; linear:
    (..., m), e = linear . q [m]; square: (..., m, m), h = q . square q / 2 [m].
    """

    table: FloatArray
    slopes: FloatArray
    stiffness: FloatArray
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
    lines: Sequence[Line], profile: StaticProfile, section_points: Sections, nodal: FloatArray
) -> StretchingForce:
    """Return the stretching of coordinates with given shapes.

    Parameters
    ----------
    lines : sequence of Line
    profile : StaticProfile
    section_points : Sections
        With the static twist of the sections, if there is one.
    nodal : (lines, groups, m, 3, nodes)
        V, W and Theta of each generalized coordinate.

    Returns
    -------
    StretchingForce
        With leading axes (lines, groups).
    """
    at = slope_points(lines, profile, section_points)
    slopes = merge_axes(_slopes_at(at, nodal), -2)  # (lines, groups, m, 3, points)
    offsets = [_offsets(line, turn) for line, turn in zip(lines, section_points.twist, strict=True)]
    stiffness = span_stiffness(lines, profile, at)
    linear, square = _stretches(at, slopes, offsets)
    count = np.array([len(line.bundle.positions) for line in lines])
    table = (count * stiffness)[:, None, None, None] * _mean_table(linear, square)
    table = table + _local_table(lines, at, slopes, offsets)
    return StretchingForce(
        table,
        polynomial.slopes(table),
        np.broadcast_to(stiffness[:, None], linear.shape[:-1]),
        linear,
        square,
    )


def span_stiffness(lines: Sequence[Line], profile: StaticProfile, at: SlopePoints) -> FloatArray:
    """Return k of a sub-conductor between its end springs, 1/k = L_e/EA + 1/K_left + 1/K_right: (lines,) [N/m]."""
    rigidity = np.array([line.conductor.axial_rigidity for line in lines])
    effective_length = (at.weight / at.direction[..., 0] ** 2).sum(axis=(1, 2))
    return np.asarray(1.0 / (effective_length / rigidity + (1.0 / profile.end_stiffness).sum(axis=1)))


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
    """Return N = k (e + h), the horizontal component per sub-conductor, at (..., samples, m): (..., samples) [N]."""
    linear = (q @ stretching.linear[..., None])[..., 0]
    square = 0.5 * ((q @ stretching.square) * q).sum(axis=-1)
    return np.asarray(stretching.stiffness[..., None] * (linear + square))


def take_stretching(stretching: StretchingForce | None, index: Any) -> StretchingForce | None:
    """Select or repeat along the leading axes; None where stretching is neglected."""
    if stretching is None:
        return None
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


def _stretches(at: SlopePoints, slopes: FloatArray, offsets: list[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return the linear and the square stretch of the mean sub-conductor: (lines, groups, m), (lines, groups, m, m)."""
    mean = np.stack([offset.mean(axis=1) for offset in offsets])  # (lines, points, 3)
    weight = merge_axes(at.weight / at.direction[..., 0], -2)
    curve = merge_axes(at.direction[..., 1:], -3, -2)
    levers = merge_axes(at.section_slopes, -3, -2)
    row = np.concatenate([curve, (levers * mean[..., :TWIST]).sum(axis=-1, keepdims=True)], axis=-1)
    linear = np.einsum("lgmfp,lpf,lp->lgm", slopes, row, weight, optimize=True)
    metric = np.zeros((*weight.shape, SLOPES, SLOPES))
    metric[...] = np.eye(SLOPES)
    metric[..., :TWIST, TWIST] = metric[..., TWIST, :TWIST] = mean[..., :TWIST]
    metric[..., TWIST, TWIST] = 2.0 * mean[..., TWIST]
    metric *= weight[..., None, None]
    square = np.einsum("lgafp,lpfh,lgbhp->lgab", slopes, metric, slopes, optimize=True)
    return np.asarray(linear), np.asarray(square)


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
