"""Lift, drag and moment coefficients as functions of the angle: splines of tables, and cubics. Theory section 14.

All curves of a stack of lines stand one after another in the same arrays, so that points with different coefficients
are evaluated together.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.mechanics.along_span import coefficients_along
from engine.mechanics.cross_sections import Sections, positions
from engine.mechanics.static_profile import StaticProfile
from engine.spec import CLOSED, TURN, Aerodynamics, Line, MeasuredCoefficients

SPACING = 32.0  # rad between the search keys of two curves: more than a full turn and its margins
MARGIN = 1.0  # rad beyond the ends of a table, within which the search keys of the linear pieces lie
EQUAL = 1e-13  # rad: largest error of the beginning of a piece that is as long as the others
ORDER = 3
FIT_POINTS = 41  # angles at which a curve is evaluated to fit a cubic to it
LIFT, DRAG, MOMENT = range(3)


@dataclass(frozen=True, slots=True)
class CoefficientCurves:
    """Coefficients of one sub-conductor as piecewise cubics of the angle, curve after curve.

    A table gives C_L, C_D and C_M over its own angle: a periodic spline if it covers the circle, otherwise a natural
    one, continued linearly beyond its ends. Cubics give C_y, C_z and C_theta, fixed to the section, over the angle of
    attack. keys: (pieces,), ascending, curve times `SPACING` plus where the piece begins; knots: (pieces,), the angle
    from which a piece counts its distance [rad]; powers: (pieces, 3, 4), factors of the powers 0 to 3 of that distance;
    origin: (curves,), angle of the first row [rad]; lowest, highest: (curves,), the angles between which the curve
    holds, infinite for a full circle [rad]; periodic, turning: (curves,), whether a curve repeats itself, and whether
    it is fixed to the section.
    """

    keys: FloatArray
    knots: FloatArray
    powers: FloatArray
    origin: FloatArray
    lowest: FloatArray
    highest: FloatArray
    periodic: BoolArray
    turning: BoolArray

    @property
    def pieces(self) -> tuple[IntArray, FloatArray]:
        """The first piece of each curve and, last, the number of pieces, (curves + 1,); where each begins [rad]."""
        count = self.origin.size
        first = np.searchsorted(self.keys, np.arange(count + 1) * SPACING - 3.0 * MARGIN)
        return first, self.keys - np.repeat(np.arange(count), np.diff(first)) * SPACING

    @property
    def density(self) -> FloatArray:
        """The number of pieces a radian where those between the first and the last row are equally long, else 0."""
        first, begins = self.pieces
        return np.array([_density(part[part >= 0.0]) for part in np.split(begins, first[1:-1])])


@dataclass(frozen=True, slots=True)
class LocalCurves:
    """The curve at each quadrature point of a stack of lines, and the angle at which the section rests there.

    which, angle: (lines, elements, points), index into the curves and angle over which that curve is given [rad]: the
    static angle of a table with the static twist, or zero for cubics, which hold for the section as it hangs.
    """

    curves: CoefficientCurves
    which: IntArray
    angle: FloatArray


def local_curves(lines: Sequence[Line], profile: StaticProfile, section_points: Sections) -> LocalCurves:
    """Return the curves at the quadrature points, of a device, else of an ice segment, else of the span."""
    numbers: dict[Aerodynamics, int] = {}
    stretches: dict[int, list[tuple[float, float, int]]] = {}  # of each line, which a stack may repeat
    which = np.empty(section_points.local.shape, dtype=np.intp)
    for line, place, x in zip(lines, which, positions(profile, section_points.local), strict=True):
        if id(line) not in stretches:
            parts = coefficients_along(line)
            stretches[id(line)] = [(start, stop, numbers.setdefault(one, len(numbers))) for start, stop, one in parts]
        for start, stop, number in stretches[id(line)]:
            place[(x >= start) & (x < stop)] = number
    static = np.array([0.0 if one.measured is None else one.measured.static_angle for one in numbers])
    tabulated = np.array([one.measured is not None for one in numbers])
    angle = np.where(tabulated[which], static[which] + section_points.twist, 0.0)
    return LocalCurves(coefficient_curves(tuple(numbers)), which, angle)


@lru_cache
def coefficient_curves(sources: tuple[Aerodynamics, ...]) -> CoefficientCurves:
    """Return the curves of some coefficients: the spline of the measured table where there is one, else the cubics."""
    parts = [_cubic_pieces(one) if one.measured is None else _table_pieces(one.measured) for one in sources]
    ends = [_ends(one) for one in sources]
    closed = np.array([one.measured is not None and one.measured.closes_circle for one in sources])
    return CoefficientCurves(
        keys=np.concatenate([i * SPACING + keys for i, (keys, _, _) in enumerate(parts)]),
        knots=np.concatenate([knots for _, knots, _ in parts]),
        powers=np.concatenate([powers for _, _, powers in parts]),
        origin=np.array([0.0 if one.measured is None else one.measured.angle[0] for one in sources]),
        lowest=np.array([lowest for lowest, _ in ends]),
        highest=np.array([highest for _, highest in ends]),
        periodic=closed,
        turning=np.array([one.measured is None for one in sources]),
    )


def evaluate(curves: CoefficientCurves, which: IntArray, angle: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Evaluate curves (...) at angles (...) [rad].

    Returns
    -------
    (..., 3), (..., 3)
        C_L, C_D and C_M, fixed to the wind, and their slopes [1/rad]. The angle is the table's, or for cubics that of
        attack.
    """
    piece, distance = _located(curves, which, angle)
    # Power by power, because sums of strided columns take several times as long.
    first, second, third, fourth = (np.take(curves.powers[..., power], piece, axis=0) for power in range(ORDER + 1))
    x = distance[..., None]
    bend = x * fourth
    values = first + x * (second + x * (third + bend))
    slopes = second + x * (2.0 * third + 3.0 * bend)
    turning = curves.turning[which]
    if turning.any():
        _turn_to_wind(values, slopes, np.where(turning, angle, 0.0), turning)
    return values, slopes


