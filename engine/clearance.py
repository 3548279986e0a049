"""Space that galloping takes: envelopes of computed motions, ellipses of design practice, and clearances.

A region of the plane of Y (up) and Z (downwind) is represented by its support function, h(u) = max u . x over the
region, at `DIRECTIONS` unit vectors u, which describes its convex hull. A conductor that gallops at less than its full
amplitude stays within that hull, so clearances between hulls are on the safe side.
"""

import math
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache

import numpy as np

from engine.arrays import FloatArray
from engine.cycles.harmonic_balance import fourier
from engine.outcome import Fault, require
from engine.spec.rules import positive

DIRECTIONS = 720
PATH_SAMPLES = 360
FOOT = 0.3048
AESO_TILT = math.radians(5.0)


class EllipseMethod(StrEnum):
    """Method of the ellipse: single loop (Davison), double loop (Toye), CIGRE, or Alberta Electric System Operator."""

    DAVISON = "davison"
    TOYE = "toye"
    CIGRE = "cigre"
    AESO = "aeso"


@dataclass(frozen=True, slots=True)
class Ellipse:
    """Galloping ellipse at mid-loop: both axes, peak to peak, and how far its foot lies below the resting wire [m].

    tilts holds the angle of the major axis of each ellipse from the vertical, foot downwind [rad].
    """

    major_axis: float
    minor_axis: float
    b_distance: float
    tilts: tuple[float, ...] = (0.0,)


def galloping_ellipse(
    method: EllipseMethod,
    sag: float,
    span_length: float | None = None,
    diameter: float | None = None,
    subconductors: int = 1,
    swing: float = 0.0,
) -> Ellipse | None:
    """Return the galloping ellipse of a method at mid-loop.

    Parameters
    ----------
    method : EllipseMethod
    sag : float
        Iced sag S at mid-span [m].
    span_length : float, optional
        L [m], needed for the double loop.
    diameter : float, optional
        d of a sub-conductor [m], needed by CIGRE and AESO.
    subconductors : int
        CIGRE and AESO distinguish single conductors and bundles.
    swing : float
        Swing angle of the span from straight down, positive downwind [rad]; Davison and Toye tilt by half of it.

    Returns
    -------
    Ellipse or None
        None if the method's major axis is not positive, which means no galloping.

    Raises
    ------
    InvalidSpec
        If a length that the method needs is missing, a length is not positive, or there is no sub-conductor.

    Notes
    -----
    Davison's and Toye's ellipses are those of RUS Bulletin 1724E-200, CIGRE's that of Technical Brochure 322. M is the
    major axis, with lengths in m (0.3048 and 1.104 stand for one foot and for 2 sqrt(foot)):
    Davison M = 1.25 S + 0.3048, minor 0.4 M, B = 0.25 S;
    Toye M = 0.3048 + sqrt((3a/8) (L + 8 S^2/(3 L) - 2a)), a = sqrt(L^2/4 + S^2), minor 1.104 sqrt(M - 0.3048),
    B = 0.2 M;
    CIGRE TB 322 M = 80 d ln(8 S/(50 d)), in bundles 170 d ln(8 S/(500 d)), minor 0.4 M, B = 0.3 M;
    AESO the same M, minor 0.2 M, B = 0.25 M, and two ellipses at 5 degrees to both sides.
    """
    length, d = _lengths(method, sag, span_length, diameter, subconductors)
    if method is EllipseMethod.DAVISON:
        major = 1.25 * sag + FOOT
        return Ellipse(major, 0.4 * major, 0.25 * sag, (0.5 * swing,))
    if method is EllipseMethod.TOYE:
        major = FOOT + _double_loop(sag, length)
        return Ellipse(major, 2.0 * math.sqrt(FOOT * (major - FOOT)), 0.2 * major, (0.5 * swing,))
    factor, slenderness = (80.0, 50.0) if subconductors == 1 else (170.0, 500.0)
    major = factor * d * math.log(8.0 * sag / (slenderness * d))
    if major <= 0.0:
        return None
    if method is EllipseMethod.CIGRE:
        return Ellipse(major, 0.4 * major, 0.3 * major)
    return Ellipse(major, 0.2 * major, 0.25 * major, (AESO_TILT, -AESO_TILT))


