"""The relief coordinate: the symmetric in-plane motion by which a span gives way to stretching. Theory section 12.1.

The square stretch of a motion with several loops also lifts the sag. Without a coordinate for that the span stiffens
too much. Its shape is the static curve itself with the longitudinal motion that follows it statically.
"""

import numpy as np

from engine.arrays import FloatArray
from engine.mechanics.finite_elements import FIELDS, U, V
from engine.mechanics.modes import at_points
from engine.mechanics.static_profile import coordinates
from engine.models.discretization import Discretization

DAMPING_RATIO = 0.1  # assumed; from 0.03 to 0.3 amplitudes of the source's lines change by 0.15 % or less


def relief_displacement(discretization: Discretization) -> FloatArray:
    """Return the displacement of the relief coordinate of each line, in the plane of the sag: (lines, freedoms).

    V is the static curve measured upwards from it to the chord, with (2/L) int V^2 ds = 1; U is condensed statically
    as a vector, U = -K_UU^-1 K_UV V. W and Theta do not move.
    """
    system, profile = discretization.matrices, discretization.profile
    lines, freedoms = system.fixed.shape
    arc = profile.arc_length[:, None] * np.linspace(0.0, 1.0, freedoms // FIELDS)
    along, up, _ = np.moveaxis(coordinates(profile, arc) @ profile.axes.swapaxes(-1, -2), -1, 0)
    vertical = up[:, -1:] * along / along[:, -1:] - up
    square = (at_points(system, vertical) ** 2 * system.weight).sum(axis=(1, 2))
    vertical = vertical / np.sqrt(2.0 / profile.arc_length * square)[:, None]
    displacement = np.zeros((lines, freedoms))
    displacement[:, V::FIELDS] = vertical
    held = system.fixed[:, U::FIELDS]
    free = ~held
    stiffness = system.stiffness[:, U::FIELDS, U::FIELDS] * (free[:, :, None] & free[:, None, :])
    stiffness += held[:, :, None] * np.eye(held.shape[1])
    pull = (system.stiffness[:, U::FIELDS, V::FIELDS] @ vertical[..., None]) * free[..., None]
    displacement[:, U::FIELDS] = -np.linalg.solve(stiffness, pull)[..., 0]
    return displacement
