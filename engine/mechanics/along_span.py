"""What a line has at horizontal positions along its span: pieces, wind, coefficients, mean mass and mean drag."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from engine.arrays import FloatArray
from engine.spec import Aerodynamics, IceSegment, Line, StretchDevice

_SIMPSON = np.array([1.0, 4.0, 1.0]) / 6.0


def boundaries(line: Line) -> list[float]:
    """Return the positions strictly inside the span where a property or the wind's slope jumps [m], ascending."""
    parts: list[IceSegment | StretchDevice] = [*line.ice.segments, *line.stretches]
    stretches = [(part.start, part.stop) for part in parts]
    marks = {mark for stretch in stretches for mark in stretch} | {position for position, _ in line.wind.profile}
    return sorted(mark for mark in marks if 0.0 < mark < line.span.length)


def wind_factor(line: Line, position: FloatArray) -> FloatArray:
    """Return the wind factor phi at horizontal positions (...) [m]: linear between the profile's points.

    Of a yawed wind only the component across the line counts (cross-flow principle). Theory section 16.
    """
    across = math.cos(line.wind.yaw)
    if not line.wind.profile:
        return np.full(position.shape, across)
    marks, factors = zip(*line.wind.profile, strict=True)
    return np.asarray(across * np.interp(position, marks, factors))


def coefficients_along(line: Line) -> Iterator[tuple[float, float, Aerodynamics]]:
    """Yield the coefficients of the span, then of each stretch [m] that has its own; later ones override.

    A stretch that does not say its coefficients at rest has those of the span (theory section 13).
    """
    yield -np.inf, np.inf, line.ice.aerodynamics
    parts: list[IceSegment | StretchDevice] = [*line.ice.segments, *line.stretches]
    for part in parts:
        own = part.aerodynamics
        if own is not None:
            at_rest = line.ice.aerodynamics.at_rest if own.at_rest is None else own.at_rest
            yield part.start, part.stop, replace(own, at_rest=at_rest)


def mean_mass(line: Line) -> float:
    """Return the iced mass per length of a sub-conductor, averaged over the span [kg/m]."""
    base = line.conductor.mass
    excess = sum((_segment_mass(s, base) - base) * (s.stop - s.start) for s in line.ice.segments)
    return base + excess / line.span.length


def mean_drag(line: Line) -> float:
    """Return the drag per length of a sub-conductor in the wind of the blow-out, averaged over the span [N/m].

    Zero without blow-out, and where its wind speed is left to the analysis: that is the line in still air. Without a
    drag coefficient it is that at rest, C_z0, of each stretch.
    """
    blow_out = line.wind.blow_out
    if blow_out is None or blow_out.wind_speed is None:
        return 0.0
    marks = np.array([0.0, *boundaries(line), line.span.length])
    width = np.diff(marks)
    x = marks[:-1, None] + width[:, None] * np.array([0.0, 0.5, 1.0])
    square = wind_factor(line, x) ** 2 @ _SIMPSON  # exact: the factor is linear within a piece
    drag = np.full(width.size, blow_out.drag_coefficient, dtype=np.float64)
    if blow_out.drag_coefficient is None:
        drag = _drag_at_rest(line, x[:, 1])
    pressure = 0.5 * line.wind.air_density * blow_out.wind_speed**2
    return float(pressure * line.conductor.diameter * (square * drag) @ width / line.span.length)


def _drag_at_rest(line: Line, position: FloatArray) -> FloatArray:
    """Return C_z0 at positions (pieces,) [m]."""
    result = np.zeros(position.shape)
    for start, stop, aerodynamics in coefficients_along(line):
        if aerodynamics.at_rest is not None:
            result[(position >= start) & (position < stop)] = aerodynamics.at_rest[1]
    return result


def _segment_mass(segment: IceSegment, base: float) -> float:
    return base if segment.mass is None else segment.mass
