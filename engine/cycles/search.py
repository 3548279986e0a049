"""All limit cycles that can be reached at the requested wind speeds. Theory sections 7.1 to 7.3.

Branches are followed from every Hopf point; whatever starts lead to besides is followed both ways until nothing new
appears. Cycles on one branch, or on branches that meet, form a family.
"""

from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.cycles.branches import SLOWEST, Traces, at_winds, reaches, traced_from_cycles, traced_from_hopf
from engine.cycles.families import CycleFamily, Starts
from engine.cycles.first_harmonic import FirstHarmonic, energy_balance_cycles, explicit_cycles
from engine.cycles.floquet import Floquet, floquet
from engine.cycles.harmonic_balance import Orbits, balance, oscillation_size, pick, resized
from engine.models.critical_wind_speeds import Crossings
from engine.models.reduced_model import ReducedModel, lowest_frequency, take
from engine.result import FoundBy

TAIL = 1e-4  # share of the last harmonics, or relative error of the multipliers, above which more effort is taken
SMALLEST = 1e-6  # of the start's size: a smaller solution is the equilibrium
MOST_HARMONICS = 12
FINENESS = 4  # times the steps of the Floquet integration for cycles that need more harmonics


@dataclass(frozen=True, slots=True)
class Cycles:
    """Limit cycles of a stack of models.

    member, wind: (cycles,), indices of model and wind speed; branch: (cycles,), number of the connected family within
    its member, by the lowest Hopf point that it comes from, families without one after those; dropped: (members,),
    solutions left out because more harmonics did not resolve them either; traces: the branches that were followed;
    followed: (branches,) of all traces one after another, the family of each; found_by, harmonics: (cycles,), how each
    was found and the number of harmonics that it took.
    """

    member: IntArray
    wind: IntArray
    branch: IntArray
    orbits: Orbits
    floquet: Floquet
    dropped: IntArray
    traces: tuple[Traces, ...]
    followed: IntArray
    found_by: tuple[FoundBy, ...]
    harmonics: IntArray


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


def find_cycles(
    model: ReducedModel,
    crossings: Crossings,
    wind_speeds: FloatArray,
    starts: Starts,
    harmonics: int,
    integrated: Starts | None = None,
) -> Cycles:
    """Find every cycle at the wind speeds that lies on a branch from a Hopf point or is reached from a start.

    The balance of energy of every unstable mode is tried as well; starts that point to a known cycle are left out.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    crossings : Crossings
        All that were asked for; branches begin at their Hopf points.
    wind_speeds : (winds,)
        In rising order [m/s].
    starts : Starts
    harmonics : int
    integrated : Starts, optional
        Where direct integration arrived; all of them are tried.

    Returns
    -------
    Cycles
        Sorted by member, wind speed and branch.
    """
    family = CycleFamily(model)
    if wind_speeds.size == 0:
        return _judged(model, family, ())
    traces = _from_hopf(model, crossings, wind_speeds, harmonics)
    for trace in traces:
        _cover(family, trace, wind_speeds, "hopf_branch")
    family.add(*solved_starts(model, family.unlike_known(starts)), "explicit")
    family.add(
        *solved_starts(model, family.unlike_known(energy_starts(model, wind_speeds, harmonics))), "energy_balance"
    )
    if integrated is not None:
        family.add(*solved_starts(model, integrated), "direct_integration")
    while (apart := family.apart()).size:
        member, _ = family.places(apart)
        trace = traced_from_cycles(model, member, family.orbits_of(apart), wind_speeds)
        family.join(_cover(family, trace, wind_speeds, "branch"), np.tile(apart, 2))
        traces.append(trace)
    return _judged(model, family, tuple(traces))


def _from_hopf(model: ReducedModel, crossings: Crossings, winds: FloatArray, harmonics: int) -> list[Traces]:
    """Follow the branches of all onsets, then of the Hopf points at which none of those ended."""
    onset = np.flatnonzero(crossings.oscillation & crossings.onset)
    first = traced_from_hopf(model, crossings, onset, harmonics, winds)
    rest = np.flatnonzero(crossings.oscillation & ~crossings.onset)
    same = first.problem.member[:, None] == crossings.member[rest]
    unreached = rest[~(same & reaches(first, crossings, rest)).any(axis=0)]
    if not unreached.size:
        return [first]
    return [first, traced_from_hopf(model, crossings, unreached, harmonics, winds)]


def _cover(family: CycleFamily, trace: Traces, winds: FloatArray, found_by: FoundBy) -> IntArray:
    """Solve for the cycles at the wind speeds that followed branches pass; return the numbers of these branches."""
    followed = family.follow(trace.problem.member, trace.born)
    branch, wind, orbits = at_winds(trace, winds)
    starts, good = solved_starts(trace.problem.model, Starts(trace.problem.member[branch], wind, orbits))
    numbers = family.add(starts, good, found_by)
    family.join(followed[branch[good]], numbers[good])
    return followed


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


