"""The mode shapes of both models of a line, at the nodes, for pictures and for comparison."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray
from engine.mechanics.finite_elements import FIELDS
from engine.mechanics.modes import DIRECTIONS, directional_shapes, full_modes
from engine.mechanics.static_profile import horizontal_position
from engine.models.discretization import discretize
from engine.spec import Analysis, Line


@dataclass(frozen=True, slots=True)
class ModeShapes:
    """Shapes of one line by direction (vertical, horizontal, torsional) and number of loops, at its nodes.

    position: (nodes,), horizontal distance from the left support [m]. hybrid, finite_element: (3, loops, 4, nodes),
    with U, V, W and Theta in this order; those of the hybrid model are the directional shapes, in which a direction
    moves alone but for f_u beside f_v. Its own component of a finite element mode is scaled to the hybrid's by least
    squares, its others with it: in SI units Theta is per metre in the first two directions, U, V, W are times metre in
    the third.
    """

    position: FloatArray
    hybrid: FloatArray
    finite_element: FloatArray


def mode_shapes(line: Line, analysis: Analysis) -> ModeShapes:
    """Compute the shapes of both models, theory section 4.

    Parameters
    ----------
    line : Line
    analysis : Analysis
        Its loops, and whether the static twist is solved for.

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
    return ModeShapes(horizontal_position(profile, arc)[0], hybrid, full * scale[..., None, None])
