"""Quasi-steady load of the relative wind at every sub-conductor, evaluated as it stands. Theory sections 13 and 14.

With b_i = V_i'/U + d Theta'/(2 U) and c_i = phi - W_i'/U, both over phi, r_i^2 = b_i^2 + c_i^2, and coefficients at the
angle of attack alpha_i = Theta - atan2(b_i, c_i) from the static angle, sub-conductor i carries per length
1/2 rho d (U phi)^2 times

    F_y,i = r_i (C_L c_i - C_D b_i),   F_z,i = r_i (C_L b_i + C_D c_i),   F_theta,i = d r_i^2 C_M.

By virtual work with (3) the section carries sum F_y,i, sum F_z,i and sum (F_theta,i + y_i F_z,i - z_i F_y,i), less
their values at rest.
"""

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from engine.arrays import FloatArray, IntArray, merge_axes
from engine.mechanics.coefficient_curves import CoefficientCurves, evaluate, local_curves
from engine.models.discretization import Discretization
from engine.spec import Analysis

ALIKE = 1e-8  # of the largest value, and rad: difference of mirror images; shapes are symmetric to some 1e-10
FEWEST_SAMPLES = 32  # of a period in the harmonic balance


@dataclass(frozen=True, slots=True)
class UnexpandedLoad:
    """Generalized load divided by U^2, by the integrals along the span at every state.

    fields: (..., points, 3, m), V, W and Theta of each generalized coordinate at the quadrature points; strength:
    (..., points), 1/2 rho d phi^2 ds [kg/m]; factor: (..., points), phi; diameter: (...) [m]; positions:
    (..., points, n, 2), y_i and z_i of the resting section [m]; present: (..., n), 1, or 0 on padding; which,
    rest_angle: (..., points), curve of each point and its angle at rest [rad]; at_rest: (..., m), the load at rest over
    U^2; at_rest_gradient: (..., m, 2 m), its derivatives there by (q, q'/U); curves: those of all members; samples: of
    a period, from which the harmonic balance takes the load's harmonics, an even number.
    """

    fields: FloatArray
    strength: FloatArray
    factor: FloatArray
    diameter: FloatArray
    positions: FloatArray
    present: FloatArray
    which: IntArray
    rest_angle: FloatArray
    at_rest: FloatArray
    at_rest_gradient: FloatArray
    curves: CoefficientCurves
    samples: int = FEWEST_SAMPLES

    def take(self, index: Any) -> "UnexpandedLoad":
        """Select or repeat loads along the leading axes."""
        names = [field.name for field in fields(self) if field.name not in ("curves", "samples")]
        return replace(self, **{name: getattr(self, name)[index] for name in names})


def take_unexpanded(load: UnexpandedLoad | None, index: Any) -> UnexpandedLoad | None:
    """Select or repeat loads along the leading axes, if there are any."""
    return None if load is None else load.take(index)


def of_all_members(load: UnexpandedLoad | None) -> UnexpandedLoad | None:
    """Join the loads on the points of members (members, groups) to that on all points of their assembly (1, groups).

    Members have the same sub-conductors.
    """
    if load is None:
        return None
    by_point = ("fields", "strength", "factor", "positions", "which", "rest_angle")
    parts: dict[str, Any] = {name: np.concatenate(list(getattr(load, name)), axis=1)[None] for name in by_point}
    parts |= {"diameter": load.diameter[:1], "present": load.present[:1]}
    sums = {name: getattr(load, name).sum(axis=0, keepdims=True) for name in ("at_rest", "at_rest_gradient")}
    return replace(load, **parts, **sums)


def load_as_it_stands(discretization: Discretization, shapes: FloatArray, analysis: Analysis) -> UnexpandedLoad | None:
    """Return the unexpanded load where an analysis asks for it; parameters are those of `unexpanded_load`."""
    return unexpanded_load(discretization, shapes) if analysis.load_stands else None