def outside(curves: CoefficientCurves, which: IntArray, angle: FloatArray) -> BoolArray:
    """Return where an angle (...) [rad] lies beyond the stretch, or the fitted range, of its curve (...)."""
    return np.asarray((angle < curves.lowest[which]) | (angle > curves.highest[which]))


def reach(local: LocalCurves, here: BoolArray) -> FloatArray:
    """Return the angle of attack up to which the curves of each line hold at rest, either way: (lines,) [rad].

    here: (lines, elements, points), the points that are no padding. It is pi for tables of the circle and infinite for
    cubics without a range.
    """
    curves, which = local.curves, local.which
    own = np.minimum(curves.highest[which] - local.angle, local.angle - curves.lowest[which])
    own = np.where(curves.periodic[which], np.pi, np.maximum(own, 0.0))
    return np.asarray(np.where(here, own, np.inf).min(axis=(1, 2)))


def largest_moment_slopes(curves: CoefficientCurves) -> FloatArray:
    """Return the largest slope of C_M over all angles, curve by curve: (curves,), infinite for cubics [1/rad]."""
    count = curves.origin.size
    owner = np.repeat(np.arange(count), np.diff(curves.pieces[0]))
    ends = np.append(curves.keys[1:], count * SPACING)
    widths = np.minimum(ends, owner * SPACING + TURN) - curves.keys
    _, first, second, third = curves.powers[:, MOMENT].T
    with np.errstate(divide="ignore", invalid="ignore"):
        vertex = np.clip(np.nan_to_num(-second / (3.0 * third)), 0.0, np.maximum(widths, 0.0))
    at = np.stack([np.zeros_like(vertex), vertex, np.maximum(widths, 0.0)])
    steepest = (first + 2.0 * second * at + 3.0 * third * at**2).max(axis=0)
    largest = np.full(count, -np.inf)
    np.maximum.at(largest, owner, steepest)
    return np.where(curves.turning, np.inf, largest)


def cubics_about(
    curves: CoefficientCurves, which: IntArray, angle: FloatArray, half_range: float | None = None
) -> FloatArray:
    """Return cubics of the coefficients fixed to a section that rests at angles (...): (..., 3, 4), a_i0 to a_i3.

    half_range: cubics are fitted over this distance to both sides of the angle [rad]; None takes the curve's own
    derivatives.
    """
    if half_range is None:
        return _expanded(curves, which, angle)
    alpha = np.linspace(-half_range, half_range, FIT_POINTS)
    values, _ = evaluate(curves, which[..., None], angle[..., None] + alpha)
    lift, drag, moment = np.moveaxis(values, -1, 0)
    c, s = np.cos(alpha), np.sin(alpha)
    return np.asarray(np.stack([lift * c + drag * s, drag * c - lift * s, moment], axis=-2) @ _fit_matrix(half_range).T)


@lru_cache
def _fit_matrix(half_range: float) -> FloatArray:
    alpha = np.linspace(-half_range, half_range, FIT_POINTS)
    return np.asarray(np.linalg.pinv(alpha[:, None] ** np.arange(ORDER + 1)))


def _expanded(curves: CoefficientCurves, which: IntArray, angle: FloatArray) -> FloatArray:
    """Return the Taylor series about angles (...) of coefficients fixed to the section, to third order."""
    piece, x = _located(curves, which, angle)
    first, second, third, fourth = np.moveaxis(curves.powers[piece], -1, 0)
    x = x[..., None]
    series = np.stack(
        [
            first + x * (second + x * (third + x * fourth)),
            second + x * (2.0 * third + 3.0 * x * fourth),
            third + 3.0 * x * fourth,
            fourth,
        ],
        axis=-1,
    )
    shift = np.where(curves.turning[which], angle, 0.0)
    c, s = np.cos(shift)[..., None], np.sin(shift)[..., None]
    # A cubic about another angle stays fixed to the section at zero, which is turned from the section as it rests.
    lift, drag = c * series[..., 0, :] - s * series[..., 1, :], s * series[..., 0, :] + c * series[..., 1, :]
    vertical = np.where(curves.turning[which][..., None], lift, _product(lift, _COSINE) + _product(drag, _SINE))
    horizontal = np.where(curves.turning[which][..., None], drag, _product(drag, _COSINE) - _product(lift, _SINE))
    return np.stack([vertical, horizontal, series[..., MOMENT, :]], axis=-2)


