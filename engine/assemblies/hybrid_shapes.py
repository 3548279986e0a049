"""The shapes of the hybrid model of an assembly: to each vertical mode a horizontal and a torsional shape, and relief.

Theory sections 4, 12.1 and 16. The modes of several spans lie close together, and a vertical mode needs the motions in
the other directions that the same wind drives. The horizontal shape is the mode of largest overlap. In torsion strings
hold every span by itself, so equal spans have equal frequencies and no modes of their own: the torsional shape is in
every span the mode of as many loops, as large as the vertical motion there. Relief is another vertical mode: in five
equal spans the lowest modes move at nearly half the frequency of the mode that lifts all spans, which the tension of
twice their frequency nearly meets, so an approximate shape would not do.
"""

from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.assemblies.assembled_line import AssembledLine, product_along
from engine.assemblies.assembly import by_member, side_by_side
from engine.assemblies.numbered_modes import NumberedModes, directional_modes, largest_member, loops_of, member_shares
from engine.assemblies.shared_tension import span_pulls
from engine.mechanics.finite_elements import FIELDS, THETA, U, V, W
from engine.mechanics.modes import directional_shapes
from engine.outcome import Fault, InvalidSpec
from engine.spec import Analysis, Stretching


@dataclass(frozen=True, slots=True)
class HybridShapes:
    """Shapes of one hybrid model for each number of a vertical mode.

    numbers: (k,); displacement: (k, 4, freedoms), f_u, f_v, f_w and f_theta, the last three with
    (2/L) sum int f^2 ds = 1 along all members, L being the arc length of the member of interest; partner: (k,), index
    of f_w among the horizontal modes; relief: (k, freedoms); relieved: (k,), whether a model needs its relief.
    """

    numbers: tuple[int, ...]
    displacement: FloatArray
    partner: IntArray
    relief: FloatArray
    relieved: BoolArray


def hybrid_shapes(whole: AssembledLine, numbers: tuple[int, ...], analysis: Analysis) -> HybridShapes:
    """Return the shapes for vertical modes of given numbers.

    Raises
    ------
    InvalidSpec
        If there are fewer modes.
    """
    vertical, horizontal = (directional_modes(whole.assembly, direction) for direction in (0, 1))
    if max(numbers) > vertical.count(0):
        rule = (
            f"must not exceed the number of vertical modes that the elements of the section have ({vertical.count(0)})"
        )
        raise InvalidSpec(Fault("loops", max(numbers), rule))
    own = np.array([vertical.place(0, k) for k in numbers])
    rising = _upwards(whole, vertical.displacement[own])
    across = by_member(horizontal.displacement, whole.assembly.members)[:, :, W]
    overlap = _sideways(rising) @ whole.assembly.mass @ horizontal.displacement.T
    partner = np.abs(overlap).argmax(axis=-1)
    fields = np.zeros((whole.assembly.members, len(numbers), FIELDS, rising.shape[-1]))
    fields[:, :, U : V + 1] = rising[:, :, U : V + 1]
    fields[:, :, W] = across[:, partner] * np.sign(np.take_along_axis(overlap, partner[:, None], axis=-1))
    fields[:, :, THETA] = _torsion(whole, rising[:, :, V])
    fields = _normalized(whole, fields)
    relief, relieved = _relief(whole, fields, vertical, own, analysis)
    separate = fields[:, :, :, None] * np.eye(FIELDS)[:, :, None]
    return HybridShapes(numbers, side_by_side(separate), partner, relief, relieved)


def _upwards(whole: AssembledLine, displacement: FloatArray) -> FloatArray:
    """Return fields of vertical modes (members, k, 4, nodes), positive in the first loop where they are largest."""
    fields = by_member(displacement, whole.assembly.members)
    member = largest_member(member_shares(whole.assembly, displacement))
    row = np.arange(member.size)
    v = fields[member, row, V]
    first = np.sin(np.pi * loops_of(v)[:, None] * np.linspace(0.0, 1.0, v.shape[-1]))
    return np.asarray(fields * np.sign((v * first).sum(axis=-1))[:, None, None])


def _sideways(rising: FloatArray) -> FloatArray:
    """Return displacements (k, freedoms) with W as large as V of fields (members, k, 4, nodes)."""
    fields = np.zeros_like(rising)
    fields[:, :, W] = rising[:, :, V]
    return side_by_side(fields)


def _torsion(whole: AssembledLine, rising: FloatArray) -> FloatArray:
    """Return torsional shapes (members, k, nodes) that go with vertical fields of the same shape."""
    members = whole.members
    loops = loops_of(rising)
    known = tuple(sorted({int(k) for k in loops.flat}))
    shapes = directional_shapes(members.matrices, members.profile.arc_length, known).nodal[:, :, THETA]
    own = np.take_along_axis(shapes, np.searchsorted(known, loops)[..., None], axis=1)
    share = 2.0 / members.profile.arc_length[:, None] * product_along(whole, rising, own)
    return np.asarray(share[..., None] * own)


def _normalized(whole: AssembledLine, fields: FloatArray) -> FloatArray:
    length = whole.members.profile.arc_length[whole.interest]
    size = np.sqrt(2.0 / length * product_along(whole, fields, fields).sum(axis=0))
    size[:, U] = size[:, V]  # both are one mode
    return np.asarray(fields / size[..., None])


def _relief(
    whole: AssembledLine, fields: FloatArray, vertical: NumberedModes, own: IntArray, analysis: Analysis
) -> tuple[FloatArray, BoolArray]:
    """Return the relief of each model (k, freedoms), and which models need it (k,).

    The square stretch of a vertical shape pulls at all vertical modes. The one that gives way most relieves it; a shape
    for which this is its own mode needs no other. own: (k,), indices of the vertical modes.
    """
    members = whole.members
    count = own.size
    if analysis.stretching is Stretching.NEGLECTED:
        return np.zeros((count, whole.assembly.held.size)), np.zeros(count, dtype=np.bool_)
    slopes = np.gradient(fields[:, :, V], axis=-1)
    stretch = (slopes**2).sum(axis=-1) / members.profile.arc_length[:, None]  # in proportion to h of each span
    work = (stretch.T @ span_pulls(whole) @ vertical.displacement.T) ** 2
    given = np.where((vertical.direction == 0) & (vertical.squares > 0.0), work / np.abs(vertical.squares), 0.0)
    most = given.argmax(axis=-1)
    return vertical.displacement[most], np.asarray(most != own)
