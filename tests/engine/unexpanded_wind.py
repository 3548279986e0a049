"""The load of the relative wind as theory section 13 writes it, not expanded, for tests of several modules."""

import numpy as np

from engine.arrays import FloatArray
from engine.spec import Line


def on_one(a: FloatArray, theta: FloatArray, rise: FloatArray, sway: FloatArray) -> FloatArray:
    """Return lift, drag and moment on a sub-conductor that moves up and downwind, with a (3, 4) of C_y, C_z, C_theta.

    In parts of 1/2 rho d U^2 (of 1/2 rho d^2 U^2 for the moment): (3, ...).
    """
    alpha = theta - np.arctan2(rise, 1.0 - sway)
    pressure = (1.0 - sway) ** 2 + rise**2
    c_y, c_z, c_m = (np.polynomial.polynomial.polyval(alpha, row) for row in a)
    cosine, sine = np.cos(theta), np.sin(theta)
    return np.stack([pressure * (c_y * cosine - c_z * sine), pressure * (c_y * sine + c_z * cosine), pressure * c_m])


def on_bundle(line: Line, a: FloatArray, motion: FloatArray) -> FloatArray:
    """Return the mean load of the sub-conductors, less its value at rest, at (4, ...) Theta, V'/U, W'/U, Theta'/U.

    In parts of 1/2 rho d U^2, and of 1/2 rho d^2 U^2 for the moment: (3, ...).
    """
    d = line.conductor.diameter
    total = np.zeros((3, *motion.shape[1:]))
    for y, z in line.bundle.positions:
        for theta, v, w, turn, sign in ((*motion, 1.0), (*np.zeros_like(motion), -1.0)):
            lift, drag, moment = on_one(a, theta, v - z * turn + 0.5 * d * turn, w + y * turn)
            total += sign * np.stack([lift, drag, moment + (y * drag - z * lift) / d])
    return total / len(line.bundle.positions)
