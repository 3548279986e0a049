"""The branches of limit cycles from all Hopf points, each followed once. Theory section 7.2.

A branch that leaves the range of wind speeds may come back to a Hopf point beyond it. That point's branch would lead
through the whole range again, backwards; it ends where it meets the other one.
"""

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.cycles.branch_set import BranchSet
from engine.cycles.branches import (
    ends_at_hopf_points,
    entering,
    follow_from_hopf_points,
    followed_into,
    guessed_cycles,
    wind_limits,
)
from engine.cycles.harmonic_balance import select
from engine.cycles.known_cycles import KnownCycles, Starts, solve_starts
from engine.models.critical_wind_speeds import Crossings
from engine.models.reduced_model import ReducedModel


def branches_in_groups(
    model: ReducedModel, crossings: Crossings, winds: FloatArray, needed: IntArray
) -> tuple[list[BranchSet], list[tuple[int, int]]]:
    """Follow the branches from all Hopf points.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    crossings : Crossings
        Of these models.
    winds : (winds,) or (members, winds)
        Requested wind speeds in rising order [m/s].
    needed : (members,)
        Number of harmonics of each member.

    Returns
    -------
    list of BranchSet, list of pairs
        The branches, and pairs of branches that are parts of one, numbered through all branch sets.
    """
    branch_sets: list[BranchSet] = []
    joints: list[tuple[int, int]] = []
    for count in np.unique(needed).tolist():
        own = np.isin(crossings.member, np.flatnonzero(needed == count))
        before = sum(branch_set.problem.member.size for branch_set in branch_sets)
        parts, pairs = _branches_from_hopf_points(model, crossings, own, winds, count)
        branch_sets += parts
        joints += [(before + one, before + other) for one, other in pairs]
    return branch_sets, joints


def _branches_from_hopf_points(
    model: ReducedModel, crossings: Crossings, selected: BoolArray, winds: FloatArray, harmonics: int
) -> tuple[list[BranchSet], list[tuple[int, int]]]:
    """Follow the branches from all selected onsets, then from the Hopf points at which none of these ended.

    A branch from beyond the wind speeds that enters where one of the others left is the same, and ends there. Returns
    also the pairs of such branches.
    """
    onset = np.flatnonzero(crossings.oscillation & crossings.onset & selected)
    first = follow_from_hopf_points(model, crossings, onset, harmonics, winds)
    restabilizations = np.flatnonzero(crossings.oscillation & ~crossings.onset & selected)
    same = first.problem.member[:, None] == crossings.member[restabilizations]
    unreached = restabilizations[~(same & ends_at_hopf_points(first, crossings, restabilizations)).any(axis=0)]
    if not unreached.size:
        return [first], []
    second = follow_from_hopf_points(model, crossings, unreached, harmonics, winds, into_range=False)
    index = entering(second, winds)
    joints = _joints(first, second, index, winds)
    met = np.array([other for _, other in joints], dtype=np.intp)
    second = followed_into(second, np.setdiff1d(index, met), winds)
    return [first, second], [(one, onset.size + other) for one, other in joints]


def _joints(first: BranchSet, second: BranchSet, index: IntArray, winds: FloatArray) -> list[tuple[int, int]]:
    """Return pairs of branches, of the first set and of index (k,) of the second, that meet at the end of the range."""
    if index.size == 0:
        return []
    known = KnownCycles(first.problem.model)
    numbers, branches = [], []
    for branch_set, some in ((first, np.arange(first.problem.member.size)), (second, index)):
        highest = wind_limits(branch_set.problem, winds)[1]
        branch, wind, orbits = guessed_cycles(branch_set, highest[:, None])
        here = np.flatnonzero(np.isin(branch, some))
        member = branch_set.problem.member[branch[here]]
        starts, good = solve_starts(branch_set.problem.model, Starts(member, wind[here], select(orbits, here)))
        numbers.append(known.add(starts, good, "hopf_branch").tolist())
        branches.append(branch[here].tolist())
    owner = {number: branch for number, branch in zip(numbers[0], branches[0], strict=True) if number >= 0}
    return [(owner[n], branch) for n, branch in zip(numbers[1], branches[1], strict=True) if n in owner]