_COSINE = np.array([1.0, 0.0, -0.5, 0.0])
_SINE = np.array([0.0, 1.0, 0.0, -1.0 / 6.0])


def _product(a: FloatArray, b: FloatArray) -> FloatArray:
    """Multiply power series (..., 4) and (4,), truncated to third order."""
    total = np.zeros_like(a)
    for j in range(ORDER + 1):
        total[..., j:] += b[j] * a[..., : ORDER + 1 - j]
    return total


def _located(curves: CoefficientCurves, which: IntArray, angle: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return the piece of each angle, and the distance from that piece's knot [rad]."""
    reach = angle - curves.origin[which]
    periodic = curves.periodic[which]
    reach = np.where(periodic, reach % TURN, reach)
    key = which * SPACING + np.clip(reach, -MARGIN, TURN + MARGIN)
    piece = np.searchsorted(curves.keys, key, side="right") - 1
    return piece, reach + curves.origin[which] - curves.knots[piece]


def _turn_to_wind(values: FloatArray, slopes: FloatArray, angle: FloatArray, turning: BoolArray) -> None:
    """Turn C_y and C_z by their angle to C_L and C_D where a curve is fixed to the section, in place."""
    c, s = np.cos(angle), np.sin(angle)
    y, z, y_slope, z_slope = values[..., 0].copy(), values[..., 1].copy(), slopes[..., 0].copy(), slopes[..., 1].copy()
    lift, drag = c * y - s * z, s * y + c * z
    values[..., LIFT], values[..., DRAG] = lift, drag
    slopes[..., LIFT] = c * y_slope - s * z_slope - np.where(turning, drag, 0.0)
    slopes[..., DRAG] = s * y_slope + c * z_slope + np.where(turning, lift, 0.0)


def _cubic_pieces(cubics: Aerodynamics) -> tuple[FloatArray, FloatArray, FloatArray]:
    at_rest = cubics.at_rest or (0.0, 0.0, 0.0)
    rows = (cubics.vertical, cubics.horizontal, cubics.torsional)
    powers = np.array([[(a_0, *row) for a_0, row in zip(at_rest, rows, strict=True)]])
    return np.array([-2.0 * MARGIN]), np.zeros(1), powers


@lru_cache
def _table_pieces(table: MeasuredCoefficients) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return keys, knots and powers of the spline through a table."""
    from scipy.interpolate import CubicSpline  # noqa: PLC0415 - scipy is only imported for tables

    angle = np.array(table.angle)
    columns = np.stack([table.lift, table.drag, table.moment], axis=-1)
    if table.closes_circle:
        if angle[-1] - angle[0] < TURN * (1.0 - CLOSED):
            angle, columns = np.append(angle, angle[0] + TURN), np.append(columns, columns[:1], axis=0)
        columns[-1] = columns[0]
        factors = CubicSpline(angle, columns, bc_type="periodic").c
        return angle[:-1] - angle[0], angle[:-1], np.transpose(factors[::-1], (1, 2, 0))
    factors = CubicSpline(angle, columns, bc_type="natural").c
    powers = np.transpose(factors[::-1], (1, 2, 0))
    left, right = np.zeros((2, 1, 3, ORDER + 1))
    left[0, :, :2] = powers[0, :, :2]
    width = angle[-1] - angle[-2]
    right[0, :, 0] = columns[-1]
    right[0, :, 1] = powers[-1] @ (np.arange(ORDER + 1) * width ** np.maximum(np.arange(ORDER + 1) - 1.0, 0.0))
    knots = np.concatenate([angle[:1], angle])
    keys = np.concatenate([[-2.0 * MARGIN], angle - angle[0]])
    return keys, knots, np.concatenate([left, powers, right])


def _density(begins: FloatArray) -> float:
    """Return how many of the pieces that begin at these distances make a radian, 0 if they differ in length."""
    if begins.size < 2:
        return 0.0
    density = (begins.size - 1) / begins[-1]
    return float(density) if np.abs(begins - np.arange(begins.size) / density).max() < EQUAL else 0.0


def _ends(source: Aerodynamics) -> tuple[float, float]:
    """Return the angles between which coefficients hold [rad]."""
    if source.measured is None:
        reach = np.inf if source.fitted_range is None else source.fitted_range
        return -reach, reach
    if source.measured.closes_circle:
        return -np.inf, np.inf
    return source.measured.angle[0], source.measured.angle[-1]
