"""The hybrid model of an assembly: loads and stretching of its members added up. Theory sections 4, 12.1 and 16."""

from dataclasses import replace

import numpy as np

from engine.arrays import FloatArray, merge_axes
from engine.assemblies.assembled_line import AssembledLine
from engine.assemblies.assembly import by_member
from engine.assemblies.hybrid_shapes import HybridShapes
from engine.assemblies.shared_tension import of_all_members, own_stiffness, shared_stiffness
from engine.mechanics.cross_sections import Sections
from engine.mechanics.finite_elements import U, V, device_damping
from engine.mechanics.modes import at_points, directional_shapes
from engine.models import aerodynamic_load, unexpanded_load
from engine.models.aerodynamic_load import SpanLoad, published_load, span_load
from engine.models.discretization import discretize
from engine.models.hybrid import condensed, hybrid_model, integrated, three_coordinates
from engine.models.reduced_model import ReducedModel, damping_ratios, diagonal_matrices, diagonals
from engine.models.stretching import StretchingForce, stretching_of
from engine.models.unexpanded_load import UnexpandedLoad, load_as_it_stands
from engine.spec import Analysis, DampingModel, Stretching

DIRECTIONS = 3


def groups_of(shapes: HybridShapes) -> list[tuple[int, ...]]:
    """Divide the numbers of shapes into groups whose models have equally many coordinates."""
    pairs = list(zip(shapes.numbers, shapes.relieved.tolist(), strict=True))
    parts = (tuple(k for k, relieved in pairs if relieved is wanted) for wanted in (False, True))
    return [part for part in parts if part]


def assembled_hybrid(
    whole: AssembledLine, shapes: HybridShapes, numbers: tuple[int, ...], analysis: Analysis
) -> ReducedModel:
    """Return the model of each vertical mode with its partners, with leading axes (1, numbers).

    Parameters
    ----------
    whole : AssembledLine
    shapes : HybridShapes
    numbers : tuple of int
        One of the groups of `groups_of`.
    analysis : Analysis
        Its aerodynamic model, longitudinal inertia and stretching are used.
    """
    selected = [shapes.numbers.index(k) for k in numbers]
    basis = shapes.displacement[selected]
    if shapes.relieved[selected[0]]:
        basis = np.append(basis, shapes.relief[selected, None], axis=1)
    system = whole.assembly.stiffness, whole.assembly.mass
    mass, stiffness, moving = condensed(system, basis, 1, analysis.longitudinal_inertia)
    fields = by_member(moving @ basis, whole.assembly.members)
    blown = fields[..., V:, :].copy()
    blown[:, :, DIRECTIONS:] = 0.0  # the wind does not act on the relief
    damping = diagonal_matrices(_rates(whole, diagonals(stiffness) / diagonals(mass), analysis) * diagonals(mass))
    damping = damping + device_damping(whole.members.lines, whole.members.profile, blown).sum(axis=0)
    squares = diagonals(stiffness) / diagonals(mass)
    unstable = (squares <= 0.0).any(axis=-1) | (np.linalg.eigvalsh(stiffness)[..., 0] <= 0.0)
    return ReducedModel(
        mass=mass[None],
        damping=damping[None],
        stiffness=stiffness[None],
        load=integrated(load_on_members(whole, blown, analysis), mass.shape[-1], analysis, turned=False),
        shapes=over_all_nodes(blown),
        direction=np.arange(mass.shape[-1]) % DIRECTIONS,
        statically_unstable=np.asarray(unstable)[None],
        stretching=stretching_of_members(whole, fields, analysis),
        unexpanded=load_of_members_as_it_stands(whole, blown, analysis),
    )


def assembled_published_load(whole: AssembledLine, model: ReducedModel) -> ReducedModel:
    """Return the hybrid model with the load of the published closure, as `with_published_load` of a single span.

    All members count as one span, of the length of the member of interest.
    """
    model = three_coordinates(model)
    members = whole.members
    nodes = model.shapes.shape[-1] // whole.assembly.members
    by_nodes = model.shapes[0].reshape(*model.shapes.shape[1:-1], whole.assembly.members, nodes)
    values = at_points(members.matrices, np.moveaxis(by_nodes, -2, 0))
    joined = np.moveaxis(values, 0, -3)
    load = published_load(
        members.lines[:1],
        _in_one(members.sections),
        merge_axes(members.matrices.weight, -3, -2)[None],
        merge_axes(joined, -3, -2)[None],
        members.profile.arc_length[[whole.interest]],
    )
    return replace(model, load=load)


