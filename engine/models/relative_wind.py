"""The relative wind at every sub-conductor: local motion, its table of the load, angles and velocities reached.

Theory section 13. A sub-conductor at (y_i, z_i) moves with V_i' = V' - z_i Theta', W_i' = W' + y_i Theta', eq. (3).
Four numbers describe the motion at a point of the span: Theta, V'/(U phi), W'/(U phi) and l Theta'/(U phi), where the
length l of `arm_scale` makes them of one size.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import comb

import numpy as np

from engine.arrays import FloatArray, IntArray, merge_axes
from engine.mechanics.cross_sections import bundle_sums
from engine.numerics import polynomial
from engine.spec import AerodynamicModel, Line

VERTICAL, HORIZONTAL, TORSIONAL = range(3)
LOCAL = 4  # numbers that describe the motion at a point
FASTEST = 0.7  # velocity of a sub-conductor over the wind's, up to which the expanded load holds
_ORDERS = [(i, j) for i in range(polynomial.DEGREE + 1) for j in range(polynomial.DEGREE + 1 - i)]
BLOCK = 16  # motions examined together, so that all their samples stay in the processor's cache

_Series = dict[tuple[int, ...], float]


def arm_scale(lines: Sequence[Line]) -> FloatArray:
    """Return l of each line, the root of the mean square of r_i plus that of half a diameter: (lines,) [m]."""
    count, _, _, y_y, z_z, _ = bundle_sums(lines)
    halves = np.array([0.5 * line.conductor.diameter for line in lines])
    return np.asarray(np.sqrt((y_y + z_z) / count + halves**2))


def local_motion_forms(fields: FloatArray, scale: FloatArray, factor: FloatArray) -> FloatArray:
    """Return Theta, V'/(U phi), W'/(U phi) and l Theta'/(U phi) as linear forms in (q, q'/U).

    Parameters
    ----------
    fields : (lines, groups, m, 3, points)
        V, W and Theta of each generalized coordinate.
    scale : broadcasts to (lines, groups, points)
        The length l [m].
    factor : broadcasts to (lines, groups, points)
        Wind factor phi.

    Returns
    -------
    (lines, groups, points, 4, 2 m)
    """
    at_points = np.moveaxis(fields, -1, 2)  # (lines, groups, points, m, 3)
    v, w, theta = (at_points[..., i] for i in (VERTICAL, HORIZONTAL, TORSIONAL))
    m, by_wind = theta.shape[-1], 1.0 / factor[..., None]
    forms = np.zeros((*theta.shape[:-1], LOCAL, 2 * m))
    forms[..., 0, :m] = theta
    for local, rate in enumerate((v * by_wind, w * by_wind, theta * (scale[..., None] * by_wind)), start=1):
        forms[..., local, m:] = rate
    return forms


@dataclass(frozen=True, slots=True)
class NodalMotion:
    """The motion at the nodes of a stack of models and what turns it into that of the sub-conductors.

    forms: (members, nodes, 4, 2 m), Theta, V'/(U phi), W'/(U phi) and Theta'/(U phi) [1/m] as linear forms in
    (q, q'/U), the first in q alone and the others in q'/U alone; arms: (members, nodes, n, 2), (y_i, z_i) of n
    sub-conductors, where there are fewer the first one again [m]; diameter: (members,) [m]; model: which velocities
    change the relative wind.
    """

    forms: FloatArray
    arms: FloatArray
    diameter: FloatArray
    model: AerodynamicModel


def largest_reach(motion: NodalMotion, member: IntArray, state: FloatArray) -> FloatArray:
    """Return the largest angle of attack and the largest velocity of a sub-conductor over the wind's.

    Parameters
    ----------
    motion : NodalMotion
    member : (motions,)
        Index of the model of each motion.
    state : (motions, samples, 2 m)
        q and q'/U over time.

    Returns
    -------
    (2, motions)
        Largest |alpha_i|, under the published model |alpha| of the reference curve, eq. (16) [rad]; largest
        sqrt(V_i'^2 + W_i'^2)/(U phi).
    """
    reach = np.zeros((2, member.size))
    for first in range(0, member.size, BLOCK):
        here = slice(first, first + BLOCK)
        reach[:, here] = _reach(motion, member[here], state[here])
    return reach


def _reach(motion: NodalMotion, member: IntArray, state: FloatArray) -> FloatArray:
    forms = motion.forms[member]
    local = (state @ merge_axes(forms, -3, -2).swapaxes(-1, -2)).reshape(*state.shape[:2], *forms.shape[1:3])
    theta, v, w, turn = np.moveaxis(local, -1, 0)[..., None]
    y, z = np.moveaxis(motion.arms[member], -1, 0)[:, :, None]
    half = 0.5 * motion.diameter[member, None, None, None]
    rise, sway = v - z * turn, w + y * turn
    if motion.model is AerodynamicModel.PUBLISHED:
        angle = theta - v - half * turn
    else:
        across, along = rise + half * turn, 1.0 - sway
        # Several times faster than arctan2, which only serves motion that outruns the wind.
        angle = theta - (np.arctan(across / along) if (along > 0.0).all() else np.arctan2(across, along))
    every = (1, 2, 3)
    return np.stack([np.abs(angle).max(axis=every), np.sqrt((rise**2 + sway**2).max(axis=every))])


def bundle_table(lines: Sequence[Line], coefficients: FloatArray, twist: FloatArray) -> FloatArray:
    """Return the load of the relative wind at every sub-conductor, expanded to third order.

    The load is the mean over the sub-conductors, less its value at rest: with it the moment of the mean lift and drag
    about the reference curve, which vanishes only where that curve is the centroid of the bundle.

    Parameters
    ----------
    lines : sequence of Line
    coefficients : (lines, points, 3, 4)
        a_i0 to a_i3 of a sub-conductor, i = y, z, theta.
    twist : (lines, points)
        Static twist, which turns the bundle [rad].

    Returns
    -------
    (lines, points, 3, 34)
        Tables in the local motion, per 1/2 rho d (U phi)^2 of V and W and per 1/2 rho d^2 (U phi)^2 of Theta.
    """
    if not twist.any() and (coefficients == coefficients[:, :1]).all() and twist.shape[1] > 1:
        table = bundle_table(lines, coefficients[:, :1], twist[:, :1])  # the same at every point
        return np.broadcast_to(table, (*twist.shape, *table.shape[-2:]))
    own = relative_wind_table(coefficients)
    turned = twist if twist.any() else twist[:, :1]
    mean, with_y, with_z = _sums_over_bundle(lines, turned)
    blocks = own.reshape(own.shape[0], turned.shape[1], -1, *own.shape[-2:]).swapaxes(-2, -3)
    lift, drag, moment = (blocks[:, :, i] for i in (VERTICAL, HORIZONTAL, TORSIONAL))
    rows = [lift @ mean, drag @ mean, moment @ mean + drag @ with_y - lift @ with_z]
    return np.stack([row.reshape(*twist.shape, -1) for row in rows], axis=-2)


def _sums_over_bundle(lines: Sequence[Line], twist: FloatArray) -> FloatArray:
    """Return the maps from a table in the motion of one sub-conductor to one in the local motion.

    twist: (lines, points). Returns (3, lines, points, 19, 34): the mean over the sub-conductors, and the means weighted
    with y_i/d and z_i/d.
    """
    diameter = np.array([line.conductor.diameter for line in lines])[:, None, None]
    scale = arm_scale(lines)[:, None, None]
    y, z = np.moveaxis(turned_arms(lines, twist), -1, 0)
    count = np.array([len(line.bundle.positions) for line in lines])[:, None]
    share = (np.arange(y.shape[-1]) < count) / count
    weights = share[:, None] * np.stack([np.ones_like(y), y / diameter, z / diameter])
    rise, sway = (0.5 * diameter - z) / scale, y / scale
    moments = np.stack([(weights * rise**i * sway**j).sum(axis=-1) for i, j in _ORDERS], axis=-1)
    maps = _shifted()
    return np.asarray((moments @ maps.reshape(len(maps), -1)).reshape(*moments.shape[:-1], *maps.shape[1:]))


@lru_cache
def _shifted() -> FloatArray:
    """Return the expansion of Theta^k (v + beta t)^l (w + gamma t)^m by powers of beta and gamma: (10, 19, 34)."""
    position = {monomial: column for column, monomial in enumerate(polynomial.monomials(LOCAL))}
    result = np.zeros((len(_ORDERS), len(polynomial.monomials(3)), len(position)))
    for row, monomial in enumerate(polynomial.monomials(3)):
        k, rises, sways = (monomial.count(variable) for variable in range(3))
        for power, (i, j) in enumerate(_ORDERS):
            if i <= rises and j <= sways:
                target = (0,) * k + (1,) * (rises - i) + (2,) * (sways - j) + (3,) * (i + j)
                result[power, row, position[target]] = comb(rises, i) * comb(sways, j)
    return result


def turned_arms(lines: Sequence[Line], twist: FloatArray) -> FloatArray:
    """Return (y_i, z_i) of bundles turned by a twist (lines, points) [rad]: (lines, points, n, 2) [m].

    n is the largest number of sub-conductors; where there are fewer, the first one stands again.
    """
    most = max(len(line.bundle.positions) for line in lines)
    arms = np.array([[*p, *[p[0]] * (most - len(p))] for p in (line.bundle.positions for line in lines)])[:, None]
    c, s = np.cos(twist)[..., None], np.sin(twist)[..., None]
    y, z = arms[..., 0], arms[..., 1]
    return np.stack([c * y - s * z, s * y + c * z], axis=-1)


def relative_wind_table(coefficients: FloatArray) -> FloatArray:
    """Return the load on one sub-conductor, expanded to third order.

    Parameters
    ----------
    coefficients : (..., 3, 4)
        a_i0 to a_i3, i = y, z, theta.

    Returns
    -------
    (..., 3, 19)
        Tables in (Theta, b, w) with b = (V_i' + d Theta'/2)/(U phi) and w = W_i'/(U phi), per 1/2 rho d (U phi)^2.
    """
    basis = _relative_wind_basis()
    flat = coefficients.reshape(*coefficients.shape[:-2], 12) @ basis.reshape(12, -1)
    return np.asarray(flat.reshape(*coefficients.shape[:-2], 3, basis.shape[-1]))


@lru_cache
def _relative_wind_basis() -> FloatArray:
    """Return the load per coefficient a_ij: (3, 4, 3 load components, monomials)."""
    theta, v, w = (_variable(i) for i in range(3))
    one: _Series = {(): 1.0}
    cube_of_v = _scale(_product(v, _product(v, v)), -1.0 / 3.0)
    slope = _product(v, _sum(one, _sum(w, _product(w, w))))
    angle = _sum(theta, _scale(_sum(slope, cube_of_v), -1.0))
    pressure = _sum(_sum(one, _scale(w, -2.0)), _sum(_product(w, w), _product(v, v)))
    cosine = _sum(one, _scale(_product(theta, theta), -0.5))
    sine = _sum(theta, _scale(_product(theta, _product(theta, theta)), -1.0 / 6.0))
    basis = np.zeros((3, 4, 3, len(polynomial.monomials(3))))
    power = pressure
    for j in range(4):
        along, across = _table_of(_product(power, cosine)), _table_of(_product(power, sine))
        basis[VERTICAL, j, VERTICAL], basis[VERTICAL, j, HORIZONTAL] = along, across
        basis[HORIZONTAL, j, HORIZONTAL], basis[HORIZONTAL, j, VERTICAL] = along, -across
        basis[TORSIONAL, j, TORSIONAL] = _table_of(power)
        power = _product(power, angle)
    return basis


def _variable(index: int) -> _Series:
    return {(index,): 1.0}


def _product(a: _Series, b: _Series) -> _Series:
    result: _Series = {}
    for left, x in a.items():
        for right, y in b.items():
            if len(left) + len(right) <= polynomial.DEGREE:
                key = tuple(sorted(left + right))
                result[key] = result.get(key, 0.0) + x * y
    return result


def _sum(a: _Series, b: _Series) -> _Series:
    return {key: a.get(key, 0.0) + b.get(key, 0.0) for key in a.keys() | b.keys()}


def _scale(a: _Series, factor: float) -> _Series:
    return {key: factor * value for key, value in a.items()}


def _table_of(a: _Series) -> FloatArray:
    """Return the coefficients without the constant, because the load is relative to its value at rest."""
    return np.array([a.get(m, 0.0) for m in polynomial.monomials(3)])
