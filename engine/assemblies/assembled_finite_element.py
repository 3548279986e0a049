"""The finite element model of an assembly: several of its modes that move together. Theory sections 7.4 and 16."""

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.assemblies.assembled_hybrid import (
    load_of_members_as_it_stands,
    load_on_members,
    over_all_nodes,
    stretching_of_members,
)
from engine.assemblies.assembled_line import AssembledLine
from engine.assemblies.assembly import by_member
from engine.assemblies.numbered_modes import NumberedModes, directional_modes, loops_of, member_shares
from engine.mechanics.finite_elements import FIELDS, THETA, U, V, W, device_damping
from engine.mechanics.modes import assign, directional_shapes
from engine.models.aerodynamic_load import by_points, take_load
from engine.models.reduced_model import ReducedModel, damping_ratios, diagonals
from engine.models.stretching import take_stretching
from engine.models.unexpanded_load import take_unexpanded
from engine.spec import Analysis, DampingModel

MOVES = 0.01  # share of a vertical mode from which on a member takes part in it
_FIELDS = ((U, V), (W,), (THETA,))


def modes_together(whole: AssembledLine, modes: NumberedModes, numbers: tuple[int, ...]) -> IntArray:
    """Return the indices of the modes that the finite element model combines: vertical, horizontal, torsional ones.

    These are the vertical modes of the numbers asked for, as many horizontal modes, those of largest overlap with them,
    and in every member that takes part the torsional mode of as many loops.
    """
    vertical = np.array([modes.place(0, k) for k in numbers])
    across, turning = (np.flatnonzero(modes.direction == d) for d in (1, 2))
    fields = by_member(modes.displacement, whole.assembly.members)
    rising = fields[:, vertical, V]
    sideways = np.einsum("ikn,ihn->kh", rising, fields[:, across, W])
    horizontal = across[assign(sideways[None] ** 2)[0]]
    shares = member_shares(whole.assembly, modes.displacement[vertical])
    loops = loops_of(rising)
    wanted = sorted({(i, int(loops[i, k])) for i, k in zip(*np.nonzero(shares.T > MOVES), strict=True)})
    own = fields[:, turning, THETA]
    place = np.pi * np.linspace(0.0, 1.0, own.shape[-1])
    overlap = np.stack([own[i] @ np.sin(k * place) for i, k in wanted])
    return np.concatenate([vertical, horizontal, np.sort(turning[assign(overlap[None] ** 2)[0]])])


def assembled_finite_element(
    whole: AssembledLine, modes: NumberedModes, chosen: IntArray, analysis: Analysis
) -> ReducedModel:
    """Return the model reduced to chosen modes, with the exact load: leading axis (1,)."""
    vectors = modes.displacement[chosen]
    fields = by_member(vectors, whole.assembly.members)[:, None]
    blown = fields[..., V:, :]
    stiffness = vectors @ whole.assembly.stiffness @ vectors.T
    members = whole.members
    damping = _modal_damping(whole, vectors) + device_damping(members.lines, members.profile, fields).sum(axis=(0, 1))
    first = (slice(None), 0)
    return ReducedModel(
        mass=np.eye(chosen.size)[None],
        damping=damping[None],
        stiffness=stiffness[None],
        load=take_load(by_points(load_on_members(whole, blown, analysis)), first),
        shapes=over_all_nodes(blown)[:, 0],
        direction=modes.direction[chosen],
        statically_unstable=np.array([bool((diagonals(stiffness) <= 0.0).any() or _has_no_frequency(whole))]),
        stretching=take_stretching(stretching_of_members(whole, fields, analysis), first),
        unexpanded=take_unexpanded(load_of_members_as_it_stands(whole, blown, analysis), first),
    )


def _has_no_frequency(whole: AssembledLine) -> bool:
    return bool(np.isnan(_one_loop(whole)).any())


def _one_loop(whole: AssembledLine) -> FloatArray:
    """Return the angular frequencies of one loop of the member of interest held at both ends: (3,) [rad/s]."""
    members = whole.members
    shapes = directional_shapes(members.matrices, members.profile.arc_length, (1,))
    return np.asarray(shapes.angular_frequency[whole.interest, 0])


def _modal_damping(whole: AssembledLine, vectors: FloatArray) -> FloatArray:
    """Return the structural damping of eq. (11) between modes (m, freedoms): (m, m).

    Each direction damps its own motion, by a coefficient per length or with the ratio of each of its modes by itself.
    """
    mass = whole.assembly.mass
    field = np.arange(mass.shape[0]) % FIELDS
    constant = whole.line.damping.model is DampingModel.CONSTANT_COEFFICIENT
    total = np.zeros((len(vectors), len(vectors)))
    for i, ratio in enumerate(damping_ratios([whole.line])[0]):
        own = np.isin(field, _FIELDS[i])
        moved = vectors[:, own]
        momentum = moved @ mass[np.ix_(own, own)]
        if constant:
            total += 2.0 * ratio * np.nan_to_num(_one_loop(whole)[i]) * momentum @ moved.T
        else:
            every = directional_modes(whole.assembly, i)
            share = momentum @ every.displacement[:, own].T
            total += (share * (2.0 * ratio * np.sqrt(np.maximum(every.squares, 0.0)))) @ share.T
    return total
