"""All limit cycles that can be reached at the requested wind speeds. Theory sections 7.1 to 7.3.

Every start is balanced; every cycle found is carried to the neighbouring wind speeds until nothing new appears. Cycles
that lead to one another form a branch.
"""

from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, merged
from engine.describing import FirstHarmonic, energy_balance_cycles, explicit_cycles
from engine.floquet import Floquet, floquet
from engine.harmonic import Orbits, balance, oscillation_size, pick, resized
from engine.hybrid import ReducedModel, take

SAME = 1e-3  # relative distance below which two solutions are one
UNRESOLVED = 1e-4  # error of the trivial multiplier above which more harmonics are taken
SMALLEST = 1e-6  # of the start's size: a smaller solution is the equilibrium
MOST_HARMONICS = 12
SLOWEST = 0.1  # of the lowest natural frequency: a slower solution is a static one in disguise
NEAR = 0.02  # relative difference of frequency below which a guess adds nothing to a known cycle
ALIKE = 3.0  # ratio of sizes up to which neighbours may be the same motion


@dataclass(frozen=True, slots=True)
class Starts:
    """First guesses: member and wind index of each, and the orbit guessed."""

    member: IntArray
    wind: IntArray
    orbits: Orbits


@dataclass(frozen=True, slots=True)
class Cycles:
    """Limit cycles of a stack of models.

    member, wind: (cycles,), indices of model and wind speed; branch: (cycles,), number of the connected family within
    its member, in the order of discovery from low wind speeds up; dropped: (members,), solutions left out because
    more harmonics did not resolve them either.
    """

    member: IntArray
    wind: IntArray
    branch: IntArray
    orbits: Orbits
    floquet: Floquet
    dropped: IntArray


def energy_starts(model: ReducedModel, wind_speeds: FloatArray, harmonics: int) -> Starts:
    """Guess cycles of every unstable mode at every wind speed by the balance of energy."""
    member, wind = _grid(model, wind_speeds)
    guess = energy_balance_cycles(take(model, member), wind_speeds[wind])
    return _starts(guess, member, wind, wind_speeds, harmonics)


def explicit_starts(published: ReducedModel, wind_speeds: FloatArray, harmonics: int) -> Starts:
    """Take the explicit cycles of the published closure as guesses, for members that are statically stable."""
    member, wind = _grid(published, wind_speeds)
    guess = explicit_cycles(take(published, member), wind_speeds[wind])
    return _starts(guess, member, wind, wind_speeds, harmonics)


def joined(*starts: Starts) -> Starts:
    """Put several sets of starts together."""
    return Starts(
        np.concatenate([s.member for s in starts]),
        np.concatenate([s.wind for s in starts]),
        joined_orbits(*(s.orbits for s in starts)),
    )


def joined_orbits(*orbits: Orbits) -> Orbits:
    """Put several stacks of orbits with equal harmonics together."""
    return Orbits(
        np.concatenate([o.coefficients for o in orbits]),
        np.concatenate([o.angular_frequency for o in orbits]),
        np.concatenate([o.wind_speed for o in orbits]),
    )


def find_cycles(model: ReducedModel, wind_speeds: FloatArray, *guesses: Starts) -> Cycles:
    """Find every cycle that the guesses and continuation over the wind speeds reach.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    wind_speeds : (winds,)
        In rising order [m/s].
    *guesses : Starts
        In the order of trust: of a later set only those are balanced near whose frequency nothing was found.

    Returns
    -------
    Cycles
        Sorted by member, wind speed and branch.
    """
    family = _Family(model)
    for guess in guesses:
        wanted = family.lacking(guess)
        if wanted.member.size:
            family.add(_solved(model, wanted))
    frontier = np.arange(len(family.orbits))
    while frontier.size:
        origin, wind = family.loose_ends(frontier, wind_speeds.size)
        here = family.orbits_of(origin)
        orbits = Orbits(here.coefficients, here.angular_frequency, wind_speeds[wind])
        before = len(family.orbits)
        family.add(_solved(model, Starts(family.member[origin], wind, orbits)), origin)
        frontier = np.arange(before, len(family.orbits))
    return _judged(model, family)


