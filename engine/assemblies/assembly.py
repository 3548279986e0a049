"""An assembly: members whose freedoms stand side by side, tied and linked by joins. Theory section 16.

A member is a line with matrices of its own. The freedoms of an assembly are those of its members, one member after the
other, each numbered node by node as in `engine.mechanics.finite_elements`.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray
from engine.mechanics.finite_elements import FIELDS, Matrices
from engine.numerics.eigenproblems import solve_symmetric

NEGLIGIBLE = 1e-12  # of the largest entry of a tie, below which it ties nothing


@dataclass(frozen=True, slots=True)
class Joins:
    """What joins members, over the freedoms x of their assembly.

    ties: (ties, freedoms), rows r with r . x = 0, such as a node that two spans share; links: (links, freedoms), rows l
    of links with the energies stiffness (l . x)^2 / 2 and mass (l . x')^2 / 2, such as the swing of a string or the
    change of length of an elastic spacer; stiffness: (links,) [N/m]; mass: (links,) [kg].
    """

    ties: FloatArray
    links: FloatArray
    stiffness: FloatArray
    mass: FloatArray


@dataclass(frozen=True, slots=True)
class Assembly:
    """Stiffness and mass of all members with their joins, and what holds and ties the freedoms.

    members: their number; stiffness, mass: (freedoms, freedoms), freedoms = members times those of one; held:
    (freedoms,), True where a support holds the freedom; ties: (ties, freedoms).
    """

    members: int
    stiffness: FloatArray
    mass: FloatArray
    held: BoolArray
    ties: FloatArray


def assembled(system: Matrices, held: BoolArray, joins: Sequence[Joins]) -> Assembly:
    """Put members side by side and add their joins.

    Parameters
    ----------
    system : Matrices
        Of the members, a stack of lines; its own held freedoms are not used.
    held : (members, freedoms of one)
        True where a support holds the freedom.
    joins : sequence of Joins

    Returns
    -------
    Assembly
    """
    members, own = held.shape
    stiffness, mass = np.zeros((2, members * own, members * own))
    for i in range(members):
        here = slice(i * own, (i + 1) * own)
        stiffness[here, here], mass[here, here] = system.stiffness[i], system.mass[i]
    for join in joins:
        stiffness += join.links.T @ (join.stiffness[:, None] * join.links)
        mass += join.links.T @ (join.mass[:, None] * join.links)
    ties = np.concatenate([np.zeros((0, members * own)), *(join.ties for join in joins)])
    return Assembly(members, stiffness, mass, held.reshape(-1), ties)


def moves(assembly: Assembly, fields: Sequence[int]) -> BoolArray:
    """Tell which freedoms belong to some of U, V, W, Theta and are not held: (freedoms,)."""
    field = np.arange(assembly.held.size) % FIELDS
    return np.asarray(np.isin(field, fields) & ~assembly.held)


def free_motions(ties: FloatArray, moving: BoolArray) -> FloatArray:
    """Return a basis of all motions of moving freedoms that the ties allow: (moving freedoms, independent ones).

    Each tie gives the freedom of its largest entry the motion that the others prescribe. ties: (ties, freedoms);
    moving: (freedoms,).
    """
    basis = np.eye(int(moving.sum()))
    for row in ties[:, moving]:
        along = row @ basis
        largest = int(np.abs(along).argmax()) if along.size else 0
        if along.size and abs(along[largest]) > NEGLIGIBLE * np.abs(row).max():
            basis = np.delete(basis - np.outer(basis[:, largest], along / along[largest]), largest, axis=1)
    return basis


def natural_motions(assembly: Assembly, fields: Sequence[int]) -> tuple[FloatArray, FloatArray]:
    """Solve the eigenproblem of an assembly in which only some of U, V, W, Theta move.

    Returns
    -------
    squares : (modes,)
        Squared angular frequencies, ascending [rad^2/s^2].
    displacement : (modes, freedoms)
        Orthonormal in the mass.
    """
    moving = moves(assembly, fields)
    basis = free_motions(assembly.ties, moving)
    stiffness, mass = (
        basis.T @ matrix[np.ix_(moving, moving)] @ basis for matrix in (assembly.stiffness, assembly.mass)
    )
    squares, vectors = solve_symmetric(stiffness, mass)
    displacement = np.zeros((squares.size, moving.size))
    displacement[:, moving] = (basis @ vectors).T
    return squares, displacement


def static_response(assembly: Assembly, force: FloatArray, fields: Sequence[int]) -> FloatArray:
    """Return the displacements under forces (..., freedoms) if only some of U, V, W, Theta move: (..., freedoms)."""
    moving = moves(assembly, fields)
    basis = free_motions(assembly.ties, moving)
    stiffness = basis.T @ assembly.stiffness[np.ix_(moving, moving)] @ basis
    displacement = np.zeros(force.shape)
    displacement[..., moving] = np.linalg.solve(stiffness, (force[..., moving] @ basis)[..., None])[..., 0] @ basis.T
    return displacement


def by_member(displacement: FloatArray, members: int) -> FloatArray:
    """Turn displacements (..., freedoms) into fields of each member: (members, ..., 4, nodes)."""
    nodes = displacement.shape[-1] // (members * FIELDS)
    fields = displacement.reshape(*displacement.shape[:-1], members, nodes, FIELDS)
    return np.asarray(np.moveaxis(fields, -3, 0).swapaxes(-1, -2))


def side_by_side(fields: FloatArray) -> FloatArray:
    """Turn fields of each member (members, ..., 4, nodes) into displacements (..., freedoms)."""
    rows = np.moveaxis(fields.swapaxes(-1, -2), 0, -3)
    return np.asarray(rows.reshape(*rows.shape[:-3], -1))
