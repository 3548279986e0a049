"""Quasi-steady aerodynamic load as cubic polynomials. Theory sections 5 and 13, paper eqs. (A11)-(A19).

Every aerodynamic model yields a load of the same form, one table of monomials and coefficients that all solvers read.
Divided by U^2 the load depends only on the generalized coordinates q and on q'/U, so the integrals along the span are
computed once per line.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from engine.arrays import FloatArray, merge_axes
from engine.mechanics.cross_sections import Sections
from engine.models.relative_wind import (
    TORSIONAL,
    VERTICAL,
    arm_scale,
    bundle_table,
    local_motion_forms,
)
from engine.numerics import polynomial
from engine.spec import AerodynamicModel, Line

WORTH = 0.75  # share of the products at all points, from which one polynomial is worth its integration


@dataclass(frozen=True, slots=True)
class PolynomialLoad:
    """Generalized load divided by U^2: a sum over points of cubic polynomials in linear forms of (q, q'/U).

    forms: (..., points, local variables, 2 m), the linear forms; table: (..., points, m, monomials), coefficients for m
    generalized coordinates; slopes: (..., points, m, local variables, lower monomials), derivatives of the table. There
    is a single point if the integral along the span was computed beforehand (hybrid model). angle: (..., points on the
    span, 2 m), the linear form of the angle of attack [rad].
    """

    forms: FloatArray
    table: FloatArray
    slopes: FloatArray
    angle: FloatArray


@dataclass(frozen=True, slots=True)
class SpanLoad:
    """The load before its integration along the span: at each quadrature point, loads of shapes times coefficients.

    forms: (lines, groups, points, local variables, 2 m), as those of `PolynomialLoad`; outputs: (lines, groups, points,
    m, 3), what the lift, drag and moment at a point contribute to each generalized coordinate; coefficients:
    (lines, 1, points, 3, monomials) of these in the local variables; angle: as that of `PolynomialLoad`.
    """

    forms: FloatArray
    outputs: FloatArray
    coefficients: FloatArray
    angle: FloatArray

    @property
    def table(self) -> FloatArray:
        """The table of each point: (lines, groups, points, m, monomials)."""
        return self.outputs @ self.coefficients


def polynomial_load(forms: FloatArray, table: FloatArray, angle: FloatArray) -> PolynomialLoad:
    """Return a load with the derivatives of its table."""
    return PolynomialLoad(forms, table, polynomial.slopes(table), angle)


def no_load(shape: tuple[int, ...], angle: FloatArray | None = None) -> PolynomialLoad:
    """Return the load without any point of models whose matrices have a shape (..., m, m), with their angle if any."""
    leading, m = shape[:-2], shape[-1]
    none = (np.zeros((*leading, 0, *own)) for own in ((0, 2 * m), (m, 0), (m, 0, 0), (2 * m,)))
    load = PolynomialLoad(*none)
    return load if angle is None else replace(load, angle=angle)


def force(load: PolynomialLoad, state: FloatArray) -> FloatArray:
    """Evaluate the load divided by U^2.

    Parameters
    ----------
    load : PolynomialLoad
        With leading axes (...,).
    state : (..., samples, 2 m)
        q and q'/U.

    Returns
    -------
    (..., samples, m)
    """
    terms = polynomial.powers(_local(load, state))
    table = load.table.swapaxes(-1, -2)
    return np.asarray(merge_axes(terms, -2) @ merge_axes(table, -3, -2))


def force_gradient(load: PolynomialLoad, state: FloatArray) -> FloatArray:
    """Differentiate the load divided by U^2 by (q, q'/U): (..., samples, m, 2 m) at state (..., samples, 2 m)."""
    local = _local(load, state)
    terms = np.concatenate([np.ones((*local.shape[:-1], 1)), polynomial.powers(local, 2)], axis=-1)
    points, outputs, variables, lower = load.slopes.shape[-4:]
    by_point = load.slopes.reshape(*load.slopes.shape[:-4], points, outputs * variables, lower)
    gradients = np.moveaxis(terms, -3, -2) @ by_point.swapaxes(-1, -2)
    samples = gradients.shape[-2]
    gradients = gradients.reshape(*gradients.shape[:-1], outputs, variables)
    gradients = np.moveaxis(gradients, -4, -2).reshape(*gradients.shape[:-4], samples, outputs, points * variables)
    return np.asarray(gradients @ merge_axes(load.forms, -3, -2)[..., None, :, :])


def _local(load: PolynomialLoad, state: FloatArray) -> FloatArray:
    """Return the local variables (..., samples, points, local variables)."""
    values = state @ merge_axes(load.forms, -3, -2).swapaxes(-1, -2)
    return np.asarray(values.reshape(*values.shape[:-1], *load.forms.shape[-3:-1]))


def span_load(
    lines: Sequence[Line], sections_of_lines: Sections, weight: FloatArray, fields: FloatArray, model: AerodynamicModel
) -> SpanLoad:
    """Return the load, point by point along the span, for any set of shapes.

    Parameters
    ----------
    lines : sequence of Line
    sections_of_lines : Sections
    weight : (lines, elements, points)
        ds of each point [m].
    fields : (lines, groups, m, 3, elements, points)
        V, W [1] and Theta [rad/m or 1] of each generalized coordinate.
    model : AerodynamicModel

    Returns
    -------
    SpanLoad
    """
    points = merge_axes(fields, -2)
    diameter = np.array([line.conductor.diameter for line in lines])[:, None, None]
    factor = sections_of_lines.wind_factor.reshape(len(lines), 1, -1)
    coefficients = sections_of_lines.aerodynamics.reshape(len(lines), -1, 3, 4)
    angle = span_angles(lines, sections_of_lines, fields)
    if model is AerodynamicModel.PUBLISHED:
        forms, local = angle[..., None, :], coefficients[..., 1:]
    else:
        forms = local_motion_forms(points, arm_scale(lines)[:, None, None], factor)
        local = bundle_table(lines, coefficients, sections_of_lines.twist.reshape(len(lines), -1))
    strength = 0.5 * diameter * factor**2 * weight.reshape(len(lines), 1, -1)
    strength = (
        strength * np.array([line.wind.air_density * len(line.bundle.positions) for line in lines])[:, None, None]
    )
    arm = np.concatenate([np.ones((len(lines), 1, 1, 2)), diameter[..., None]], axis=-1)
    outputs = np.moveaxis(points, -1, 2) * (strength[..., None] * arm)[..., None, :]
    return SpanLoad(forms, outputs, local[:, None], angle)


def by_points(load: SpanLoad) -> PolynomialLoad:
    """Return the load with leading axes (lines, groups) and one point for every quadrature point."""
    return polynomial_load(load.forms, load.table, load.angle)


def span_angles(lines: Sequence[Line], sections_of_lines: Sections, fields: FloatArray) -> FloatArray:
    """Return the linear form of alpha at the quadrature points: (lines, groups, points, 2 m); as `span_load`."""
    diameter = np.array([line.conductor.diameter for line in lines])[:, None, None]
    return angle_forms(merge_axes(fields, -2), diameter, sections_of_lines.wind_factor.reshape(len(lines), 1, -1))


def angle_forms(fields: FloatArray, diameter: FloatArray, factor: FloatArray) -> FloatArray:
    """Return the linear form of alpha in (q, q'/U), eq. (16): (lines, groups, points, 2 m).

    Parameters
    ----------
    fields : (lines, groups, m, 3, points)
        V, W and Theta of each generalized coordinate.
    diameter : broadcasts to (lines, groups, points)
        Of the sub-conductors [m].
    factor : broadcasts to (lines, groups, points)
        Wind factor phi.
    """
    v, theta = fields[..., VERTICAL, :], fields[..., TORSIONAL, :]
    rates = -(v + 0.5 * diameter[..., None] * theta) / factor[..., None, :]
    return np.moveaxis(np.concatenate([theta, rates], axis=2), -1, 2)


def integrate_along_span(load: SpanLoad, active: Sequence[int]) -> PolynomialLoad:
    """Integrate a load along the span, as polynomials in the components of (q, q'/U) that it depends on.

    Parameters
    ----------
    load : SpanLoad
    active : sequence of int
        Indices into the 2 m components; the forms must vanish for all others.

    Returns
    -------
    PolynomialLoad
        With one point whose local variables are the active components.
    """
    return _of_components(polynomial.substitute(load.table, load.forms[..., list(active)]), load, active)


def integrate_each(load: SpanLoad, active: Sequence[int]) -> PolynomialLoad:
    """Integrate a load along the span whose local variable l depends on the component active[l] of (q, q'/U) alone.

    Parameters and result are those of `integrate_along_span`. Each monomial only takes a factor, so this is far faster.
    """
    factors = np.stack([load.forms[..., i, component] for i, component in enumerate(active)], axis=-1)
    # Side by side in memory, so that one product sums over points and loads.
    by_component = load.coefficients * np.ascontiguousarray(polynomial.powers(factors))[..., None, :]
    table = merge_axes(load.outputs.swapaxes(-3, -2), -2) @ merge_axes(by_component, -3, -2)
    return _of_components(table, load, active)


def _of_components(table: FloatArray, load: SpanLoad, active: Sequence[int]) -> PolynomialLoad:
    select = np.eye(load.forms.shape[-1])[list(active)]
    forms = np.broadcast_to(select, (*table.shape[:-2], 1, *select.shape))
    return polynomial_load(forms, table[..., None, :, :], load.angle)


def cheapest_load(load: SpanLoad) -> PolynomialLoad:
    """Return a load of one polynomial in all components of (q, q'/U), where that costs less than all its points.

    The number of its monomials grows with the third power of the number of components, so it pays for few coordinates.
    """
    points, local, components = load.forms.shape[-3:]
    coordinates = load.forms.any(axis=tuple(range(load.forms.ndim - 1))).reshape(2, -1).any(axis=0)  # no relief
    active = np.flatnonzero(np.tile(coordinates, 2)).tolist()
    one, each = (_products(variables, components) for variables in (len(active), local))
    if one > WORTH * points * each:
        return by_points(load)
    # One line after another, because the products of forms at all points of a stack would take much memory.
    lines = zip(load.table, load.forms[..., active], strict=True)
    return _of_components(np.stack([polynomial.substitute(*line) for line in lines]), load, active)


def _products(variables: int, components: int) -> int:
    """Return the number of multiplications that force and gradient take at a point, about."""
    outputs = components // 2
    lower = 1 + variables + polynomial.count(variables, 2)
    monomials = lower - 1 + polynomial.count(variables, 3)
    forms = 0 if variables > outputs else variables * (1 + outputs) * outputs
    return monomials * (1 + outputs) + outputs * variables * lower + forms


def published_load(
    lines: Sequence[Line], sections_of_lines: Sections, weight: FloatArray, fields: FloatArray, arc_length: FloatArray
) -> PolynomialLoad:
    """Return the load of the published closure (A14)-(A17), with f_wtheta in C_z (theory section 5): one scalar alpha'.

    Parameters are those of `span_load`, with shapes of the hybrid model: Theta is f_theta of the last coordinate, and
    V and W of each other one take the place of f_v and f_w. arc_length is L (lines,) [m]. A wind profile enters through
    means weighted with f_theta^2; the load is then an approximation that only serves for starts.
    """
    count = len(lines)
    points = merge_axes(fields, -2)
    f_theta = points[..., TORSIONAL, TORSIONAL, :]
    ds = weight.reshape(count, 1, -1)
    factor = sections_of_lines.wind_factor.reshape(count, 1, -1)
    share = 2.0 / arc_length[:, None, None, None] * (points * (f_theta * ds)[:, :, None, None]).sum(axis=-1)  # (A15)
    speed = 2.0 / arc_length[:, None] * (f_theta**2 * factor * ds).sum(axis=-1)
    square = f_theta**2
    shape_powers = np.stack([square, square * f_theta, square**2], axis=-1) * (ds * factor**2)[..., None]
    coefficients = sections_of_lines.aerodynamics.reshape(count, -1, 3, 4)[..., 1:]
    integrals = np.einsum("lpij,lgpj->lgij", coefficients, shape_powers)  # (A17)
    diameter = np.array([line.conductor.diameter for line in lines])[:, None]
    density = np.array([line.wind.air_density * len(line.bundle.positions) for line in lines])[:, None]
    arm = np.stack([np.ones_like(diameter), np.ones_like(diameter), diameter], axis=-1)
    table = (0.5 * density * diameter)[..., None, None] * ((share * arm[:, :, None]) @ integrals)
    form = np.zeros((*f_theta.shape[:2], 6))
    form[..., TORSIONAL] = 1.0
    form[..., 3:] = -share[..., VERTICAL] / speed[..., None]  # (A16)
    form[..., 3 + TORSIONAL] -= 0.5 * diameter / speed
    angle = angle_forms(points, diameter[..., None], factor)
    return polynomial_load(form[..., None, None, :], table[..., None, :, :], angle)


def of_all_members(load: SpanLoad) -> SpanLoad:
    """Join the loads on the points of members (members, groups) to that on all points of their assembly (1, groups)."""

    def joined(values: FloatArray) -> FloatArray:
        return np.concatenate(list(values), axis=1)[None]

    return SpanLoad(*(joined(getattr(load, field.name)) for field in fields(load)))


def take_load(load: PolynomialLoad, index: Any) -> PolynomialLoad:
    """Select or repeat loads along the leading axes."""
    return PolynomialLoad(*(getattr(load, field.name)[index] for field in fields(load)))
