"""Interphase spacers as joins between phases that hang side by side."""

import math
from collections.abc import Sequence

import numpy as np

from engine.arrays import FloatArray
from engine.assemblies.assembly import Joins
from engine.mechanics.finite_elements import FIELDS, V, W, interpolation_at
from engine.mechanics.static_profile import StaticProfile, arc_position, coordinates
from engine.spec import InterphaseSpacer

Place = tuple[float, float]


def spacer_joins(
    spacers: Sequence[InterphaseSpacer], places: dict[str, Place], profile: StaticProfile, freedoms: int
) -> Joins:
    """Return the joins of phases by the spacers between them.

    A spacer is a hinged bar. To first order its length changes by the difference of the displacements of its ends along
    its axis: a rigid one ties that, an elastic one resists it. To second order it also changes by d^2/(2 l), where d is
    the difference across the axis and l the length, which is left out.

    Parameters
    ----------
    spacers : sequence of InterphaseSpacer
    places : dict
        y and z [m] of the attachment of each member, in the order of the members, by its name.
    profile : StaticProfile
        Of the members, without blow-out.
    freedoms : int
        Of one member.
    """
    names = list(places)
    rows = np.zeros((len(spacers), len(names) * freedoms))
    for row, spacer in zip(rows, spacers, strict=True):
        one, other = (names.index(name) for name in spacer.between)
        axis = spacer_axis(spacer, places, profile)
        for member, sign in ((one, -1.0), (other, 1.0)):
            first, values = interpolation_at(profile, member, _elements(freedoms), spacer.position)
            for field, component in zip((V, W), axis, strict=True):
                start = member * freedoms + FIELDS * first + field
                row[start : start + 3 * FIELDS : FIELDS] = sign * component * values
    stiffness = np.array([math.inf if s.axial_stiffness is None else s.axial_stiffness for s in spacers])
    rigid = np.isinf(stiffness)
    return Joins(rows[rigid], rows[~rigid], stiffness[~rigid], np.zeros(int((~rigid).sum())))


def spacer_axis(spacer: InterphaseSpacer, places: dict[str, Place], profile: StaticProfile) -> FloatArray:
    """Return the unit vector (y, z) from the first to the second phase of a spacer as they hang in still air."""
    names = list(places)
    arc = arc_position(profile, np.full((profile.arc_length.size, 1), spacer.position))
    height = coordinates(profile, arc)[:, 0, 1]
    one, other = (names.index(name) for name in spacer.between)
    ends = [np.array([places[names[i]][0] + height[i], places[names[i]][1]]) for i in (one, other)]
    return np.asarray((ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0]))


def _elements(freedoms: int) -> int:
    return (freedoms // FIELDS - 1) // 2
