"""The modes that the finite element model of tied phases combines. Theory section 7.4."""

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.assemblies.assembled_line import AssembledLine
from engine.assemblies.assembly import by_member
from engine.assemblies.numbered_modes import NumberedModes, largest_member, member_shares
from engine.mechanics.finite_elements import FIELDS
from engine.mechanics.modes import DIRECTIONS, assign

SMALL_LOOP = 0.2  # of the largest displacement, below which a loop is not counted
ALIKE = 1.0 - 1e-6  # of the largest displacement, from which another one is as large: rounding does not tell them apart


def modes_of_phases(whole: AssembledLine, modes: NumberedModes, loops: tuple[int, ...]) -> IntArray:
    """Return the indices of as many modes of each direction as phases times loops.

    They are those of largest overlap with sin(k pi s/L) of each phase and number of loops, as the modes of a single
    span are chosen. Phases mix in them; what phases can do in these loops, the modes can do together.
    """
    members = whole.assembly.members
    nodes = whole.assembly.held.size // (members * FIELDS)
    wave = np.sin(np.pi * np.outer(loops, np.arange(nodes)) / (nodes - 1))
    targets = np.zeros((len(DIRECTIONS), members, len(loops), members, nodes, FIELDS))
    for i, direction in enumerate(DIRECTIONS):
        for member in range(members):
            targets[i, member, :, member, :, direction] = wave
    flat = targets.reshape(-1, whole.assembly.held.size)
    momentum = flat @ whole.assembly.mass
    size = np.sqrt((momentum * flat).sum(axis=-1, keepdims=True))
    chosen = assign(((momentum / size) @ modes.displacement.T)[None] ** 2)[0]
    return np.asarray(chosen[np.lexsort((modes.squares[chosen], modes.direction[chosen]))])


def loops_of_modes(whole: AssembledLine, modes: NumberedModes, chosen: IntArray) -> IntArray:
    """Return the number of loops of each mode in the phase that moves most: (chosen,).

    Spacers change shapes so far that no sine tells it: it is the number of places where the motion is largest among its
    neighbours, small ones left out.
    """
    own = _moving_most(whole, modes, chosen)
    size = np.abs(own)
    peak = (size[:, 1:-1] > size[:, :-2]) & (size[:, 1:-1] >= size[:, 2:])
    large = size[:, 1:-1] >= SMALL_LOOP * size.max(axis=-1, keepdims=True)
    return np.asarray(np.maximum((peak & large).sum(axis=-1), 1), dtype=np.intp)


def relative_motion(whole: AssembledLine, modes: NumberedModes, chosen: IntArray) -> FloatArray:
    """Return the motion of each phase where the (first) largest one is, as a share of that one: (chosen, members)."""
    field = np.array(DIRECTIONS)[np.maximum(modes.direction[chosen], 0)]
    own = by_member(modes.displacement[chosen], whole.assembly.members)[:, np.arange(chosen.size), field]
    size = np.abs(own.swapaxes(0, 1)).reshape(chosen.size, -1)
    largest = (size >= ALIKE * size.max(axis=-1, keepdims=True)).argmax(axis=-1)
    member, node = np.divmod(largest, own.shape[-1])
    row = np.arange(chosen.size)
    return np.asarray((own[:, row, node] / own[member, row, node]).T)


def _moving_most(whole: AssembledLine, modes: NumberedModes, chosen: IntArray) -> FloatArray:
    """Return the displacement of each mode in its direction, in the phase that moves most: (chosen, nodes)."""
    fields = by_member(modes.displacement[chosen], whole.assembly.members)
    member = largest_member(member_shares(whole.assembly, modes.displacement[chosen]))
    field = np.array(DIRECTIONS)[np.maximum(modes.direction[chosen], 0)]
    return np.asarray(fields[member, np.arange(chosen.size), field])
