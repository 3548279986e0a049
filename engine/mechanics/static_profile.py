"""Static profile of iced spans: catenary, tension, and the springs that restrain U at the ends. Theory section 2."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray
from engine.spec import GRAVITY, IceSegment, Line, Support


@dataclass(frozen=True, slots=True)
class StaticProfile:
    """Static state of a stack of lines; every array has the leading axis (lines,).

    span_length L_x [m]; arc_length L [m]; catenary_parameter c [m]; sag s_a [m]; horizontal_tension H per
    sub-conductor under the resultant of weight and mean drag [N]; tilt of the plane of the sag [rad];
    end_stiffness K_x per sub-conductor at the left and the right end (lines, 2) [N/m], infinite at a dead end.
    """

    span_length: FloatArray
    arc_length: FloatArray
    catenary_parameter: FloatArray
    sag: FloatArray
    horizontal_tension: FloatArray
    tilt: FloatArray
    end_stiffness: FloatArray


def static_profile(lines: Sequence[Line]) -> StaticProfile:
    """Return the static state of each line.

    The given tension, catenary parameter or sag belongs to still air. A mean drag q rotates that catenary rigidly about
    its chord by atan(q/p); equilibrium under the resultant load then requires the tension H sqrt(1 + (q/p)^2). Ice of
    varying mass enters through its mean over the span.

    Parameters
    ----------
    lines : sequence of Line

    Returns
    -------
    StaticProfile
    """
    length = np.array([line.span.length for line in lines])
    weight = GRAVITY * np.array([mean_mass(line) for line in lines])
    catenary = np.array([_catenary_parameter(line, p) for line, p in zip(lines, weight, strict=True)])
    drag_ratio = np.array([_mean_drag(line) for line in lines]) / weight
    arc = 2.0 * catenary * np.sinh(0.5 * length / catenary)
    resultant = weight * np.hypot(1.0, drag_ratio)
    ends = [_end_stiffness(*item) for item in zip(lines, resultant, catenary, strict=True)]
    return StaticProfile(
        span_length=length,
        arc_length=arc,
        catenary_parameter=catenary,
        sag=catenary * (np.cosh(0.5 * length / catenary) - 1.0),
        horizontal_tension=catenary * resultant,
        tilt=np.arctan(drag_ratio),
        end_stiffness=np.array(ends).reshape(len(lines), 2),
    )


def arc_position(profile: StaticProfile, position: FloatArray) -> FloatArray:
    """Return the arc length s [m] at horizontal distances from the left support [m], shapes (lines, ...)."""
    c = _column(profile.catenary_parameter, position)
    half = 0.5 * _column(profile.span_length, position)
    return np.asarray(c * (np.sinh((position - half) / c) + np.sinh(half / c)))


def horizontal_position(profile: StaticProfile, arc: FloatArray) -> FloatArray:
    """Return the horizontal distance from the left support [m] at arc lengths s [m], shapes (lines, ...)."""
    c = _column(profile.catenary_parameter, arc)
    half_arc = 0.5 * _column(profile.arc_length, arc)
    return np.asarray(0.5 * _column(profile.span_length, arc) + c * np.arcsinh((arc - half_arc) / c))


def coordinates(profile: StaticProfile, arc: FloatArray) -> FloatArray:
    """Return (x, y, z) [m] of the reference curve at arc lengths s [m]: shape (lines, ..., 3)."""
    c = _column(profile.catenary_parameter, arc)
    half = 0.5 * _column(profile.span_length, arc)
    tilt = _column(profile.tilt, arc)
    x = horizontal_position(profile, arc)
    drop = c * (np.cosh((x - half) / c) - np.cosh(half / c))
    return np.stack([x, drop * np.cos(tilt), -drop * np.sin(tilt)], axis=-1)


def mean_mass(line: Line) -> float:
    """Return the iced mass per length of a sub-conductor, averaged over the span [kg/m]."""
    base = line.conductor.mass
    excess = sum((_segment_mass(s, base) - base) * (s.stop - s.start) for s in line.ice.segments)
    return base + excess / line.span.length


def _segment_mass(segment: IceSegment, base: float) -> float:
    return base if segment.mass is None else segment.mass


def _column(values: FloatArray, like: FloatArray) -> FloatArray:
    return values.reshape(values.shape + (1,) * (like.ndim - values.ndim))


def _mean_drag(line: Line) -> float:
    blow_out = line.wind.blow_out
    if blow_out is None:
        return 0.0
    pressure = 0.5 * line.wind.air_density * blow_out.wind_speed**2
    return pressure * line.conductor.diameter * blow_out.drag_coefficient


def _catenary_parameter(line: Line, weight: float) -> float:
    span = line.span
    if span.catenary_parameter is not None:
        return span.catenary_parameter
    if span.horizontal_tension is not None:
        return span.horizontal_tension / weight
    assert span.sag is not None, "the span checks on construction that one measure is given"
    return _catenary_of_sag(span.length, span.sag)


def _catenary_of_sag(length: float, sag: float) -> float:
    """Solve c (cosh(L_x/2c) - 1) = sag for c by Newton's method on u = L_x/2c, from the parabola's u = 4 sag/L_x."""
    ratio = 2.0 * sag / length
    u = np.arcsinh(2.0 * ratio)
    for _ in range(60):
        value = 2.0 * np.sinh(0.5 * u) ** 2 / u - ratio
        slope = (np.sinh(u) - 2.0 * np.sinh(0.5 * u) ** 2 / u) / u
        step = value / slope
        u -= step
        if abs(step) <= 1e-15 * u:
            break
    return float(0.5 * length / u)


def _end_stiffness(line: Line, weight: float, catenary: float) -> tuple[float, float]:
    """Return K_x of both ends [N/m]: a given stiffness overrides a dead end, a dead end overrides (A10)."""
    given = line.supports.longitudinal_stiffness
    if given is not None:
        return given, given
    left, right = (
        np.inf if end.dead_end else _adjacent_stiffness(line, end, weight, catenary)
        for end in (line.supports.left, line.supports.right)
    )
    return left, right


def _adjacent_stiffness(line: Line, end: Support, weight: float, catenary: float) -> float:
    """Return K_x of eq. (A10) [N/m]: static stiffness of the adjacent span, plus that of the insulator string.

    weight is the resultant of weight and mean drag per length [N/m], assumed the same on the adjacent span. The string
    carries half of the load of both spans.
    """
    tension = catenary * weight
    rigidity = line.conductor.axial_rigidity
    adjacent = end.adjacent_span or line.span.length
    arc = 2.0 * catenary * np.sinh(0.5 * adjacent / catenary)
    stiffness = 12.0 * rigidity * tension**3 / (12.0 * arc * tension**3 + rigidity * weight**2 * adjacent**3)
    if end.insulator_length is not None:
        own_arc = 2.0 * catenary * np.sinh(0.5 * line.span.length / catenary)
        carried = 0.5 * weight * (own_arc + arc)
        stiffness += (carried + 0.5 * end.insulator_weight) / end.insulator_length
    return float(stiffness)
