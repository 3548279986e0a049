"""Static profile of iced spans: catenary, tension, and the springs that restrain U at the ends. Theory section 2."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import FloatArray
from engine.mechanics.along_span import mean_drag, mean_mass
from engine.mechanics.blow_out import StillSpans, plane_axes, plane_extent, tension_in_wind
from engine.mechanics.catenary import arc_length, catenary_of_sag, chord_sag, low_point
from engine.outcome import Fault, require
from engine.spec import GRAVITY, Line, Support


@dataclass(frozen=True, slots=True)
class StaticProfile:
    """Static state of a stack of lines; every array has the leading axis (lines,).

    The curve is a catenary in a plane that mean drag turns. span_length L_x [m], horizontal along X; plane_span: extent
    of the curve in its plane, across the resultant load [m]; low_point: x_0 in the plane, from the left support [m];
    arc_length L [m]; catenary_parameter c [m]; sag s_a from the chord, in the plane [m]; horizontal_tension: H along X
    per sub-conductor [N]; tilt of the plane of the sag [rad]; axes (lines, 3, 3): the axes of the plane in (X, Y, Z),
    along, up against the resultant load, and out of the plane; end_stiffness K_x per sub-conductor at the left and the
    right end (lines, 2) [N/m], infinite at a dead end; yoke_stiffness: the same against moving along the span beyond
    the others of a free section, infinite at a held yoke.
    """

    span_length: FloatArray
    plane_span: FloatArray
    low_point: FloatArray
    arc_length: FloatArray
    catenary_parameter: FloatArray
    sag: FloatArray
    horizontal_tension: FloatArray
    tilt: FloatArray
    axes: FloatArray
    end_stiffness: FloatArray
    yoke_stiffness: FloatArray


def static_profile(lines: Sequence[Line]) -> StaticProfile:
    """Return the static state of each line.

    The given tension, catenary parameter or sag belongs to still air. Mean drag q turns the plane of the sag by
    atan(q/p); the tension then follows from the unstressed length that still air leaves, with end springs that keep
    their stiffness. The curve spans the given length; only its tension takes the give of the springs into account. Ice
    of varying mass enters through its mean over the span. Theory section 15.

    Parameters
    ----------
    lines : sequence of Line

    Returns
    -------
    StaticProfile

    Raises
    ------
    InvalidSpec
        If the conductor pulls an insulator string up.
    """
    require(*(fault for line in lines for fault in string_faults(line)))
    length = np.array([line.span.length for line in lines])
    rise = np.array([line.span.level_difference for line in lines])
    weight = GRAVITY * np.array([mean_mass(line) for line in lines])
    still = np.array([_catenary_parameter(line, p) for line, p in zip(lines, weight, strict=True)])
    hanging = list(zip(lines, weight.tolist(), still.tolist(), low_point(still, length, rise).tolist(), strict=True))
    ends = np.array([_end_stiffness(*item) for item in hanging]).reshape(len(lines), 2)
    yokes = [_yoke_stiffness(*item) for item in hanging]
    tilt = np.arctan(np.array([mean_drag(line) for line in lines]) / weight)
    rigidity = np.array([line.conductor.axial_rigidity for line in lines])
    hung = StillSpans(length, rise, weight, rigidity, still * weight, (1.0 / ends).sum(axis=1))
    tension = tension_in_wind(hung, tilt)
    plane_span, plane_rise = plane_extent(length, rise, tilt)
    catenary = still * (tension / (still * weight)) * (plane_span / length) * np.cos(tilt)
    return StaticProfile(
        span_length=length,
        plane_span=plane_span,
        low_point=low_point(catenary, plane_span, plane_rise),
        arc_length=arc_length(catenary, plane_span, plane_rise),
        catenary_parameter=catenary,
        sag=chord_sag(catenary, plane_span, plane_rise),
        horizontal_tension=tension,
        tilt=tilt,
        axes=plane_axes(length, rise, tilt),
        end_stiffness=ends,
        yoke_stiffness=np.array(yokes).reshape(len(lines), 2),
    )


def end_steepness(profile: StaticProfile) -> FloatArray:
    """Return ds/dx at the steeper end, the ratio of the tension there to its horizontal component: (lines,)."""
    ends = np.stack([np.zeros_like(profile.low_point), profile.plane_span], axis=-1) - profile.low_point[:, None]
    slope = ends / profile.catenary_parameter[:, None]
    along, up = profile.axes[:, 0, :1], profile.axes[:, 1, :1]
    return np.asarray((np.cosh(slope) / (along + up * np.sinh(slope))).max(axis=-1))


def arc_position(profile: StaticProfile, position: FloatArray) -> FloatArray:
    """Return the arc length s [m] at horizontal distances from the left support [m], shapes (lines, ...)."""
    c, low = (_column(values, position) for values in (profile.catenary_parameter, profile.low_point))
    x = position * _column(profile.plane_span / profile.span_length, position)
    return np.asarray(c * (np.sinh((x - low) / c) + np.sinh(low / c)))


def horizontal_position(profile: StaticProfile, arc: FloatArray) -> FloatArray:
    """Return the horizontal distance from the left support [m] at arc lengths s [m], shapes (lines, ...)."""
    return np.asarray(_plane_position(profile, arc) * _column(profile.span_length / profile.plane_span, arc))


def coordinates(profile: StaticProfile, arc: FloatArray) -> FloatArray:
    """Return (x, y, z) [m] of the reference curve at arc lengths s [m]: shape (lines, ..., 3)."""
    c, low = (_column(values, arc) for values in (profile.catenary_parameter, profile.low_point))
    x = _plane_position(profile, arc)
    height = 2.0 * c * np.sinh(0.5 * x / c) * np.sinh((0.5 * x - low) / c)
    along, up, _ = (_column(axis, arc[..., None]) for axis in np.moveaxis(profile.axes, 1, 0))
    return np.asarray(x[..., None] * along + height[..., None] * up)


def _plane_position(profile: StaticProfile, arc: FloatArray) -> FloatArray:
    c, low = (_column(values, arc) for values in (profile.catenary_parameter, profile.low_point))
    return np.asarray(low + c * np.arcsinh(arc / c - np.sinh(low / c)))


def _column(values: FloatArray, like: FloatArray) -> FloatArray:
    """Insert axes after the first, so that values (lines, ...) broadcast against an array of as many axes as `like`."""
    return values.reshape(values.shape[0], *(1,) * (like.ndim - values.ndim), *values.shape[1:])


def _catenary_parameter(line: Line, weight: float) -> float:
    span = line.span
    if span.catenary_parameter is not None:
        return span.catenary_parameter
    if span.horizontal_tension is not None:
        return span.horizontal_tension / weight
    assert span.sag is not None, "the span checks on construction that one measure is given"
    return catenary_of_sag(span.sag, span.length, span.level_difference)


def string_faults(line: Line) -> Iterator[Fault]:
    """Yield a fault for every insulator string that the span pulls up in still air, so that it cannot hang."""
    if line.span.level_difference == 0.0 or line.supports.longitudinal_stiffness is not None:
        return
    weight = GRAVITY * mean_mass(line)
    catenary = _catenary_parameter(line, weight)
    low = float(low_point(np.array(catenary), np.array(line.span.length), np.array(line.span.level_difference)))
    for name, end, own in _ends(line, low):
        if end.dead_end or end.insulator_length is None:
            continue
        carried = _carried(line, end, weight, catenary, own) + 0.5 * end.insulator_weight
        if carried <= 0.0:
            rule = f"must be absent: the string cannot hang where the conductor pulls it up by {-carried:.0f} N"
            yield Fault(f"supports.{name}.insulator_length", end.insulator_length, rule)


def _ends(line: Line, low: float) -> Iterator[tuple[str, Support, float]]:
    """Yield both ends by name with their horizontal distance from the low point, negative beyond it [m]."""
    yield "left", line.supports.left, low
    yield "right", line.supports.right, line.span.length - low


def _end_stiffness(line: Line, weight: float, catenary: float, low: float) -> tuple[float, float]:
    """Return K_x of both ends [N/m]: a given stiffness overrides a dead end, a dead end overrides (A10).

    low: horizontal distance of the low point from the left support [m].
    """
    given = line.supports.longitudinal_stiffness
    if given is not None:
        return given, given
    left, right = (
        np.inf if end.dead_end else _adjacent_stiffness(line, end, weight, catenary, own)
        for _, end, own in _ends(line, low)
    )
    return left, right


def _yoke_stiffness(line: Line, weight: float, catenary: float, low: float) -> tuple[float, float]:
    """Return what resists a sub-conductor of a free section beyond the mean of all, along both ends [N/m].

    At a free yoke that is its own continuation in the adjacent span, without the string, which holds only the middle of
    the yoke; at a dead end there is none.
    """
    given = line.supports.longitudinal_stiffness

    def of_end(end: Support, own: float) -> float:
        if end.holds_differences:
            return math.inf
        if given is not None:
            return given
        bare = replace(end, insulator_length=None)
        return 0.0 if end.dead_end else _adjacent_stiffness(line, bare, weight, catenary, own)

    left, right = (of_end(end, own) for _, end, own in _ends(line, low))
    return left, right


def _adjacent_stiffness(line: Line, end: Support, weight: float, catenary: float, own: float) -> float:
    """Return K_x of eq. (A10) in still air [N/m]: static stiffness of the adjacent span, plus that of the string."""
    tension = catenary * weight
    rigidity = line.conductor.axial_rigidity
    adjacent = end.adjacent_span or line.span.length
    arc = 2.0 * catenary * np.sinh(0.5 * adjacent / catenary)
    stiffness = 12.0 * rigidity * tension**3 / (12.0 * arc * tension**3 + rigidity * weight**2 * adjacent**3)
    if end.insulator_length is not None:
        carried = _carried(line, end, weight, catenary, own)
        stiffness += (carried + 0.5 * end.insulator_weight) / end.insulator_length
    return float(stiffness)


def _carried(line: Line, end: Support, weight: float, catenary: float, own: float) -> float:
    """Return the vertical parts of the tensions of this and of the adjacent span, which is level, at a support [N].

    own: horizontal distance of the support from the low point of this span [m].
    """
    adjacent = end.adjacent_span or line.span.length
    return float(weight * catenary * (np.sinh(own / catenary) + np.sinh(0.5 * adjacent / catenary)))
