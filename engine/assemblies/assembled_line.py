"""A line of several members, discretized and joined. Theory section 16."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray
from engine.assemblies.assembly import Assembly, assembled
from engine.assemblies.spans import spans_of
from engine.assemblies.strings import held_ends, string_joins
from engine.mechanics.modes import at_points
from engine.models.discretization import Discretization, discretize
from engine.spec import Line, StaticTwist


@dataclass(frozen=True, slots=True)
class AssembledLine:
    """A line with its members, the spans of a section.

    line: as it was given; members: a stack of single spans between dead ends, in their static state; assembly: their
    freedoms with what joins them; interest: index of the member that the line describes.
    """

    line: Line
    members: Discretization
    assembly: Assembly
    interest: int


def assembled_section(line: Line, static_twist: StaticTwist = StaticTwist.NEGLECTED) -> AssembledLine:
    """Discretize a section and hang its spans on their strings.

    Strings hold the torsion of the conductors, so that the static twist of each span is its own.

    Raises
    ------
    InvalidSpec
        As `spans_of` and `discretize`.
    """
    assert line.section is not None, "only a section is assembled of spans"
    spans = spans_of(line)
    members = discretize(spans, static_twist)
    freedoms = members.matrices.stiffness.shape[-1]
    joins = [string_joins(line.section.strings, spans, members.profile, freedoms)]
    assembly = assembled(members.matrices, held_ends(len(spans), freedoms), joins)
    return AssembledLine(line, members, assembly, line.section.span_of_interest - 1)


def product_along(whole: AssembledLine, left: FloatArray, right: FloatArray) -> FloatArray:
    """Integrate the product of nodal fields (members, ..., nodes) along all members: (members, ...) [m]."""
    values = at_points(whole.members.matrices, left) * at_points(whole.members.matrices, right)
    weight = whole.members.matrices.weight
    return np.asarray(
        (values * weight.reshape(weight.shape[0], *(1,) * (values.ndim - 3), *weight.shape[1:])).sum((-1, -2))
    )
