"""The catenary between two supports at equal or different levels. Theory sections 2, 15 and 16.

x is the horizontal distance from the left support and y the height above it, both in the plane of the curve. Arrays of
all arguments broadcast against each other.
"""

import numpy as np

from engine.arrays import FloatArray

_ABSCISSAE, _WEIGHTS = np.polynomial.legendre.leggauss(24)  # exact to rounding unless the span is a deep chain


def low_point(catenary: FloatArray, span: FloatArray, rise: FloatArray) -> FloatArray:
    """Return x_0 of the lowest point of the curve, which may lie off the span [m].

    Parameters
    ----------
    catenary : array
        Catenary parameter c [m].
    span : array
        Horizontal distance of the supports [m].
    rise : array
        Height of the right support above the left one [m].
    """
    return np.asarray(0.5 * span - catenary * np.arcsinh(_middle_slope(catenary, span, rise)))


def arc_length(catenary: FloatArray, span: FloatArray, rise: FloatArray) -> FloatArray:
    """Return the length of the curve [m]; arguments as of `low_point`."""
    return np.asarray(np.hypot(2.0 * catenary * np.sinh(0.5 * span / catenary), rise))


def chord_sag(catenary: FloatArray, span: FloatArray, rise: FloatArray) -> FloatArray:
    """Return the vertical distance of chord and curve at mid-span [m]; arguments as of `low_point`."""
    level = 2.0 * catenary * np.sinh(0.25 * span / catenary) ** 2
    return np.asarray(level * np.hypot(1.0, _middle_slope(catenary, span, rise)))


def catenary_of_sag(sag: float, span: float, rise: float) -> float:
    """Return the catenary parameter [m] at which `chord_sag` is the sag [m].

    Newton's method on u = L_x/2c, from the parabola's u.
    """
    ratio, slope = 2.0 * sag / span, rise / span
    u = float(np.arcsinh(2.0 * ratio / np.hypot(1.0, slope)))
    for _ in range(60):
        level = 2.0 * np.sinh(0.5 * u) ** 2 / u
        tilt = slope * u / np.sinh(u)
        raised = np.hypot(1.0, tilt)
        by_u = (np.sinh(u) - level) / u * raised
        by_u += level * tilt / raised * slope * (np.sinh(u) - u * np.cosh(u)) / np.sinh(u) ** 2
        step = (level * raised - ratio) / by_u
        u -= step
        if abs(step) <= 1e-15 * u:
            break
    return float(0.5 * span / u)


def unstressed_length(
    tension: FloatArray, weight: FloatArray, rigidity: FloatArray, span: FloatArray, rise: FloatArray
) -> FloatArray:
    """Return L_0 = int s_x/(1 + H s_x/EA) dx, the length of the conductor of a span without tension [m].

    Parameters
    ----------
    tension : (lines,)
        Horizontal tension H [N].
    weight : (lines,)
        Load per length of the stretched conductor in the plane of the curve [N/m].
    rigidity : (lines,)
        EA [N].
    span, rise : (lines,)
        As of `low_point`.
    """
    catenary = tension / weight
    x = 0.5 * span[:, None] * (1.0 + _ABSCISSAE)
    stretch = np.cosh((x - low_point(catenary, span, rise)[:, None]) / catenary[:, None])
    relaxed = stretch / (1.0 + (tension / rigidity)[:, None] * stretch)
    return np.asarray(0.5 * span * (relaxed @ _WEIGHTS))


def _middle_slope(catenary: FloatArray, span: FloatArray, rise: FloatArray) -> FloatArray:
    """Return sinh((L_x/2 - x_0)/c), the slope of the curve at mid-span."""
    return np.asarray(rise / (2.0 * catenary * np.sinh(0.5 * span / catenary)))
