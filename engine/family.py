"""Bookkeeping of limit cycles over wind speeds: which are distinct, which are the same motion, which form a branch."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, merged
from engine.harmonic import Orbits, pick
from engine.hybrid import ReducedModel

SAME = 1e-3  # relative distance below which two solutions are one
NEAR = 0.02  # relative difference of frequency up to which neighbours may be the same motion
ALIKE = 3.0  # ratio of sizes, likewise
GUESSED = 1.05  # ratio of sizes up to which a guess by energy leads to a cycle that is known


@dataclass(frozen=True, slots=True)
class Starts:
    """First guesses: member and wind index of each, and the orbit guessed."""

    member: IntArray
    wind: IntArray
    orbits: Orbits


class CycleFamily:
    """Distinct cycles as they are found, numbered from 0, and the links between neighbours in wind speed."""

    def __init__(self, model: ReducedModel) -> None:
        """Begin without cycles of a stack of models."""
        self._model = model
        self._place: list[tuple[int, int]] = []
        self._orbits: list[tuple[FloatArray, float, float]] = []
        self._links: list[tuple[int, int]] = []
        self._signatures: list[FloatArray] = []
        self._sizes: list[float] = []
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

    def unlike_known(self, starts: Starts) -> Starts:
        """Keep the starts that do not resemble a known cycle of their member and wind speed in frequency and size."""
        sizes = np.linalg.norm(_signature(self._model, starts), axis=-1).tolist()
        places = zip(starts.member.tolist(), starts.wind.tolist(), strict=True)
        frequencies = starts.orbits.angular_frequency.tolist()
        new = [
            not any(self._alike(number, *guess) for number, _ in self._known.get(place, []))
            for place, *guess in zip(places, frequencies, sizes, strict=True)
        ]
        index = np.flatnonzero(new)
        return Starts(starts.member[index], starts.wind[index], pick(starts.orbits, index))

    def _alike(self, number: int, frequency: float, size: float) -> bool:
        near = abs(self._orbits[number][1] - frequency) <= NEAR * frequency
        return near and max(size, self._sizes[number]) <= GUESSED * min(size, self._sizes[number])

    def add(self, starts: Starts, good: BoolArray, origin: IntArray | None = None) -> None:
        """Record the good ones of these solutions, and links to the cycles that they were carried from."""
        signatures = _signature(self._model, starts)
        sizes = np.linalg.norm(signatures, axis=-1).tolist()
        for i in np.flatnonzero(good).tolist():
            key = (int(starts.member[i]), int(starts.wind[i]))
            number, new = self._number(key, signatures[i])
            if new:
                self._place.append(key)
                self._sizes.append(sizes[i])
                orbits = starts.orbits
                self._orbits.append(
                    (orbits.coefficients[i], float(orbits.angular_frequency[i]), float(orbits.wind_speed[i]))
                )
            if origin is not None:
                self._links.append((int(origin[i]), number))

    def loose_ends(self, ids: IntArray, winds: int) -> tuple[IntArray, IntArray]:
        """Link neighbours that are plainly the same motion; return the cycles and winds that remain to be tried."""
        origin, wind = [], []
        for i in ids.tolist():
            for step in (-1, 1):
                there = self._place[i][1] + step
                if 0 <= there < winds:
                    mate = self._mate(i, there)
                    if mate is None:
                        origin.append(i)
                        wind.append(there)
                    else:
                        self._links.append((i, mate))
        return np.array(origin, dtype=np.intp), np.array(wind, dtype=np.intp)

    def _mate(self, i: int, wind: int) -> int | None:
        """Return the mutually nearest cycle at another wind speed if frequency and size agree with this one."""
        there = self._nearest((self._place[i][0], wind), self._signatures[i])
        if there is None or self._nearest(self._place[i], self._signatures[there]) != i:
            return None
        near = abs(self._orbits[i][1] - self._orbits[there][1]) <= NEAR * self._orbits[i][1]
        small, large = sorted((self._sizes[i], self._sizes[there]))
        return there if near and large <= ALIKE * small else None

    def _nearest(self, key: tuple[int, int], signature: FloatArray) -> int | None:
        known = self._known.get(key, [])
        if len(known) < 2:
            return known[0][0] if known else None
        return min(known, key=lambda item: float(np.linalg.norm(item[1] - signature)))[0]

    def _number(self, key: tuple[int, int], signature: FloatArray) -> tuple[int, bool]:
        known = self._known.setdefault(key, [])
        for number, other in known:
            if np.linalg.norm(signature - other) <= SAME * self._sizes[number]:
                return number, False
        known.append((len(self._orbits), signature))
        self._signatures.append(signature)
        return len(self._orbits), True

    def branches(self) -> IntArray:
        """Return the smallest number in the connected family of each cycle."""
        label = np.arange(len(self._orbits))
        changed = True
        while changed:
            changed = False
            for a, b in self._links:
                low = min(label[a], label[b])
                if label[a] != low or label[b] != low:
                    label[a] = label[b] = low
                    changed = True
        return label


def _signature(model: ReducedModel, starts: Starts) -> FloatArray:
    """Return what does not depend on the phase: weighted means and sizes of every harmonic, (cycles, ...)."""
    weight = np.sqrt(np.diagonal(model.mass, axis1=-2, axis2=-1))[starts.member]
    coefficients = starts.orbits.coefficients * weight[..., None]
    size = np.hypot(coefficients[..., 1::2], coefficients[..., 2::2])
    return np.concatenate([coefficients[..., 0], merged(size, -2)], axis=-1)
