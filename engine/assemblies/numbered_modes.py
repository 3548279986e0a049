"""Modes of an assembly, numbered by frequency within a direction, and how members share in them. Theory section 16."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.assemblies.assembly import Assembly, by_member, natural_motions
from engine.mechanics.finite_elements import FIELDS, THETA, U, V, W

DEGENERATE = 1e-6  # relative difference of squared frequencies of modes that are free to mix
TIE = 1e-4  # difference of shares that is none
_FIELDS = ((U, V), (W,), (THETA,))


@dataclass(frozen=True, slots=True)
class NumberedModes:
    """Modes in rising order of frequency.

    squares: (modes,), squared angular frequencies [rad^2/s^2]; displacement: (modes, freedoms), orthonormal in the
    mass; direction: (modes,), 0 vertical, 1 horizontal, 2 torsional, -1 for motion along the line; number: (modes,),
    from 1 within a direction.
    """

    squares: FloatArray
    displacement: FloatArray
    direction: IntArray
    number: IntArray

    def place(self, direction: int, number: int) -> int:
        """Return the index of a mode."""
        return int(np.flatnonzero((self.direction == direction) & (self.number == number))[0])

    def count(self, direction: int) -> int:
        """Return how many modes of a direction there are."""
        return int((self.direction == direction).sum())


def directional_modes(assembly: Assembly, direction: int) -> NumberedModes:
    """Return the modes of an assembly that moves in one direction only; vertical ones move along the line, too."""
    squares, displacement = natural_motions(assembly, _FIELDS[direction])
    return _numbered(assembly, squares, displacement)


def all_modes(assembly: Assembly) -> NumberedModes:
    """Return the modes of an assembly in which everything moves, each by its direction of largest energy."""
    return _numbered(assembly, *natural_motions(assembly, range(FIELDS)))


def member_shares(assembly: Assembly, displacement: FloatArray) -> FloatArray:
    """Return the shares of the members in the kinetic energy of displacements (..., freedoms): (..., members)."""
    energy = by_member((displacement @ assembly.mass) * displacement, assembly.members).sum(axis=(-1, -2))
    return np.asarray(np.moveaxis(energy / energy.sum(axis=0), 0, -1))


def largest_member(shares: FloatArray) -> IntArray:
    """Return the index of the member of the largest share (..., members), the first one of equal ones: (...)."""
    return np.asarray((shares >= shares.max(axis=-1, keepdims=True) - TIE).argmax(axis=-1))


def loops_of(fields: FloatArray) -> IntArray:
    """Return the number of loops k whose sin(k pi s/L) is nearest to fields (..., nodes) at evenly spaced nodes."""
    nodes = fields.shape[-1]
    sines = np.sin(np.pi * np.outer(np.arange(1, nodes // 2 + 1), np.arange(nodes)) / (nodes - 1))
    return np.asarray(np.abs(fields @ sines.T).argmax(axis=-1) + 1)


def _numbered(assembly: Assembly, squares: FloatArray, displacement: FloatArray) -> NumberedModes:
    displacement = _apart(assembly, squares, displacement)
    energy = _energy_by_field(assembly, displacement)
    direction = np.array([-1, 0, 1, 2])[energy.argmax(axis=-1)]
    number = np.zeros(direction.size, dtype=np.intp)
    for one in np.unique(direction):
        here = direction == one
        number[here] = np.arange(1, int(here.sum()) + 1)
    return NumberedModes(squares, displacement, direction, number)


def _energy_by_field(assembly: Assembly, displacement: FloatArray) -> FloatArray:
    """Return the kinetic energy of U, V, W and Theta by themselves: (modes, 4)."""
    field = np.arange(assembly.held.size) % FIELDS
    energy = np.empty((displacement.shape[0], FIELDS))
    for i in range(FIELDS):
        own = displacement[:, field == i]
        energy[:, i] = ((own @ assembly.mass[np.ix_(field == i, field == i)]) * own).sum(axis=-1)
    return energy


def _apart(assembly: Assembly, squares: FloatArray, displacement: FloatArray) -> FloatArray:
    """Divide modes of one frequency between the members, from the first to the last, as far as they can be."""
    result = displacement.copy()
    gap = np.abs(np.diff(squares)) > DEGENERATE * np.abs(squares[1:])
    for group in np.split(np.arange(squares.size), np.flatnonzero(gap) + 1):
        if group.size > 1:
            mixed = by_member(displacement[group], assembly.members)
            momentum = by_member(displacement[group] @ assembly.mass, assembly.members)
            place = sum(i * np.einsum("afn,bfn->ab", mixed[i], momentum[i]) for i in range(assembly.members))
            _, turn = np.linalg.eigh(0.5 * (place + place.T))
            result[group] = turn.T @ displacement[group]
    return result