def unexpanded_load(discretization: Discretization, shapes: FloatArray) -> UnexpandedLoad:
    """Return the load of lines about their static state.

    Parameters
    ----------
    discretization : Discretization
    shapes : (lines, groups, m, 3, elements, points)
        V, W and Theta of each generalized coordinate at the quadrature points.

    Returns
    -------
    UnexpandedLoad
        With leading axes (lines, groups).
    """
    lines, sections = discretization.lines, discretization.sections
    groups = (len(lines), shapes.shape[1])
    values = np.moveaxis(merge_axes(shapes, -2), (2, 3, 4), (4, 3, 2))
    diameter, density = (
        np.array(column) for column in zip(*((x.conductor.diameter, x.wind.air_density) for x in lines), strict=True)
    )
    factor = _flat(sections.wind_factor)
    local = local_curves(lines, discretization.profile, sections)
    positions, present = _positions(discretization)
    strength = 0.5 * (density * diameter)[:, None] * factor**2 * _flat(discretization.matrices.weight)

    def grouped(values: Any) -> Any:
        return np.broadcast_to(values[:, None], (*groups, *values.shape[1:]))

    load = _folded(
        UnexpandedLoad(
            fields=values,
            strength=grouped(strength),
            factor=grouped(factor),
            diameter=grouped(diameter),
            positions=grouped(positions),
            present=grouped(present),
            which=grouped(_flat(local.which)),
            rest_angle=grouped(_flat(local.angle)),
            at_rest=np.zeros((*groups, values.shape[-1])),
            at_rest_gradient=np.zeros((*groups, values.shape[-1], 2 * values.shape[-1])),
            curves=local.curves,
        )
    )
    wind = _wind_at_rest(load)
    at_rest, gradient = _generalized(load, wind), _generalized_gradient(load, wind)
    return replace(load, at_rest=at_rest[..., 0, :], at_rest_gradient=gradient[..., 0, :, :])


