"""The distinct limit cycles found so far at the requested wind speeds, and the branches that connect them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, lengths, merge_axes
from engine.cycles.harmonic_balance import Orbits, balance, oscillation_size, select
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
        self.model = model
        self._locations: list[tuple[int, int]] = []
        self._orbits: list[tuple[FloatArray, float, float]] = []
        self._links: list[tuple[int, int]] = []
        self._joints: list[tuple[int, int]] = []
        self._followed: list[tuple[int, float]] = []
        self._left_alone: set[int] = set()
        self._sizes: list[float] = []
        self._found_by: list[FoundBy] = []
        self._by_location: dict[tuple[int, int], list[tuple[int, FloatArray]]] = {}

    def __len__(self) -> int:
        """Return the number of distinct cycles."""
        return len(self._orbits)

    def locations(self, ids: IntArray) -> tuple[IntArray, IntArray]:
        """Return member and wind speed index of the cycles with these numbers: (k,), (k,)."""
        member, wind = np.array([self._locations[i] for i in ids], dtype=np.intp).reshape(-1, 2).T
        return member, wind

    def orbits(self, ids: IntArray) -> Orbits:
        """Return the orbits of the cycles with these numbers, padded to the most harmonics among them."""
        size = self.model.mass.shape[-1]
        if ids.size == 0:
            return Orbits(np.zeros((0, size, 3)), np.zeros(0), np.zeros(0))
        coefficients, frequency, speed = zip(*(self._orbits[i] for i in ids), strict=True)
        padded = np.zeros((ids.size, size, max(own.shape[-1] for own in coefficients)))
        for row, own in zip(padded, coefficients, strict=True):
            row[:, : own.shape[-1]] = own
        return Orbits(padded, np.array(frequency), np.array(speed))

    def harmonics(self, ids: IntArray) -> IntArray:
        """Return the number of harmonics that each of the cycles with these numbers was solved with."""
        return np.array([self._orbits[i][0].shape[-1] // 2 for i in ids], dtype=np.intp)

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
        if not self._locations:
            return np.full((starts.member.size, 1), np.inf)
        place = np.array(self._locations, dtype=np.intp)
        winds = int(max(place[:, 1].max(initial=0), starts.wind.max(initial=0))) + 1
        key, asked = place[:, 0] * winds + place[:, 1], starts.member * winds + starts.wind
        order = np.argsort(key, kind="stable")
        first = np.searchsorted(key[order], asked)
        count = np.searchsorted(key[order], asked, side="right") - first
        column = np.arange(count.max(initial=1))
        known = order[np.minimum(first[:, None] + column, order.size - 1)]
        frequency = np.array([orbit[1] for orbit in self._orbits])[known]
        sizes = np.array(self._sizes)[known]
        size = lengths(_phase_invariants(self.model, starts))[:, None]
        near = np.abs(frequency / starts.orbits.angular_frequency[:, None] - 1.0) <= NEAR
        return np.where(near & (column < count[:, None]), np.abs(np.log(sizes / size)), np.inf)

    def add(self, starts: Starts, good: BoolArray, found_by: FoundBy) -> IntArray:
        """Record the solutions marked good; return the number of each one's cycle, -1 for the others: (starts,)."""
        invariants = _phase_invariants(self.model, starts)
        sizes = lengths(invariants).tolist()
        numbers = np.full(good.size, -1, dtype=np.intp)
        for i in np.flatnonzero(good).tolist():
            key = (int(starts.member[i]), int(starts.wind[i]))
            number, new = self._number_of(key, invariants[i])
            numbers[i] = number
            if new:
                self._locations.append(key)
                self._sizes.append(sizes[i])
                self._found_by.append(found_by)
                orbits = starts.orbits
                self._orbits.append(
                    (orbits.coefficients[i], float(orbits.angular_frequency[i]), float(orbits.wind_speed[i]))
                )
        return numbers

    def _number_of(self, key: tuple[int, int], invariants: FloatArray) -> tuple[int, bool]:
        known = self._by_location.setdefault(key, [])
        for number, other in known:
            unfollowed = invariants - other
            if float(unfollowed @ unfollowed) <= (SAME * self._sizes[number]) ** 2:
                return number, False
        known.append((len(self._orbits), invariants))
        return len(self._orbits), True

    def add_branches(self, members: IntArray, born: FloatArray) -> IntArray:
        """Record followed branches and return their numbers: (branches,).

        Parameters
        ----------
        members : (branches,)
            The model of each.
        born : (branches,)
            Wind speed of the Hopf point where each starts, infinite if there is none [m/s].
        """
        first = len(self._followed)
        self._followed += zip(members.tolist(), born.tolist(), strict=True)
        return np.arange(first, len(self._followed))

    def link(self, followed: IntArray, numbers: IntArray) -> None:
        """Record that cycles (k,) lie on followed branches (k,)."""
        self._links += zip(numbers.tolist(), followed.tolist(), strict=True)

    def join(self, joints: Sequence[tuple[int, int]]) -> None:
        """Record pairs of followed branches that are parts of one."""
        self._joints += joints

    def leave_alone(self, numbers: IntArray) -> None:
        """Record that the branches of these cycles are not to be followed."""
        self._left_alone.update(numbers.tolist())

    def unfollowed(self) -> IntArray:
        """Return, for each member, the cycle at the lowest wind speed that lies on no followed branch yet."""
        lowest: dict[int, int] = {}
        lies_on_one = {number for number, _ in self._links} | self._left_alone
        for number, (member, wind) in enumerate(self._locations):
            if number not in lies_on_one and (member not in lowest or wind < self._locations[lowest[member]][1]):
                lowest[member] = number
        return np.array(list(lowest.values()), dtype=np.intp)

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
        keys: dict[int, tuple[int, float, float, int]] = {}
        nodes = [(member, np.inf, float(wind)) for member, wind in self._locations]
        nodes += [(member, born, np.inf) for member, born in self._followed]
        for root, node in zip(label.tolist(), nodes, strict=True):
            keys[root] = min((*node, root), keys.get(root, (*node, root)))
        number: dict[int, int] = {}
        counts: dict[int, int] = {}
        for member, _, _, root in sorted(keys.values()):
            number[root] = counts.get(member, 0)
            counts[member] = number[root] + 1
        numbers = np.array([number[root] for root in label.tolist()], dtype=np.intp)
        return numbers[: len(self)], numbers[len(self) :]

    def _labels(self) -> IntArray:
        """Label the connected families of cycles and followed families: (cycles + branches,)."""
        # Union-find by hand, because importing scipy.sparse takes longer than a whole analysis.
        parents = list(range(len(self._locations) + len(self._followed)))
        for cycle, branch in self._links:
            parents[_root(parents, cycle)] = _root(parents, len(self._locations) + branch)
        for one, other in self._joints:
            parents[_root(parents, len(self._locations) + one)] = _root(parents, len(self._locations) + other)
        return np.array([_root(parents, node) for node in range(len(parents))], dtype=np.intp)


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
    size = np.hypot(coefficients[..., 1::2], coefficients[..., 2::2])
    return np.concatenate([coefficients[..., 0], merge_axes(size, -2)], axis=-1)


def solve_starts(model: ReducedModel, starts: Starts, options: NewtonOptions | None = None) -> tuple[Starts, BoolArray]:
    """Solve the balance from all starts; return the solutions and which of them are cycles (starts,)."""
    orbits, solution = balance(model, starts.member, starts.orbits, options)
    before = oscillation_size(model, starts.member, starts.orbits)
    size = oscillation_size(model, starts.member, orbits)
    slowest = lowest_frequency(model)[starts.member]
    good = solution.converged & (size > SMALLEST * before) & (orbits.angular_frequency > SLOWEST * slowest)
    return Starts(starts.member, starts.wind, orbits), good
