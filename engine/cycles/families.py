"""Bookkeeping of limit cycles at the wind speeds asked for: which are distinct and which lie on one branch."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, lengths, merged
from engine.cycles.harmonic_balance import Orbits, pick
from engine.models.reduced_model import ReducedModel
from engine.result import FoundBy

SAME = 1e-3  # relative distance below which two solutions are one
NEAR = 0.02  # relative difference of frequency up to which a guess may point to a known cycle


@dataclass(frozen=True, slots=True)
class Starts:
    """First guesses: member and wind index of each, and the orbit guessed."""

    member: IntArray
    wind: IntArray
    orbits: Orbits


class CycleFamily:
    """Distinct cycles as they are found, numbered from 0, and the branches that they lie on."""

    def __init__(self, model: ReducedModel) -> None:
        """Begin without cycles of a stack of models."""
        self._model = model
        self._place: list[tuple[int, int]] = []
        self._orbits: list[tuple[FloatArray, float, float]] = []
        self._links: list[tuple[int, int]] = []
        self._followed: list[tuple[int, float]] = []
        self._sizes: list[float] = []
        self._found_by: list[FoundBy] = []
        self._known: dict[tuple[int, int], list[tuple[int, FloatArray]]] = {}

    def __len__(self) -> int:
        """Return the number of distinct cycles."""
        return len(self._orbits)

    def places(self, ids: IntArray) -> tuple[IntArray, IntArray]:
        """Return member and wind index of the cycles with these numbers."""
        member, wind = np.array([self._place[i] for i in ids], dtype=np.intp).reshape(-1, 2).T
        return member, wind

    def orbits_of(self, ids: IntArray) -> Orbits:
        """Stack the orbits with these numbers."""
        size = self._model.mass.shape[-1]
        if ids.size == 0:
            return Orbits(np.zeros((0, size, 3)), np.zeros(0), np.zeros(0))
        coefficients, frequency, speed = zip(*(self._orbits[i] for i in ids), strict=True)
        return Orbits(np.stack(coefficients), np.array(frequency), np.array(speed))

    @property
    def found_by(self) -> tuple[FoundBy, ...]:
        """How each cycle was found first."""
        return tuple(self._found_by)

    def unlike_known(self, starts: Starts) -> Starts:
        """Leave out the starts that point to a known cycle of their member and wind speed.

        A start points to the cycle of nearest size among those of nearly its frequency; of several that point to one,
        all but the nearest are kept.
        """
        unlike = self._difference(starts)
        nearest, distance = unlike.argmin(axis=-1), unlike.min(axis=-1)
        order = np.lexsort((distance, nearest, starts.wind, starts.member))
        target = np.stack([starts.member, starts.wind, nearest], axis=-1)[order]
        first = np.ones(order.size, dtype=np.bool_)
        first[1:] = (target[1:] != target[:-1]).any(axis=-1)
        index = np.sort(order[~(first & np.isfinite(distance[order]))])
        return Starts(starts.member[index], starts.wind[index], pick(starts.orbits, index))

    def _difference(self, starts: Starts) -> FloatArray:
        """Compare the sizes of starts with those of the known cycles of their places: (starts, most cycles of a place).

        Infinite where the frequencies differ or there is no such cycle.
        """
        if not self._place:
            return np.full((starts.member.size, 1), np.inf)
        place = np.array(self._place, dtype=np.intp)
        winds = int(max(place[:, 1].max(initial=0), starts.wind.max(initial=0))) + 1
        key, asked = place[:, 0] * winds + place[:, 1], starts.member * winds + starts.wind
        order = np.argsort(key, kind="stable")
        first = np.searchsorted(key[order], asked)
        count = np.searchsorted(key[order], asked, side="right") - first
        column = np.arange(count.max(initial=1))
        known = order[np.minimum(first[:, None] + column, order.size - 1)]
        frequency = np.array([orbit[1] for orbit in self._orbits])[known]
        sizes = np.array(self._sizes)[known]
        size = lengths(_signature(self._model, starts))[:, None]
        near = np.abs(frequency / starts.orbits.angular_frequency[:, None] - 1.0) <= NEAR
        return np.where(near & (column < count[:, None]), np.abs(np.log(sizes / size)), np.inf)

    def add(self, starts: Starts, good: BoolArray, found_by: FoundBy) -> IntArray:
        """Record the good ones of these solutions and return the number of each, -1 for the others: (starts,)."""
        signatures = _signature(self._model, starts)
        sizes = lengths(signatures).tolist()
        numbers = np.full(good.size, -1, dtype=np.intp)
        for i in np.flatnonzero(good).tolist():
            key = (int(starts.member[i]), int(starts.wind[i]))
            number, new = self._number(key, signatures[i])
            numbers[i] = number
            if new:
                self._place.append(key)
                self._sizes.append(sizes[i])
                self._found_by.append(found_by)
                orbits = starts.orbits
                self._orbits.append(
                    (orbits.coefficients[i], float(orbits.angular_frequency[i]), float(orbits.wind_speed[i]))
                )
        return numbers

    def _number(self, key: tuple[int, int], signature: FloatArray) -> tuple[int, bool]:
        known = self._known.setdefault(key, [])
        for number, other in known:
            apart = signature - other
            if float(apart @ apart) <= (SAME * self._sizes[number]) ** 2:
                return number, False
        known.append((len(self._orbits), signature))
        return len(self._orbits), True

    def follow(self, members: IntArray, born: FloatArray) -> IntArray:
        """Take note of followed branches and number them: (branches,).

        Parameters
        ----------
        members : (branches,)
            Their models.
        born : (branches,)
            Wind speed of the Hopf point that each comes from, infinite where it has none [m/s].
        """
        first = len(self._followed)
        self._followed += zip(members.tolist(), born.tolist(), strict=True)
        return np.arange(first, len(self._followed))

    def join(self, followed: IntArray, numbers: IntArray) -> None:
        """Say that cycles (k,) lie on these followed branches (k,)."""
        self._links += zip(numbers.tolist(), followed.tolist(), strict=True)

    def apart(self) -> IntArray:
        """Return the cycle at the lowest wind speed of each member that lies on no followed branch."""
        lowest: dict[int, int] = {}
        lies_on_one = {number for number, _ in self._links}
        for number, (member, wind) in enumerate(self._place):
            if number not in lies_on_one and (member not in lowest or wind < self._place[lowest[member]][1]):
                lowest[member] = number
        return np.array(list(lowest.values()), dtype=np.intp)

    def branches(self) -> tuple[IntArray, IntArray]:
        """Number the families of connected cycles and followed branches of each member from 0.

        They are ordered by their lowest Hopf point, those without one by their lowest wind speed after them.

        Returns
        -------
        (cycles,), (branches,)
            The family of each cycle and of each followed branch.
        """
        label = self._labels()
        keys: dict[int, tuple[int, float, float, int]] = {}
        nodes = [(member, np.inf, float(wind)) for member, wind in self._place]
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
        """Label the connected families of cycles and followed branches: (cycles + branches,)."""
        # By hand: to import scipy.sparse takes longer than a whole analysis.
        above = list(range(len(self._place) + len(self._followed)))
        for cycle, branch in self._links:
            above[_root(above, cycle)] = _root(above, len(self._place) + branch)
        return np.array([_root(above, node) for node in range(len(above))], dtype=np.intp)


def _root(above: list[int], node: int) -> int:
    """Climb to the top of a tree, shortening the way for the next."""
    while above[node] != node:
        above[node] = above[above[node]]
        node = above[node]
    return node


def _signature(model: ReducedModel, starts: Starts) -> FloatArray:
    """Return what does not depend on the phase: weighted means and sizes of every harmonic, (cycles, ...)."""
    weight = np.sqrt(np.diagonal(model.mass, axis1=-2, axis2=-1))[starts.member]
    coefficients = starts.orbits.coefficients * weight[..., None]
    size = np.hypot(coefficients[..., 1::2], coefficients[..., 2::2])
    return np.concatenate([coefficients[..., 0], merged(size, -2)], axis=-1)
