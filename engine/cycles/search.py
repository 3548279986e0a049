"""Search for all limit cycles at the requested wind speeds. Theory sections 7.1 to 7.3.

Branches are followed from every Hopf point. Every further cycle that a start leads to is followed in both directions
until no new cycle appears. Cycles on the same branch, or on branches that share a cycle, form a family.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import ComplexArray, FloatArray, IntArray
from engine.cycles.at_rest import eigenvalues_at_rest
from engine.cycles.branch_set import BranchSet
from engine.cycles.branches import follow_from_cycles, guessed_cycles
from engine.cycles.floquet import Floquet
from engine.cycles.harmonic_balance import Orbits, resized, select
from engine.cycles.hopf_branches import branches_in_groups
from engine.cycles.known_cycles import KnownCycles, Starts, solve_starts
from engine.cycles.resolution import MOST_HARMONICS, harmonics_needed, resolved_in_groups, unresolved_members
from engine.cycles.starts import energy_starts
from engine.models.critical_wind_speeds import Crossings, unstable_pairs
from engine.models.reduced_model import ReducedModel, of_each_member, with_samples
from engine.numerics.newton import NewtonOptions
from engine.outcome import Stability
from engine.result import FoundBy

ROUGH = 2  # harmonics of a first solution: with the mean and the second harmonic, which stretching needs
ROUGHLY = NewtonOptions(tolerance=1e-3, iterations=14)
ROUGH_SAMPLES = 16  # of an unexpanded load; ten would do for a cubic one


@dataclass(frozen=True, slots=True)
class Cycles:
    """Limit cycles of a stack of models.

    member, wind: (cycles,), indices of model and wind speed; branch: (cycles,), number of the connected family within
    its member, numbered as `KnownCycles.families` does; dropped: (members,), number of solutions left out because more
    harmonics did not resolve them either; branch_sets: the branches that were followed; followed: (branches,), family
    of each branch, for all branch sets one after another; found_by, harmonics: (cycles,), the search that found each
    cycle and the number of harmonics that it was solved with.
    """

    member: IntArray
    wind: IntArray
    branch: IntArray
    orbits: Orbits
    floquet: Floquet
    dropped: IntArray
    branch_sets: tuple[BranchSet, ...]
    followed: IntArray
    found_by: tuple[FoundBy, ...]
    harmonics: IntArray
    unbounded: IntArray
    at_rest: ComplexArray


@dataclass(frozen=True, slots=True)
class Settled:
    """What direct integration finds at wind speeds without a stable cycle.

    starts: approximate cycles, of the motions that did not diverge; unbounded: as in `Cycles`.
    """

    starts: Starts
    unbounded: IntArray


@dataclass(frozen=True, slots=True)
class DirectIntegration:
    """What direct integration adds to the search for cycles.

    starts: all of them are tried; settle: integrates members at wind speeds, both (places,) indices, where neither the
    static state nor a known cycle is stable.
    """

    starts: Starts | None = None
    settle: Callable[[IntArray, IntArray], Settled] | None = None


def find_cycles(
    model: ReducedModel,
    crossings: Crossings,
    wind_speeds: FloatArray,
    starts: Starts,
    harmonics: int,
    integration: DirectIntegration | None = None,
) -> Cycles:
    """Find the cycles at the wind speeds that lie on a branch from a Hopf point or that a start leads to.

    Starts along every unstable mode, by the balance of energy, are tried as well. Starts that are likely to lead to a
    known cycle are left out.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    crossings : Crossings
        Of these models up to the limit asked for; branches start at the Hopf points among them.
    wind_speeds : (winds,) or (members, winds)
        Of all members or of each, in rising order [m/s].
    starts : Starts
    harmonics : int
    integration : DirectIntegration, optional

    Returns
    -------
    Cycles
        Sorted by member, wind speed and branch.
    """
    known, wind_speeds = KnownCycles(model), of_each_member(model, wind_speeds)
    at_rest = eigenvalues_at_rest(model, wind_speeds)
    if wind_speeds.size == 0:
        return _sorted_cycles(known, (), at_rest)
    needed = harmonics_needed(model, wind_speeds, harmonics)
    branch_sets, joints = branches_in_groups(model, crossings, wind_speeds, needed)
    coarse = (needed > harmonics) & unresolved_members(model, branch_sets)
    if coarse.any():
        needed = np.where(coarse, MOST_HARMONICS, needed)
        branch_sets, joints = branches_in_groups(model, crossings, wind_speeds, needed)
    for branch_set in branch_sets:
        _add_cycles_on(known, branch_set, wind_speeds, "hopf_branch")
    known.join(joints)
    _add_solutions(known, _roughly_balanced(known, known.new_starts(starts)), needed, "explicit")
    energy = energy_starts(model, wind_speeds, harmonics, at_rest)
    _add_solutions(known, known.new_starts(energy), needed, "energy_balance")
    integration = integration or DirectIntegration()
    if integration.starts is not None:
        _add_solutions(known, integration.starts, needed, "direct_integration")
    _follow_new_cycles(known, branch_sets, wind_speeds)
    cycles = _sorted_cycles(known, tuple(branch_sets), at_rest)
    if integration.settle is None:
        return cycles
    member, wind = _without_stable_motion(model, cycles)
    if member.size == 0:
        return cycles
    settled = integration.settle(member, wind)
    before = len(known)
    _add_solutions(known, settled.starts, needed, "direct_integration")
    if len(known) > before:
        _follow_new_cycles(known, branch_sets, wind_speeds)
        cycles = _sorted_cycles(known, tuple(branch_sets), at_rest)
    return replace(cycles, unbounded=settled.unbounded)


def _follow_new_cycles(known: KnownCycles, branch_sets: list[BranchSet], wind_speeds: FloatArray) -> None:
    """Follow cycles that lie on no branch yet, both ways, until no new cycle appears; append their branches.

    A solution that more harmonics do not resolve is no cycle, and its branch would mean nothing.
    """
    while (unfollowed := known.unfollowed()).size:
        place, orbits, harmonics = known.locations(unfollowed), known.orbits(unfollowed), known.harmonics(unfollowed)
        resolved = resolved_in_groups(known.model, place[0], orbits, harmonics)[2]
        known.leave_alone(unfollowed[~resolved])
        unfollowed, harmonics = unfollowed[resolved], harmonics[resolved]
        for count in np.unique(harmonics).tolist():
            some = unfollowed[harmonics == count]
            member, _ = known.locations(some)
            branch_set = follow_from_cycles(known.model, member, known.orbits(some), wind_speeds)
            known.link(_add_cycles_on(known, branch_set, wind_speeds, "branch"), np.tile(some, 2))
            branch_sets.append(branch_set)


def _add_solutions(known: KnownCycles, starts: Starts, needed: IntArray, found_by: FoundBy) -> None:
    """Solve the balance from starts, with the number of harmonics that each member needs, and record the cycles."""
    for count in np.unique(needed[starts.member]).tolist():
        index = np.flatnonzero(needed[starts.member] == count)
        orbits = resized(select(starts.orbits, index), count)
        known.add(*solve_starts(known.model, Starts(starts.member[index], starts.wind[index], orbits)), found_by)


def _roughly_balanced(known: KnownCycles, starts: Starts) -> Starts:
    """Solve starts with few harmonics, and return those that lead to a motion and probably to no known cycle.

    The published closure leaves out stretching and the velocities of the relative wind. Under full physics most of its
    cycles are far from any, and the whole balance would find that out at twenty times the cost.
    """
    harmonics = max(starts.orbits.coefficients.shape[-1] // 2, 1)
    rough = Starts(starts.member, starts.wind, resized(starts.orbits, min(ROUGH, harmonics)))
    solved, good = solve_starts(with_samples(known.model, ROUGH_SAMPLES), rough, ROUGHLY)
    index = np.flatnonzero(good)
    orbits = resized(select(solved.orbits, index), harmonics)
    return known.new_starts(Starts(starts.member[index], starts.wind[index], orbits))


def _without_stable_motion(model: ReducedModel, cycles: Cycles) -> tuple[IntArray, IntArray]:
    """Return member and wind speed index (places,) where neither the static state nor a known cycle is stable."""
    stable = model.statically_unstable[:, None] | (unstable_pairs(cycles.at_rest) == 0)
    lasting = np.asarray(cycles.floquet.stability == Stability.STABLE, dtype=np.bool_)
    stable[cycles.member[lasting], cycles.wind[lasting]] = True
    member, wind = np.nonzero(~stable)
    return member, wind


def _add_cycles_on(known: KnownCycles, branch_set: BranchSet, winds: FloatArray, found_by: FoundBy) -> IntArray:
    """Solve for the cycles where followed branches cross the wind speeds; return the numbers of these branches."""
    followed = known.add_branches(branch_set.problem.member, branch_set.hopf_wind_speed)
    branch, wind, orbits = guessed_cycles(branch_set, winds[branch_set.problem.member])
    starts, good = solve_starts(branch_set.problem.model, Starts(branch_set.problem.member[branch], wind, orbits))
    numbers = known.add(starts, good, found_by)
    known.link(followed[branch[good]], numbers[good])
    return followed


def _sorted_cycles(known: KnownCycles, branch_sets: tuple[BranchSet, ...], at_rest: ComplexArray) -> Cycles:
    """Return all cycles with their stability, sorted by member, wind speed and branch."""
    model = known.model
    if not len(known):
        return _no_cycles(model, branch_sets, known.families()[1], at_rest)
    every_cycle = np.arange(len(known))
    member, wind = known.locations(every_cycle)
    orbits, floquet_result, resolved, harmonics = resolved_in_groups(
        model, member, known.orbits(every_cycle), known.harmonics(every_cycle)
    )
    (branch, followed), found_by = known.families(), known.found_by
    order = np.flatnonzero(resolved)
    order = order[np.lexsort((branch[order], wind[order], member[order]))]
    return Cycles(
        member[order],
        wind[order],
        branch[order],
        select(orbits, order),
        Floquet(
            floquet_result.multipliers[order], floquet_result.trivial_error[order], floquet_result.stability[order]
        ),
        np.bincount(member[~resolved], minlength=model.mass.shape[0]),
        branch_sets,
        followed,
        tuple(found_by[i] for i in order.tolist()),
        harmonics[order],
        np.zeros((0, 2), dtype=np.intp),
        at_rest,
    )


def _no_cycles(
    model: ReducedModel, branch_sets: tuple[BranchSet, ...], followed: IntArray, at_rest: ComplexArray
) -> Cycles:
    m = model.mass.shape[-1]
    none = np.zeros(0, dtype=np.intp)
    empty = np.zeros(0)
    floquet_result = Floquet(np.zeros((0, 2 * m), dtype=np.complex128), empty, np.zeros(0, dtype=np.object_))
    orbits = Orbits(np.zeros((0, m, 3)), empty, empty)
    dropped = np.zeros(model.mass.shape[0], dtype=np.intp)
    return Cycles(
        none, none, none, orbits, floquet_result, dropped, branch_sets, followed, (), none, none.reshape(0, 2), at_rest
    )