class _Family:
    """Distinct cycles as they are found, with the links between neighbours; only `find_cycles` uses it."""

    def __init__(self, model: ReducedModel) -> None:
        self.model = model
        self.member: IntArray = np.zeros(0, dtype=np.intp)
        self.wind: IntArray = np.zeros(0, dtype=np.intp)
        self.orbits: list[tuple[FloatArray, float, float]] = []
        self.links: list[tuple[int, int]] = []
        self._signatures: list[FloatArray] = []
        self._known: dict[tuple[int, int], list[tuple[int, FloatArray]]] = {}

    def orbits_of(self, ids: IntArray) -> Orbits:
        """Stack the orbits with these numbers."""
        size = self.model.mass.shape[-1]
        if ids.size == 0:
            return Orbits(np.zeros((0, size, 3)), np.zeros(0), np.zeros(0))
        coefficients, frequency, speed = zip(*(self.orbits[i] for i in ids), strict=True)
        return Orbits(np.stack(coefficients), np.array(frequency), np.array(speed))

    def lacking(self, starts: Starts) -> Starts:
        """Keep the starts near whose frequency no cycle of the same member and wind speed is known."""
        keep = [
            all(
                abs(self.orbits[number][1] - frequency) > NEAR * frequency
                for number, _ in self._known.get((member, wind), [])
            )
            for member, wind, frequency in zip(
                starts.member.tolist(), starts.wind.tolist(), starts.orbits.angular_frequency.tolist(), strict=True
            )
        ]
        index = np.flatnonzero(keep)
        return Starts(starts.member[index], starts.wind[index], pick(starts.orbits, index))

    def add(self, solved: tuple[Starts, BoolArray], origin: IntArray | None = None) -> None:
        """Record solutions, and links to the cycles that they were carried from."""
        starts, good = solved
        signatures = _signature(self.model, starts)
        for i in np.flatnonzero(good).tolist():
            key = (int(starts.member[i]), int(starts.wind[i]))
            number, new = self._number(key, signatures[i])
            if new:
                self.member, self.wind = np.append(self.member, key[0]), np.append(self.wind, key[1])
                orbits = starts.orbits
                self.orbits.append(
                    (orbits.coefficients[i], float(orbits.angular_frequency[i]), float(orbits.wind_speed[i]))
                )
            if origin is not None:
                self.links.append((int(origin[i]), number))

    def loose_ends(self, ids: IntArray, winds: int) -> tuple[IntArray, IntArray]:
        """Link neighbours that are plainly the same motion; return the cycles and winds that remain to be tried."""
        origin, wind = [], []
        for i in ids.tolist():
            for step in (-1, 1):
                there = int(self.wind[i]) + step
                if 0 <= there < winds:
                    mate = self._mate(i, there)
                    if mate is None:
                        origin.append(i)
                        wind.append(there)
                    else:
                        self.links.append((i, mate))
        return np.array(origin, dtype=np.intp), np.array(wind, dtype=np.intp)

    def _mate(self, i: int, wind: int) -> int | None:
        """Return the mutually nearest cycle at another wind speed if frequency and size agree with this one."""
        member = int(self.member[i])
        there = self._nearest((member, wind), self.signatures[i])
        if there is None or self._nearest((member, int(self.wind[i])), self.signatures[there]) != i:
            return None
        near = abs(self.orbits[i][1] - self.orbits[there][1]) <= NEAR * self.orbits[i][1]
        sizes = [float(np.linalg.norm(self.signatures[n])) for n in (i, there)]
        return there if near and max(sizes) <= ALIKE * min(sizes) else None

    def _nearest(self, key: tuple[int, int], signature: FloatArray) -> int | None:
        known = self._known.get(key, [])
        if len(known) < 2:
            return known[0][0] if known else None
        return min(known, key=lambda item: float(np.linalg.norm(item[1] - signature)))[0]

    @property
    def signatures(self) -> list[FloatArray]:
        """What identifies each cycle apart from its phase."""
        return self._signatures

    def _number(self, key: tuple[int, int], signature: FloatArray) -> tuple[int, bool]:
        known = self._known.setdefault(key, [])
        for number, other in known:
            if np.linalg.norm(signature - other) <= SAME * np.linalg.norm(other):
                return number, False
        known.append((len(self.orbits), signature))
        self._signatures.append(signature)
        return len(self.orbits), True

    def branches(self) -> IntArray:
        """Return the smallest number in the connected family of each cycle."""
        label = np.arange(len(self.orbits))
        changed = True
        while changed:
            changed = False
            for a, b in self.links:
                low = min(label[a], label[b])
                if label[a] != low or label[b] != low:
                    label[a] = label[b] = low
                    changed = True
        return label


def _grid(model: ReducedModel, wind_speeds: FloatArray) -> tuple[IntArray, IntArray]:
    usable = np.flatnonzero(~model.statically_unstable)
    return np.repeat(usable, wind_speeds.size), np.tile(np.arange(wind_speeds.size), usable.size)


def _starts(
    guess: FirstHarmonic,
    member: IntArray,
    wind: IntArray,
    wind_speeds: FloatArray,
    harmonics: int,
) -> Starts:
    """Turn guesses at points of the grid into orbits with more harmonics."""
    first = np.stack([guess.mean, guess.amplitude.real, -guess.amplitude.imag], axis=-1)
    orbits = Orbits(first, guess.angular_frequency, wind_speeds[wind[guess.member]])
    return Starts(member[guess.member], wind[guess.member], resized(orbits, harmonics))


