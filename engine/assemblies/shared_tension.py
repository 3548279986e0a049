"""How members take a part of each other's square stretch over what joins them along the line. Theory sections 12.1, 16.

With h_i the square stretch of span i, its tension pulls at both ends. Strings and conductors give way along the line,
which is far faster than galloping, so they do it statically. That leaves h with a stiffness that couples the spans.
"""

from collections.abc import Sequence

import numpy as np

from engine.arrays import FloatArray, merge_axes
from engine.assemblies.assembled_line import AssembledLine
from engine.assemblies.assembly import side_by_side, static_response
from engine.mechanics.cross_sections import Sections
from engine.mechanics.finite_elements import FIELDS, U, V
from engine.mechanics.static_profile import StaticProfile
from engine.models.stretching import StretchingForce, slope_points, span_stiffness
from engine.numerics import polynomial
from engine.spec import Line


def span_pulls(whole: AssembledLine) -> FloatArray:
    """Return the force on the freedoms for a unit of square stretch of each span: (members, freedoms) [N/m].

    It is n k times the derivative of the linear stretch e + U_right - U_left of the span.
    """
    members = whole.members
    parts = members.lines, members.profile, members.sections
    count = len(whole.line.bundle.positions)
    gradient = _stretch_gradient(*parts)
    pull = np.zeros((*gradient.shape[:1], *gradient.shape[:1], FIELDS, gradient.shape[-1]))
    row = np.arange(gradient.shape[0])
    pull[row, row, V] = gradient
    pull[row, row, U, 0], pull[row, row, U, -1] = -1.0, 1.0
    return side_by_side(pull * (count * own_stiffness(whole))[:, None, None])


def own_stiffness(whole: AssembledLine) -> FloatArray:
    """Return k of each member between ends that are held, per sub-conductor: (members,) [N/m]."""
    parts = whole.members.parts[:3]
    return span_stiffness(*parts[:2], slope_points(*parts))


def shared_stiffness(whole: AssembledLine) -> FloatArray:
    """Return what resists the square stretch of each span per sub-conductor: (members, members) [N/m].

    It is k of each span on the diagonal, less what the neighbours take over. Between dead ends that is nothing.
    """
    pulls = span_pulls(whole)
    given = static_response(whole.assembly, pulls, (U,))
    return np.asarray(np.diag(own_stiffness(whole)) - pulls @ given.T / len(whole.line.bundle.positions))


def of_all_members(own: StretchingForce, stiffness: FloatArray, shared: FloatArray, count: int) -> StretchingForce:
    """Join the stretching of members (members, groups), each a span, to that of their assembly (1, groups).

    Parameters
    ----------
    own : StretchingForce
    stiffness : (members,)
        k of each member by itself [N/m].
    shared : (members, members)
        What resists the square stretch h of each member when its neighbours take a part of it over strings [N/m]. With
        D = shared - k that adds D h to the tensions and count/2 h . D h to the energy.
    count : int
        Number of sub-conductors.
    """
    square = np.moveaxis(own.square.mean(axis=2) / stiffness[:, None, None, None], 0, 1)
    groups, members, m, _ = square.shape
    beyond = ((shared - np.diag(stiffness)) @ square.reshape(groups, members, m * m)).reshape(square.shape)
    half = polynomial.collected(0.5 * count * merge_axes(beyond, -2), m, 2)
    cubic = polynomial.multiply_forms(half[..., None, :], square).sum(axis=1)
    table = own.table.sum(axis=0)
    table[..., -cubic.shape[-1] :] += cubic
    linear = merge_axes(np.moveaxis(own.linear, 0, 1), -3, -2)
    tensions = np.moveaxis(own.square, 0, 1) + beyond[:, :, None]
    return StretchingForce(
        table[None], polynomial.slopes(table)[None], linear[None], merge_axes(tensions, -4, -3)[None]
    )


def _stretch_gradient(lines: Sequence[Line], profile: StaticProfile, section_points: Sections) -> FloatArray:
    """Return the derivative of the linear stretch e by V at the nodes: (lines, nodes)."""
    at = slope_points(lines, profile, section_points)
    pull = at.weight * at.direction[..., 1] / at.direction[..., 0]
    by_element = (at.slopes * pull[..., None]).sum(axis=2)
    elements = by_element.shape[1]
    gradient = np.zeros((len(lines), 2 * elements + 1))
    for node in range(3):
        gradient[:, node : node + 2 * elements : 2] += by_element[..., node]
    return gradient
