"""Mode shapes of both models of a line at its nodes, for pictures and for comparison."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray
from engine.mechanics.finite_elements import FIELDS
from engine.mechanics.modes import DIRECTIONS, directional_shapes, full_modes
from engine.mechanics.static_profile import horizontal_position
from engine.models.discretization import discretize, fields_in_space
from engine.spec import Analysis, Line


@dataclass(frozen=True, slots=True)
class ModeShapes:
    """Shapes of one line by direction (vertical, horizontal, torsional) and number of loops, at its nodes.

    position: (nodes,), horizontal distance from the left support [m]. hybrid, finite_element: (3, loops, 4, nodes),
    components U, V, W, Theta. In the hybrid shapes only the component of the direction itself moves, with f_u beside
    f_v; after blow-out the first two directions are in and out of the plane of the sag. Each finite element mode is
    scaled so that its own component fits the hybrid shape by least squares. In SI units Theta is then per metre in the
    first two directions, and U, V, W are in metres in the third.
    """

    position: FloatArray
    hybrid: FloatArray
    finite_element: FloatArray


def mode_shapes(line: Line, analysis: Analysis) -> ModeShapes:
    """Return the mode shapes of both models, theory section 4.

    Parameters
    ----------
    line : Line
    analysis : Analysis
        Its loops and static twist are used.

    Returns
    -------
    ModeShapes
    """
    discretization = discretize((line,), analysis.static_twist)
    system, profile = discretization.matrices, discretization.profile
    nodal = directional_shapes(system, profile.arc_length, analysis.loops).nodal[0]
    hybrid = np.zeros((len(DIRECTIONS), *nodal.shape))
    for i, fields in enumerate(((0, 1), (2,), (3,))):
        hybrid[i][:, fields] = nodal[:, fields]
    full = full_modes(system, analysis.loops).vectors[0]
    full = full.reshape(*full.shape[:2], -1, FIELDS).swapaxes(-1, -2)
    own = list(DIRECTIONS)
    target, found = hybrid[range(3), :, own], full[range(3), :, own]
    scale = (target * found).sum(axis=-1) / (found**2).sum(axis=-1)
    arc = np.linspace(0.0, profile.arc_length, nodal.shape[-1], axis=-1)
    shapes = fields_in_space(profile, np.stack([hybrid, full * scale[..., None, None]])[None])[0]
    return ModeShapes(horizontal_position(profile, arc)[0], shapes[0], shapes[1])