def load_on_members(whole: AssembledLine, blown: FloatArray, analysis: Analysis) -> SpanLoad:
    """Return the load point by point along all members, from fields (members, groups, m, 3, nodes): (1, groups)."""
    members = whole.members
    values = at_points(members.matrices, blown)
    model = analysis.aerodynamic_model
    load = span_load(members.lines, members.sections, members.matrices.weight, values, model)
    return aerodynamic_load.of_all_members(load)


def load_of_members_as_it_stands(whole: AssembledLine, blown: FloatArray, analysis: Analysis) -> UnexpandedLoad | None:
    """Return the unexpanded load on all members, if it is asked for; parameters are those of `load_on_members`."""
    own = load_as_it_stands(whole.members, at_points(whole.members.matrices, blown), analysis)
    return unexpanded_load.of_all_members(own)


def stretching_of_members(whole: AssembledLine, fields: FloatArray, analysis: Analysis) -> StretchingForce | None:
    """Return the stretching of coordinates with fields (members, groups, m, 4, nodes); None where it is neglected.

    The tension is uniform within a member. The ends of spans of a section move and pull their neighbours; phases hang
    each between ends of their own.
    """
    if analysis.stretching is Stretching.NEGLECTED:
        return None
    members = whole.members
    if whole.line.section is None:
        own = stretching_of(members, fields[..., V:, :])
        stiffness = own_stiffness(whole)
        return of_all_members(own, stiffness, np.diag(stiffness), len(whole.line.bundle.positions))
    pulled = fields[..., U, -1] - fields[..., U, 0]
    own = stretching_of(members, fields[..., V:, :], pulled)
    shared = shared_stiffness(whole)
    return of_all_members(own, own_stiffness(whole), shared, len(whole.line.bundle.positions))


def over_all_nodes(fields: FloatArray) -> FloatArray:
    """Put the nodes of all members side by side: (members, groups, m, 3, nodes) to (1, groups, m, 3, all nodes)."""
    return merge_axes(np.moveaxis(fields, 0, -2), -2)[None]


def squares_of_interest(whole: AssembledLine, analysis: Analysis) -> FloatArray:
    """Return K_ii/M_ii of one loop of the member of interest held at both ends: (3,) [rad^2/s^2]."""
    alone = discretize([whole.members.lines[whole.interest]], analysis.static_twist)
    shapes = directional_shapes(alone.matrices, alone.profile.arc_length, (1,))
    return np.asarray(hybrid_model(alone, shapes, (1,), analysis).uncoupled_squares[0, 0])


def _rates(whole: AssembledLine, squares: FloatArray, analysis: Analysis) -> FloatArray:
    """Return 2 zeta omega of each coordinate, eq. (11), where squares (groups, m) are their squared frequencies.

    The relief, too, has the structural damping of vertical motion: at twice the frequency of the motion it is not far
    from resonance, where the large damping that it has in a single span would take energy from the motion.
    """
    ratios = damping_ratios([whole.line])[0]
    shared = squares.copy()
    if whole.line.damping.model is DampingModel.CONSTANT_COEFFICIENT:
        of_one_loop = squares_of_interest(whole, analysis)
        shared[:, :DIRECTIONS], shared[:, DIRECTIONS:] = of_one_loop, of_one_loop[0]
    return np.asarray(2.0 * ratios[np.arange(squares.shape[-1]) % DIRECTIONS] * np.sqrt(np.maximum(shared, 0.0)))


def _in_one(sections: Sections) -> Sections:
    """Return the cross-sections of all members as those of one line."""

    def joined(values: FloatArray) -> FloatArray:
        return np.concatenate(list(values))[None]

    return replace(sections, wind_factor=joined(sections.wind_factor), aerodynamics=joined(sections.aerodynamics))