def _folded(load: UnexpandedLoad) -> UnexpandedLoad:
    """Let each point count for its mirror image, too, where a line and its shapes are symmetric about the middle.

    The image gets no strength, as padding has none. Every line of a stack is judged by itself.
    """
    symmetric = np.asarray((load.which == load.which[..., ::-1]).all(axis=-1))
    for values, axes in ((load.fields, 3), (load.positions, 3), (load.strength, 1), (load.factor, 1)):
        image = np.flip(values, axis=-axes)
        every = tuple(range(-axes, 0))
        symmetric &= np.abs(values - image).max(axis=every) <= ALIKE * np.abs(values).max(axis=every)
    symmetric &= np.abs(load.rest_angle - load.rest_angle[..., ::-1]).max(axis=-1) <= ALIKE
    points = load.strength.shape[-1]
    share = np.where(2 * np.arange(points) + 1 < points, 2.0, 0.0)
    share[points // 2 : points // 2 + points % 2] = 1.0
    return replace(load, strength=load.strength * np.where(symmetric[..., None], share, 1.0))


def force(load: UnexpandedLoad, state: FloatArray) -> FloatArray:
    """Evaluate the load divided by U^2 at states (..., samples, 2 m) of q and q'/U: (..., samples, m)."""
    return _generalized(load, _relative_wind(load, state))


def force_gradient(load: UnexpandedLoad, state: FloatArray) -> FloatArray:
    """Differentiate the load divided by U^2 by (q, q'/U) at states (..., samples, 2 m): (..., samples, m, 2 m)."""
    return _generalized_gradient(load, _relative_wind(load, state))


def _generalized(load: UnexpandedLoad, wind: "_RelativeWind") -> FloatArray:
    along, across, moment = _forces(load, wind)
    total = np.stack([along.sum(-2), across.sum(-2), _about_reference(load, along, across, moment).sum(-2)], axis=-2)
    weighted = merge_axes(load.strength[..., None, None] * total, -3, -2)
    generalized = merge_axes(load.fields, -3, -2).swapaxes(-1, -2) @ weighted
    return np.asarray(generalized.swapaxes(-1, -2) - load.at_rest[..., None, :])


def _generalized_gradient(load: UnexpandedLoad, wind: "_RelativeWind") -> FloatArray:
    rows = np.stack([_section_row(load, wind, variable) for variable in range(3)], axis=-1)
    z, y = load.positions[..., 1, None], load.positions[..., 0, None]
    lever = 0.5 * load.diameter[..., None, None, None] - z
    phi = load.factor[..., None, None]
    # Columns: by Theta, V'/U, W'/U and Theta'/U of the section, summed over the sub-conductors.
    by_rise, by_calm = rows[..., 1] / phi[..., None, :, :], rows[..., 2] / phi[..., None, :, :]
    by_section = np.stack(
        [
            rows[..., 0].sum(-2),
            by_rise.sum(-2),
            -by_calm.sum(-2),
            (lever[..., None, :, :] * by_rise - y[..., None, :, :] * by_calm).sum(-2),
        ],
        axis=-1,
    )
    matrices = np.moveaxis(by_section, -2, -4) * load.strength[..., None, :, None, None]
    v, w, theta = (load.fields[..., i, :] for i in range(3))
    none = np.zeros_like(v)
    reader = np.concatenate(
        [np.stack([theta, none, none, none], axis=-2), np.stack([none, v, w, theta], axis=-2)], axis=-1
    )
    left = merge_axes(load.fields, -3, -2).swapaxes(-1, -2)[..., None, :, :]
    return np.asarray(left @ merge_axes(matrices @ reader[..., None, :, :, :], -3, -2))


@dataclass(frozen=True, slots=True)
class _RelativeWind:
    """The wind that each sub-conductor sees, over U phi: (..., points, n, samples).

    rise, calm: b and c; speed: r; values, slopes: (..., 3), coefficients there and their slopes.
    """

    rise: FloatArray
    calm: FloatArray
    speed: FloatArray
    values: FloatArray
    slopes: FloatArray


def _relative_wind(load: UnexpandedLoad, state: FloatArray) -> _RelativeWind:
    m = load.fields.shape[-1]
    rows = merge_axes(load.fields, -3, -2)
    shape = (*load.fields.shape[:-1], state.shape[-2])
    q = (rows @ state[..., :m].swapaxes(-1, -2)).reshape(shape)
    rate = (rows @ state[..., m:].swapaxes(-1, -2)).reshape(shape)
    theta, turning = q[..., 2, None, :], rate[..., 2, None, :]
    y, z = load.positions[..., 0, None], load.positions[..., 1, None]
    phi = load.factor[..., None, None]
    lever = 0.5 * load.diameter[..., None, None, None] - z
    rise = (rate[..., 0, None, :] + lever * turning) / phi
    calm = 1.0 - (rate[..., 1, None, :] + y * turning) / phi
    angle = load.rest_angle[..., None, None] + theta - np.arctan2(rise, calm)
    which = np.broadcast_to(load.which[..., None, None], angle.shape)
    values, slopes = evaluate(load.curves, which, angle)
    here = load.present[..., None, :, None, None]
    return _RelativeWind(rise, calm, np.hypot(rise, calm), values * here, slopes * here)


def _wind_at_rest(load: UnexpandedLoad) -> _RelativeWind:
    """Return the wind without motion, which is the same for all sub-conductors at a point."""
    coefficients = evaluate(load.curves, load.which, load.rest_angle)
    here = load.present[..., None, :, None, None]
    values, slopes = (part[..., None, None, :] * here for part in coefficients)
    calm = np.ones(values.shape[:-1])
    return _RelativeWind(np.zeros(calm.shape), calm, calm, values, slopes)


def _forces(load: UnexpandedLoad, wind: _RelativeWind) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return F_y, F_z and F_theta of each sub-conductor: (..., points, n, samples) each."""
    lift, drag, moment = (wind.values[..., i] for i in range(3))
    along = wind.speed * (lift * wind.calm - drag * wind.rise)
    across = wind.speed * (lift * wind.rise + drag * wind.calm)
    return along, across, load.diameter[..., None, None, None] * wind.speed**2 * moment


def _about_reference(load: UnexpandedLoad, along: FloatArray, across: FloatArray, moment: FloatArray) -> FloatArray:
    """Return the moment about the reference curve of forces on each sub-conductor."""
    return moment + load.positions[..., 0, None] * across - load.positions[..., 1, None] * along


def _section_row(load: UnexpandedLoad, wind: _RelativeWind, variable: int) -> FloatArray:
    """Differentiate the forces of each sub-conductor by Theta, b or c: (..., points, 3, n, samples)."""
    lift, drag, moment = (wind.values[..., i] for i in range(3))
    turn = (1.0, -wind.calm / wind.speed**2, wind.rise / wind.speed**2)[variable]
    lift_slope, drag_slope, moment_slope = (wind.slopes[..., i] * turn for i in range(3))
    b, c, r = wind.rise, wind.calm, wind.speed
    along = r * (lift_slope * c - drag_slope * b)
    across = r * (lift_slope * b + drag_slope * c)
    torque = r**2 * moment_slope
    if variable == 1:
        along += b / r * (lift * c - drag * b) - r * drag
        across += b / r * (lift * b + drag * c) + r * lift
        torque += 2.0 * b * moment
    elif variable == 2:
        along += c / r * (lift * c - drag * b) + r * lift
        across += c / r * (lift * b + drag * c) + r * drag
        torque += 2.0 * c * moment
    whole = _about_reference(load, along, across, load.diameter[..., None, None, None] * torque)
    return np.stack([along, across, whole], axis=-3)


def _positions(discretization: Discretization) -> tuple[FloatArray, FloatArray]:
    """Return (y_i, z_i) turned by the static twist, (lines, points, n, 2), and which are no padding: (lines, n)."""
    most = max(len(line.bundle.positions) for line in discretization.lines)
    flat = np.zeros((len(discretization.lines), most, 2))
    present = np.zeros(flat.shape[:2])
    for i, line in enumerate(discretization.lines):
        flat[i, : len(line.bundle.positions)] = line.bundle.positions
        present[i, : len(line.bundle.positions)] = 1.0
    twist = _flat(discretization.sections.twist)[..., None]
    y, z = flat[:, None, :, 0], flat[:, None, :, 1]
    c, s = np.cos(twist), np.sin(twist)
    return np.stack([c * y - s * z, s * y + c * z], axis=-1), present


def _flat(values: Any) -> Any:
    return values.reshape(values.shape[0], -1)
