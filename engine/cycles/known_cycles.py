"""The distinct limit cycles found so far at the requested wind speeds, and the branches that connect them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, lengths, merge_axes
from engine.cycles.harmonic_balance import Orbits, balance, oscillation_size, resized, select
from engine.models.reduced_model import ReducedModel, lowest_frequency
from engine.numerics.newton import NewtonOptions
from engine.result import FoundBy

SLOWEST = 0.1  # of the lowest natural frequency: a slower solution is really a static one
SMALLEST = 1e-6  # size relative to the start's, below which a solution is the equilibrium
SAME = 1e-3  # relative distance below which two solutions are the same cycle
NEAR = 0.02  # relative difference of frequency up to which a start may lead to a known cycle


@dataclass(frozen=True, slots=True)
class Starts:
    """Initial guesses of cycles: member and wind speed index (k,) of each, and the guessed orbits."""

    member: IntArray
    wind: IntArray
    orbits: Orbits


def stacked(parts: Sequence[Starts]) -> Starts:
    """Concatenate starts of the same models and numbers of harmonics."""
    names = ("coefficients", "angular_frequency", "wind_speed")
    orbits = Orbits(*(np.concatenate([getattr(part.orbits, name) for part in parts]) for name in names))
    member, wind = (np.concatenate([getattr(part, name) for part in parts]) for name in ("member", "wind"))
    return Starts(member, wind, orbits)


class KnownCycles:
    """Distinct cycles, numbered from 0 in the order in which they are found, and the branches that they lie on."""

    def __init__(self, model: ReducedModel) -> None:
        """Start with no cycles of a stack of models."""
        none = np.zeros(0, dtype=np.intp)
        still = Orbits(np.zeros((0, model.mass.shape[-1], 3)), np.zeros(0), np.zeros(0))
        self.model = model
        self._cycles = Starts(none, none, still)
        self._harmonics = none
        self._sizes = np.zeros(0)
        self._found_by: list[FoundBy] = []
        self._by_location: dict[tuple[int, int], list[tuple[int, float, FloatArray]]] = {}
        self._followed, self._born = none, np.zeros(0)
        self._links: list[tuple[IntArray, IntArray]] = []
        self._joints: list[tuple[int, int]] = []
        self._left_alone: list[IntArray] = []

    def __len__(self) -> int:
        """Return the number of distinct cycles."""
        return len(self._found_by)

    def locations(self, ids: IntArray) -> tuple[IntArray, IntArray]:
        """Return member and wind speed index of the cycles with these numbers: (k,), (k,)."""
        return self._cycles.member[ids], self._cycles.wind[ids]

    def orbits(self, ids: IntArray) -> Orbits:
        """Return the orbits of the cycles with these numbers, padded to the most harmonics among them."""
        return resized(select(self._cycles.orbits, ids), int(self._harmonics[ids].max(initial=1)))

    def harmonics(self, ids: IntArray) -> IntArray:
        """Return the number of harmonics that each of the cycles with these numbers was solved with."""
        return self._harmonics[ids]

    @property
    def found_by(self) -> tuple[FoundBy, ...]:
        """The search that first found each cycle."""
        return tuple(self._found_by)

    def new_starts(self, starts: Starts) -> Starts:
        """Return the starts that are unlikely to lead to a known cycle of their member and wind speed.

        Each start is matched with the cycle nearest in size among those of nearly its frequency. For every cycle only
        the nearest start matched with it is left out.
        """
        differences = self._size_differences(starts)
        nearest, distance = differences.argmin(axis=-1), differences.min(axis=-1)
        order = np.lexsort((distance, nearest, starts.wind, starts.member))
        target = np.stack([starts.member, starts.wind, nearest], axis=-1)[order]
        first = np.ones(order.size, dtype=np.bool_)
        first[1:] = (target[1:] != target[:-1]).any(axis=-1)
        index = np.sort(order[~(first & np.isfinite(distance[order]))])
        return Starts(starts.member[index], starts.wind[index], select(starts.orbits, index))

    def _size_differences(self, starts: Starts) -> FloatArray:
        """Return |log| of the size ratio of each start to the known cycles of its member and wind speed.

        Shape (starts, largest number of such cycles); infinite where frequencies differ or there is no cycle.
        """
        if not len(self):
            return np.full((starts.member.size, 1), np.inf)
        found = self._cycles
        winds = int(max(found.wind.max(initial=0), starts.wind.max(initial=0))) + 1
        key, asked = found.member * winds + found.wind, starts.member * winds + starts.wind
        order = np.argsort(key, kind="stable")
        first = np.searchsorted(key[order], asked)
        count = np.searchsorted(key[order], asked, side="right") - first
        column = np.arange(count.max(initial=1))
        known = order[np.minimum(first[:, None] + column, order.size - 1)]
        size = lengths(_phase_invariants(self.model, starts))[:, None]
        near = np.abs(found.orbits.angular_frequency[known] / starts.orbits.angular_frequency[:, None] - 1.0) <= NEAR
        return np.where(near & (column < count[:, None]), np.abs(np.log(self._sizes[known] / size)), np.inf)

    def add(self, starts: Starts, good: BoolArray, found_by: FoundBy) -> IntArray:
        """Record the solutions marked good; return the number of each one's cycle, -1 for the others: (starts,)."""
        invariants = _phase_invariants(self.model, starts)
        sizes = lengths(invariants)
        numbers, new = np.full(good.size, -1, dtype=np.intp), []
        member, wind, size = starts.member.tolist(), starts.wind.tolist(), sizes.tolist()
        for i in np.flatnonzero(good).tolist():
            known = self._by_location.setdefault((member[i], wind[i]), [])
            number = _same(known, size[i], invariants[i])
            if number is None:
                number = len(self)
                known.append((number, size[i], invariants[i]))
                self._found_by.append(found_by)
                new.append(i)
            numbers[i] = number
        self._keep(starts, sizes, np.array(new, dtype=np.intp))
        return numbers

    def _keep(self, starts: Starts, sizes: FloatArray, index: IntArray) -> None:
        """Append some of the solutions to the arrays of known cycles."""
        harmonics = starts.orbits.coefficients.shape[-1] // 2
        most = max(harmonics, self._cycles.orbits.coefficients.shape[-1] // 2)
        new = Starts(starts.member[index], starts.wind[index], select(starts.orbits, index))
        self._cycles = stacked([replace(part, orbits=resized(part.orbits, most)) for part in (self._cycles, new)])
        self._harmonics = np.append(self._harmonics, np.full(index.size, harmonics))
        self._sizes = np.append(self._sizes, sizes[index])

    def add_branches(self, members: IntArray, born: FloatArray) -> IntArray:
        """Record followed branches and return their numbers: (branches,).

        Parameters
        ----------
        members : (branches,)
            The model of each.
        born : (branches,)
            Wind speed of the Hopf point where each starts, infinite if there is none [m/s].
        """
        first = self._born.size
        self._followed, self._born = np.append(self._followed, members), np.append(self._born, born)
        return np.arange(first, self._born.size)

    def link(self, followed: IntArray, numbers: IntArray) -> None:
        """Record that cycles (k,) lie on followed branches (k,)."""
        self._links.append((numbers, followed))

    def join(self, joints: Sequence[tuple[int, int]]) -> None:
        """Record pairs of followed branches that are parts of one."""
        self._joints += joints

    def leave_alone(self, numbers: IntArray) -> None:
        """Record that the branches of these cycles are not to be followed."""
        self._left_alone.append(numbers)

    def unfollowed(self) -> IntArray:
        """Return, for each member, the cycle at the lowest wind speed that lies on no followed branch yet."""
        free = np.ones(len(self), dtype=np.bool_)
        for numbers in (*self._left_alone, *(numbers for numbers, _ in self._links)):
            free[numbers] = False
        number = np.flatnonzero(free)
        member, wind = self.locations(number)
        order = np.lexsort((wind, member))
        _, lowest = np.unique(member[order], return_index=True)
        return number[order[lowest]]

    def families(self) -> tuple[IntArray, IntArray]:
        """Number the connected families of cycles and followed branches of each member from 0.

        Families with a Hopf point come first, ordered by the lowest one; the others follow in the order of their lowest
        wind speed.

        Returns
        -------
        (cycles,), (branches,)
            The family of each cycle and of each followed branch.
        """
        label = self._labels()
        member = np.concatenate([self._cycles.member, self._followed])
        born = np.concatenate([np.full(len(self), np.inf), self._born])
        wind = np.concatenate([self._cycles.wind, np.full(self._born.size, np.inf)])
        order = np.lexsort((label, wind, born, member))
        roots, first = np.unique(label[order], return_index=True)
        ranks = np.argsort(first)  # of the families, by member and the lowest node of each
        own = member[order[first[ranks]]]
        numbers = np.zeros(label.size, dtype=np.intp)
        numbers[roots[ranks]] = np.arange(own.size) - np.searchsorted(own, own)
        return numbers[label[: len(self)]], numbers[label[len(self) :]]

    def _labels(self) -> IntArray:
        """Label the connected families of cycles and followed families: (cycles + branches,)."""
        # Union-find by hand, because importing scipy.sparse takes longer than a whole analysis.
        cycles = len(self)
        parents = list(range(cycles + self._born.size))
        for numbers, followed in self._links:
            for cycle, branch in zip(numbers.tolist(), followed.tolist(), strict=True):
                parents[_root(parents, cycle)] = _root(parents, cycles + branch)
        for one, other in self._joints:
            parents[_root(parents, cycles + one)] = _root(parents, cycles + other)
        return np.array([_root(parents, node) for node in range(len(parents))], dtype=np.intp)


def _same(known: Sequence[tuple[int, float, FloatArray]], size: float, invariants: FloatArray) -> int | None:
    """Return the number of the known cycle with the same invariants, of a size; None if there is none."""
    for number, own, other in known:
        if abs(size - own) <= SAME * own:  # else they differ by more
            difference = invariants - other
            if float(difference @ difference) <= (SAME * own) ** 2:
                return number
    return None


def _root(parents: list[int], node: int) -> int:
    """Return the root of a node's tree, halving the path for later calls."""
    while parents[node] != node:
        parents[node] = parents[parents[node]]
        node = parents[node]
    return node


def _phase_invariants(model: ReducedModel, starts: Starts) -> FloatArray:
    """Return mass-weighted means and amplitudes of all harmonics, which do not depend on the phase: (cycles, n)."""
    weight = np.sqrt(model.modal_masses)[starts.member]
    coefficients = starts.orbits.coefficients * weight[..., None]
    size = np.sqrt(coefficients[..., 1::2] ** 2 + coefficients[..., 2::2] ** 2)
    return np.concatenate([coefficients[..., 0], merge_axes(size, -2)], axis=-1)


def solve_starts(model: ReducedModel, starts: Starts, options: NewtonOptions | None = None) -> tuple[Starts, BoolArray]:
    """Solve the balance from all starts; return the solutions and which of them are cycles (starts,)."""
    orbits, solution = balance(model, starts.member, starts.orbits, options)
    before = oscillation_size(model, starts.member, starts.orbits)
    size = oscillation_size(model, starts.member, orbits)
    slowest = lowest_frequency(model)[starts.member]
    good = solution.converged & (size > SMALLEST * before) & (orbits.angular_frequency > SLOWEST * slowest)
    return Starts(starts.member, starts.wind, orbits), good
