"""Phases that interphase spacers tie, as members of an assembly.

Only the phases that spacers name move together with the line; others are there for clearances only. Each hangs by
itself: spacers are fitted to the phases as they hang with their ice, and their weight is left out of the static state
like that of all devices. Half of the mass of a spacer moves with each of its phases.
"""

from dataclasses import replace

from engine.assemblies.assembled_line import AssembledLine
from engine.assemblies.assembly import assembled
from engine.assemblies.interphase_spacers import Place, spacer_joins
from engine.models.discretization import discretize
from engine.spec import THIS, Line, StaticTwist, own_line


def tied_places(line: Line) -> dict[str, Place]:
    """Return y and z [m] of the line and of every phase that a spacer ties, by name, the line first."""
    tied = {name for spacer in line.interphase_spacers for name in spacer.between}
    return {THIS: (0.0, 0.0), **{phase.name: (phase.y, phase.z) for phase in line.phases if phase.name in tied}}


def tied_lines(line: Line) -> tuple[Line, ...]:
    """Return the members as lines by themselves, in the order of `tied_places`, with half of each of their spacers."""
    by_name = {phase.name: own_line(line, phase) for phase in line.phases}
    return tuple(_with_halves(line, name, by_name.get(name)) for name in tied_places(line))


def assembled_phases(line: Line, static_twist: StaticTwist = StaticTwist.NEGLECTED) -> AssembledLine:
    """Discretize a line with the phases that are tied to it, and tie them.

    The static twist of each phase is its own.

    Raises
    ------
    InvalidSpec
        As `discretize`.
    """
    members = discretize(tied_lines(line), static_twist)
    freedoms = members.matrices.stiffness.shape[-1]
    joins = spacer_joins(line.interphase_spacers, tied_places(line), members.profile, freedoms)
    return AssembledLine(line, members, assembled(members.matrices, members.matrices.fixed, [joins]), 0)


def _with_halves(line: Line, name: str, own: Line | None) -> Line:
    halves = tuple(spacer.half() for spacer in line.interphase_spacers if name in spacer.between)
    bare = own or _by_itself(line)
    return replace(bare, devices=(*bare.devices, *halves))


def _by_itself(line: Line) -> Line:
    others = tuple(device for device in line.devices if device not in line.interphase_spacers)
    return replace(line, devices=others, phases=())
