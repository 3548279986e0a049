"""Blow-out: the plane into which mean drag turns the static curve, and the tension there. Theory section 15.

Load and chord span the plane. With supports at different levels it is also turned about its own upward axis, because
the chord then has a part across the wind.
"""

from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray
from engine.mechanics.catenary import unstressed_length

ITERATIONS = 100
TOLERANCE = 1e-11  # relative step of the tension
DIFFERENCE = 1e-6  # relative, for the slope of the length by the tension


@dataclass(frozen=True, slots=True)
class StillSpans:
    """Spans in still air; every array is (lines,).

    length, rise: horizontal and vertical distance of the supports [m]; weight per length [N/m]; rigidity EA [N];
    tension H_0 [N]; give of both ends together along the line, 1/K_left + 1/K_right [m/N].
    """

    length: FloatArray
    rise: FloatArray
    weight: FloatArray
    rigidity: FloatArray
    tension: FloatArray
    give: FloatArray


def plane_extent(length: FloatArray, rise: FloatArray, tilt: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the chord's parts along the plane and up in it [m], for a plane turned by a tilt (lines,) [rad]."""
    return np.hypot(length, rise * np.sin(tilt)), rise * np.cos(tilt)


def plane_axes(length: FloatArray, rise: FloatArray, tilt: FloatArray) -> FloatArray:
    """Return the axes of the plane as rows in (X, Y, Z): along, up against the load, and out of it: (lines, 3, 3)."""
    c, s = np.cos(tilt), np.sin(tilt)
    none, one = np.zeros_like(tilt), np.ones_like(tilt)
    up = np.stack([none, c, -s], axis=-1)
    across = np.stack([none, s, c], axis=-1)
    line = np.stack([one, none, none], axis=-1)
    extent, _ = plane_extent(length, rise, tilt)
    cosine, sine = (length / extent)[:, None], (rise * s / extent)[:, None]
    return np.stack([cosine * line + sine * across, up, cosine * across - sine * line], axis=1)


def tension_in_wind(still: StillSpans, tilt: FloatArray) -> FloatArray:
    """Return the tension along the line under weight and mean drag [N]: (lines,).

    The unstressed length is that of still air; the ends give way by (H - H_0) times their give. Newton's method starts
    at H_0: the unstressed length falls with the tension ever more slowly, so it nears the solution from below.

    Parameters
    ----------
    still : StillSpans
    tilt : (lines,)
        atan(q/p) [rad].
    """
    unstressed = unstressed_length(still.tension, still.weight, still.rigidity, still.length, still.rise)
    tension = still.tension.copy()
    pending = tilt != 0.0
    for _ in range(ITERATIONS):
        if not pending.any():
            break
        excess = _length_at(still, tilt, tension) - unstressed
        step = DIFFERENCE * tension
        slope = (_length_at(still, tilt, tension + step) - _length_at(still, tilt, tension - step)) / (2.0 * step)
        change = np.where(pending, -excess / slope, 0.0)
        tension = tension + change
        pending &= np.abs(change) > TOLERANCE * tension
    return tension


def _length_at(still: StillSpans, tilt: FloatArray, tension: FloatArray) -> FloatArray:
    """Return the unstressed length of spans that hang in their planes with these tensions along the line [m]."""
    between_ends = still.length - (tension - still.tension) * still.give
    extent, rise = plane_extent(between_ends, still.rise, tilt)
    in_plane = tension * extent / between_ends
    return unstressed_length(in_plane, still.weight / np.cos(tilt), still.rigidity, extent, rise)