def _lengths(
    method: EllipseMethod, sag: float, span_length: float | None, diameter: float | None, subconductors: int
) -> tuple[float, float]:
    """Return span length and diameter [m], or 1 for those that the method does not need."""
    needs_length = method is EllipseMethod.TOYE
    needs_diameter = method in {EllipseMethod.CIGRE, EllipseMethod.AESO}
    require(
        positive("sag", sag),
        Fault("span_length", None, f"is needed by {method}") if needs_length and span_length is None else None,
        positive("span_length", span_length),
        Fault("diameter", None, f"is needed by {method}") if needs_diameter and diameter is None else None,
        positive("diameter", diameter),
        Fault("subconductors", subconductors, "must be at least 1") if subconductors < 1 else None,
    )
    return 1.0 if span_length is None else span_length, 1.0 if diameter is None else diameter


def _double_loop(sag: float, length: float) -> float:
    """Return the rise of a double loop that the slack of half a span allows [m]."""
    chord = math.sqrt(0.25 * length**2 + sag**2)
    slack = length + 8.0 * sag**2 / (3.0 * length) - 2.0 * chord
    return math.sqrt(0.375 * chord * slack)


@lru_cache
def directions() -> FloatArray:
    """Return the unit vectors (y, z), clockwise from straight up: (DIRECTIONS, 2)."""
    angle = 2.0 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def subconductor_paths(series: FloatArray, positions: FloatArray, samples: int = PATH_SAMPLES) -> FloatArray:
    """Evaluate the closed paths of all sub-conductors over one period, eq. (3).

    Parameters
    ----------
    series : (..., 3, 2 H + 1)
        Fourier coefficients of V, W [m] and Theta [rad] where the motion is observed.
    positions : (..., n, 2)
        y_i, z_i of the sub-conductors [m], common to all motions or one set for each.
    samples : int
        Number of phases of the period; the extent of a path is exact to 5 / samples^2 of its size.

    Returns
    -------
    (..., n, samples, 2)
        y_i + V - z_i Theta and z_i + W + y_i Theta [m].
    """
    tau = 2.0 * np.pi * np.arange(samples) / samples
    motion = series @ fourier(tau, series.shape[-1] // 2).T
    v, w, theta = (motion[..., i, None, :] for i in range(3))
    y, z = positions[..., 0, None], positions[..., 1, None]
    return np.stack([y + v - z * theta, z + w + y * theta], axis=-1)


def path_support(points: FloatArray) -> FloatArray:
    """Return the support function (..., DIRECTIONS) [m] of points (..., points, 2) [m]."""
    return np.asarray((points @ directions().T).max(axis=-2))


def ellipse_support(ellipse: Ellipse) -> FloatArray:
    """Return the support function (DIRECTIONS,) of an ellipse, relative to the resting wire [m].

    The centre lies M/2 - B above the resting wire along the major axis. Several ellipses form one region.
    """
    found = np.full(DIRECTIONS, -np.inf)
    for tilt in ellipse.tilts:
        axis = np.array([math.cos(tilt), -math.sin(tilt)])
        along, across = directions() @ axis, directions() @ np.array([axis[1], -axis[0]])
        radius = np.hypot(0.5 * ellipse.major_axis * along, 0.5 * ellipse.minor_axis * across)
        found = np.maximum(found, (0.5 * ellipse.major_axis - ellipse.b_distance) * along + radius)
    return found


def extents(points: FloatArray) -> FloatArray:
    """Return height and width (..., 2) [m] of the region that paths (..., n, samples, 2) cover."""
    return np.asarray(points.max(axis=(-3, -2)) - points.min(axis=(-3, -2)))


def clearance(region: FloatArray, other: FloatArray, offset: FloatArray) -> FloatArray:
    """Return the distance of two regions [m]; if they overlap, minus the shortest shift that separates them.

    The distance of two convex regions is the largest gap between them in any direction; if there is none, they overlap
    by the smallest overlap. `DIRECTIONS` directions underestimate the distance by at most 1e-5 of it.

    Parameters
    ----------
    region, other : (..., DIRECTIONS)
        Support functions, each relative to the resting position of its own phase [m].
    offset : (..., 2)
        y, z of the other phase's resting position relative to the region's [m].

    Returns
    -------
    (...,)
    """
    towards = offset @ directions().T
    opposite = np.roll(other, DIRECTIONS // 2, axis=-1)
    return np.asarray((towards - region - opposite).max(axis=-1))
