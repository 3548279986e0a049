"""Mode shapes of both models of a section at the nodes of all spans, for pictures. Theory section 16."""

import numpy as np

from engine.arrays import FloatArray
from engine.assemblies.assembled_line import AssembledLine, assembled_section
from engine.assemblies.assembly import by_member
from engine.assemblies.numbered_modes import NumberedModes, all_modes, directional_modes
from engine.mechanics.modes import DIRECTIONS
from engine.mechanics.static_profile import horizontal_position
from engine.models.mode_shapes import ModeShapes
from engine.spec import Analysis, Line


def section_mode_shapes(line: Line, analysis: Analysis) -> ModeShapes:
    """Return the modes of the numbers asked for, at horizontal distances from the left end of the section.

    Shapes of the hybrid model are the modes of each direction by itself, one where they are largest. Parameters are
    those of `engine.models.mode_shapes.mode_shapes`.
    """
    whole = assembled_section(line, analysis.static_twist)
    together = all_modes(whole.assembly)
    hybrid, full = [], []
    for direction, own in enumerate(DIRECTIONS):
        alone = _shapes(whole, directional_modes(whole.assembly, direction), direction, analysis.loops)
        largest = np.take_along_axis(alone[:, own], np.abs(alone[:, own]).argmax(axis=-1)[:, None], axis=-1)
        target = alone / largest[..., None]
        found = _shapes(whole, together, direction, analysis.loops)
        scale = (target[:, own] * found[:, own]).sum(axis=-1) / (found[:, own] ** 2).sum(axis=-1)
        hybrid.append(target)
        full.append(found * scale[:, None, None])
    return ModeShapes(_positions(whole), np.stack(hybrid), np.stack(full))


def _shapes(whole: AssembledLine, modes: NumberedModes, direction: int, numbers: tuple[int, ...]) -> FloatArray:
    """Return the modes of a direction over the nodes of all spans: (numbers, 4, nodes)."""
    chosen = [modes.place(direction, k) for k in numbers]
    return np.concatenate(list(by_member(modes.displacement[chosen], whole.assembly.members)), axis=-1)


def _positions(whole: AssembledLine) -> FloatArray:
    profile = whole.members.profile
    nodes = 2 * whole.members.lines[0].span.elements + 1
    own = horizontal_position(profile, profile.arc_length[:, None] * np.linspace(0.0, 1.0, nodes))
    return np.asarray((own + np.cumsum(profile.span_length)[:, None] - profile.span_length[:, None]).reshape(-1))