def solved_starts(model: ReducedModel, starts: Starts) -> tuple[Starts, BoolArray]:
    """Balance all starts at members of a stack of models and tell which ended on a cycle."""
    orbits, solution = balance(model, starts.member, starts.orbits)
    before = oscillation_size(model, starts.member, starts.orbits)
    size = oscillation_size(model, starts.member, orbits)
    slowest = lowest_frequency(model)[starts.member]
    good = solution.converged & (size > SMALLEST * before) & (orbits.angular_frequency > SLOWEST * slowest)
    return Starts(starts.member, starts.wind, orbits), good


def _judged(model: ReducedModel, family: CycleFamily, traces: tuple[Traces, ...]) -> Cycles:
    """Judge the stability of all cycles and sort them."""
    if not len(family):
        return _nothing(model, traces, family.branches()[1])
    everything = np.arange(len(family))
    member, wind = family.places(everything)
    orbits = family.orbits_of(everything)
    orbits, judged, kept, harmonics = judged_orbits(model, member, orbits)
    (branch, followed), found_by = family.branches(), family.found_by
    order = np.flatnonzero(kept)
    order = order[np.lexsort((branch[order], wind[order], member[order]))]
    return Cycles(
        member[order],
        wind[order],
        branch[order],
        pick(orbits, order),
        Floquet(judged.multipliers[order], judged.trivial_error[order], judged.stability[order]),
        np.bincount(member[~kept], minlength=model.mass.shape[0]),
        traces,
        followed,
        tuple(found_by[i] for i in order.tolist()),
        harmonics[order],
    )


def judged_orbits(model: ReducedModel, member: IntArray, orbits: Orbits) -> tuple[Orbits, Floquet, BoolArray, IntArray]:
    """Judge the stability of cycles (k,), with more harmonics and finer steps where those taken are too few.

    Returns
    -------
    Orbits, Floquet, (k,), (k,)
        Which of them are resolved, and the number of harmonics that each took.
    """
    judged = floquet(model, member, orbits)
    largest = np.abs(judged.multipliers).max(axis=-1, initial=1.0)
    coarse = np.flatnonzero((_tail(model, member, orbits) > TAIL) | (judged.trivial_error > TAIL * largest))
    kept = np.ones(member.size, dtype=np.bool_)
    harmonics = np.full(member.size, orbits.coefficients.shape[-1] // 2)
    if coarse.size:
        orbits, judged, kept[coarse] = _refined(model, member, orbits, judged, coarse)
        harmonics[coarse] = orbits.coefficients.shape[-1] // 2
    return orbits, judged, kept, harmonics


def _tail(model: ReducedModel, member: IntArray, orbits: Orbits) -> FloatArray:
    """Return the share of the last two harmonics in the size of each cycle, 0 where fewer than three were asked for."""
    if orbits.coefficients.shape[-1] // 2 < 3:
        return np.zeros(member.size)
    last = Orbits(orbits.coefficients[..., -5:], orbits.angular_frequency, orbits.wind_speed)
    return oscillation_size(model, member, last) / oscillation_size(model, member, orbits)


def _refined(
    model: ReducedModel, member: IntArray, orbits: Orbits, judged: Floquet, coarse: IntArray
) -> tuple[Orbits, Floquet, BoolArray]:
    """Balance some cycles again with more harmonics, judge them anew, and tell which of them that resolved."""
    harmonics = max(MOST_HARMONICS, orbits.coefficients.shape[-1] // 2)
    finer, solution = balance(model, member[coarse], resized(pick(orbits, coarse), harmonics))
    again = floquet(model, member[coarse], finer, FINENESS)
    orbits = resized(orbits, harmonics)
    orbits.coefficients[coarse] = finer.coefficients
    frequency, multipliers = orbits.angular_frequency.copy(), judged.multipliers.copy()
    error, stability = judged.trivial_error.copy(), judged.stability.copy()
    frequency[coarse], multipliers[coarse] = finer.angular_frequency, again.multipliers
    error[coarse], stability[coarse] = again.trivial_error, again.stability
    resolved = solution.converged & (_tail(model, member[coarse], finer) <= TAIL)
    return Orbits(orbits.coefficients, frequency, orbits.wind_speed), Floquet(multipliers, error, stability), resolved


def _nothing(model: ReducedModel, traces: tuple[Traces, ...], followed: IntArray) -> Cycles:
    m = model.mass.shape[-1]
    none = np.zeros(0, dtype=np.intp)
    empty = np.zeros(0)
    judged = Floquet(np.zeros((0, 2 * m), dtype=np.complex128), empty, np.zeros(0, dtype=np.object_))
    orbits = Orbits(np.zeros((0, m, 3)), empty, empty)
    dropped = np.zeros(model.mass.shape[0], dtype=np.intp)
    return Cycles(none, none, none, orbits, judged, dropped, traces, followed, (), none)