def _solved(model: ReducedModel, starts: Starts) -> tuple[Starts, BoolArray]:
    """Balance all starts and tell which ended on a cycle."""
    orbits, solution = balance(model, starts.member, starts.orbits)
    before = oscillation_size(model, starts.member, starts.orbits)
    size = oscillation_size(model, starts.member, orbits)
    square = np.diagonal(model.stiffness, axis1=-2, axis2=-1) / np.diagonal(model.mass, axis1=-2, axis2=-1)
    slowest = np.sqrt(np.abs(square).min(axis=-1))[starts.member]
    good = solution.converged & (size > SMALLEST * before) & (orbits.angular_frequency > SLOWEST * slowest)
    return Starts(starts.member, starts.wind, orbits), good


def _signature(model: ReducedModel, starts: Starts) -> FloatArray:
    """Return what does not depend on the phase: weighted means and sizes of every harmonic, (cycles, ...)."""
    weight = np.sqrt(np.diagonal(model.mass, axis1=-2, axis2=-1))[starts.member]
    coefficients = starts.orbits.coefficients * weight[..., None]
    size = np.hypot(coefficients[..., 1::2], coefficients[..., 2::2])
    return np.concatenate([coefficients[..., 0], merged(size, -2)], axis=-1)


def _judged(model: ReducedModel, family: _Family) -> Cycles:
    """Judge the stability of all cycles, with more harmonics where they were too few."""
    members = model.mass.shape[0]
    if not family.orbits:
        return _nothing(model)
    orbits = family.orbits_of(np.arange(len(family.orbits)))
    judged = floquet(take(model, family.member), orbits)
    coarse = np.flatnonzero(~(judged.trivial_error <= UNRESOLVED))
    branch = family.branches()
    if coarse.size:
        orbits, judged = _refined(model, family.member, orbits, judged, coarse)
    keep = judged.trivial_error <= UNRESOLVED
    dropped = np.bincount(family.member[~keep], minlength=members)
    order = np.flatnonzero(keep)
    order = order[np.lexsort((branch[order], family.wind[order], family.member[order]))]
    return Cycles(
        family.member[order],
        family.wind[order],
        _renumbered(family.member[order], family.wind[order], branch[order]),
        pick(orbits, order),
        Floquet(judged.multipliers[order], judged.trivial_error[order], judged.stability[order]),
        dropped,
    )


def _refined(
    model: ReducedModel, member: IntArray, orbits: Orbits, judged: Floquet, coarse: IntArray
) -> tuple[Orbits, Floquet]:
    """Balance some cycles again with the most harmonics and judge them anew."""
    harmonics = max(MOST_HARMONICS, orbits.coefficients.shape[-1] // 2)
    finer, solution = balance(model, member[coarse], resized(pick(orbits, coarse), harmonics))
    again = floquet(take(model, member[coarse]), finer)
    orbits = resized(orbits, harmonics)
    orbits.coefficients[coarse] = finer.coefficients
    frequency, multipliers = orbits.angular_frequency.copy(), judged.multipliers.copy()
    error, stability = judged.trivial_error.copy(), judged.stability.copy()
    frequency[coarse], multipliers[coarse], stability[coarse] = (
        finer.angular_frequency,
        again.multipliers,
        again.stability,
    )
    error[coarse] = np.where(solution.converged, again.trivial_error, np.inf)
    return Orbits(orbits.coefficients, frequency, orbits.wind_speed), Floquet(multipliers, error, stability)


def _renumbered(member: IntArray, wind: IntArray, branch: IntArray) -> IntArray:
    """Count the branches of each member from 0 in the order of their lowest wind speed."""
    numbers: dict[tuple[int, int], int] = {}
    count: dict[int, int] = {}
    for i in np.lexsort((branch, wind, member)):
        key = (int(member[i]), int(branch[i]))
        if key not in numbers:
            numbers[key] = count.get(key[0], 0)
            count[key[0]] = numbers[key] + 1
    return np.array([numbers[(int(m), int(b))] for m, b in zip(member, branch, strict=True)], dtype=np.intp)


def _nothing(model: ReducedModel) -> Cycles:
    m = model.mass.shape[-1]
    none = np.zeros(0, dtype=np.intp)
    empty = np.zeros(0)
    judged = Floquet(np.zeros((0, 2 * m), dtype=np.complex128), empty, np.zeros(0, dtype=np.object_))
    orbits = Orbits(np.zeros((0, m, 3)), empty, empty)
    return Cycles(none, none, none, orbits, judged, np.zeros(model.mass.shape[0], dtype=np.intp))
