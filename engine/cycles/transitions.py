"""Where bifurcations lie on followed branches, so that every change of stability has one. Theory section 7.3.

The number of growing multipliers is counted at every point. Where it differs between two neighbours and the zeros of
the test functions do not explain it, or where several bifurcations share a segment, the segment is divided.
"""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from itertools import product

import numpy as np

from engine.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from engine.cycles.branch_set import BranchSet
from engine.cycles.harmonic_balance import total_size
from engine.cycles.refinement import ROUNDING, divided

ROUNDS = 4  # of dividing segments
PARTS = 4
MOST_POINTS = 600  # of a branch, beyond which its changes are left unresolved: such a branch crosses a region of many
TINY = 0.02  # share of a branch's reference size below which a cycle counts as the equilibrium
MARGIN = 3.0  # on the error of the multipliers
SHORTEST = 1e-6  # relative distance of two wind speeds between which nothing is divided any more


class Kind(StrEnum):
    """Types of bifurcations, with the words that results carry; unresolved: stability changes for an unknown cause."""

    HOPF = "hopf"
    FOLD = "fold"
    TORUS = "torus"
    PERIOD_DOUBLING = "period_doubling"
    BRANCH_POINT = "branch_point"
    UNRESOLVED = "unresolved"


Factors = Callable[[ComplexArray], ComplexArray]


def _pair_factors(multipliers: ComplexArray) -> ComplexArray:
    i, j = np.triu_indices(multipliers.shape[-1], 1)
    with np.errstate(over="ignore", invalid="ignore"):  # see `product_of`
        return 1.0 - np.take(multipliers, i, axis=-1) * np.take(multipliers, j, axis=-1)


def branch_point_factors(multipliers: ComplexArray) -> ComplexArray:
    """Return the factors of the test function for branch points and folds."""
    return 1.0 - multipliers


FACTORS: dict[Kind, Factors] = {
    Kind.TORUS: _pair_factors,
    Kind.PERIOD_DOUBLING: lambda multipliers: 1.0 + multipliers,
    Kind.BRANCH_POINT: branch_point_factors,
}

# By how much each may change the number of growing multipliers. Two real ones whose product passes 1 change nothing.
CHANGES: dict[Kind, tuple[int, ...]] = {
    Kind.FOLD: (-1, 1),
    Kind.TORUS: (-2, 0, 2),
    Kind.PERIOD_DOUBLING: (-1, 1),
    Kind.BRANCH_POINT: (-1, 1),
}


@dataclass(frozen=True, slots=True)
class Transitions:
    """Pairs of points on a branch between which bifurcations lie, one entry for each pair and kind.

    left, right: (k,), indices of the points; kind: (k,) of Kind; changed: (k,), by how much the number of growing
    multipliers differs; may_end: (k,), False where the cycle is unstable throughout for certain.
    """

    left: IntArray
    right: IntArray
    kind: list[Kind]
    changed: IntArray
    may_end: BoolArray

    def select(self, index: IntArray) -> "Transitions":
        """Select some of them."""
        kind = [self.kind[i] for i in index.tolist()]
        return Transitions(self.left[index], self.right[index], kind, self.changed[index], self.may_end[index])


def transitions(branch_set: BranchSet) -> tuple[BranchSet, Transitions]:
    """Return the branches, with points inserted where they are needed, and where the bifurcations on them lie."""
    left_alone = np.zeros(branch_set.points.branch.size, dtype=np.bool_)
    for turn in range(ROUNDS + 1):
        pairs, found, changed = _changes(branch_set)
        unclear = np.array([not _explains(kinds, by) for kinds, by in zip(found, changed.tolist(), strict=True)])
        speed = branch_set.points.z[:, -1]
        far = np.abs(np.diff(speed[pairs], axis=-1)[:, 0]) > SHORTEST * speed[pairs[:, 0]]
        divisible = np.flatnonzero(unclear.astype(np.bool_) & far)
        segment = np.concatenate([np.arange(*pairs[i]) for i in divisible] or [np.zeros(0, dtype=np.intp)])
        points = np.bincount(branch_set.points.branch, minlength=1)[branch_set.points.branch[segment]]
        segment = segment[~left_alone[segment] & (points < MOST_POINTS)]
        if turn == ROUNDS or segment.size == 0:
            break
        branch_set, left_alone, _ = divided(branch_set, segment, np.full(segment.size, PARTS), left_alone)
    return branch_set, _listed(branch_set, pairs, found, changed)


def _listed(branch_set: BranchSet, pairs: IntArray, found: list[tuple[Kind, ...]], changed: IntArray) -> Transitions:
    """Return an entry for each bifurcation between pairs of points, and one where none explains the change."""
    growing = _growing(branch_set) > 0
    entries: list[tuple[int, Kind]] = []
    for i, (kinds, by) in enumerate(zip(found, changed.tolist(), strict=True)):
        entries += [(i, kind) for kind in kinds]
        if not _sums_to(kinds, by):
            entries.append((i, Kind.UNRESOLVED))
    index = np.array([i for i, _ in entries], dtype=np.intp)
    # Several bifurcations may leave stable cycles between them, although both ends are unstable.
    several = np.array([len(found[i]) > 1 for i, _ in entries], dtype=np.bool_)
    left, right = pairs[index].T
    may_end = several | ~(growing[left] & growing[right])
    return Transitions(left, right, [kind for _, kind in entries], changed[index], may_end)


def _explains(kinds: tuple[Kind, ...], changed: int) -> bool:
    """Return whether at most one bifurcation lies there, and it explains the change of the growing multipliers."""
    return len(kinds) <= 1 and _sums_to(kinds, changed)


def _sums_to(kinds: tuple[Kind, ...], changed: int) -> bool:
    return any(sum(parts) == changed for parts in product(*(CHANGES[kind] for kind in kinds)))


def _growing(branch_set: BranchSet) -> IntArray:
    """Return the number of growing multipliers of each point: (points,)."""
    return np.asarray((np.abs(branch_set.floquet.multipliers[:, 1:]) > 1.0).sum(axis=-1))


def _changes(branch_set: BranchSet) -> tuple[IntArray, list[tuple[Kind, ...]], IntArray]:
    """Return pairs of neighbours (k, 2) that differ, what lies between them, and the change of growing multipliers."""
    points = branch_set.points
    known = np.flatnonzero(_decided(branch_set))
    left, right = known[:-1], known[1:]
    same = points.branch[left] == points.branch[right]
    left, right = left[same], right[same]
    slopes, multipliers = points.tangent[:, -1], branch_set.floquet.multipliers[:, 1:]
    differs = {Kind.FOLD: slopes[left] * slopes[right] < 0.0}
    for kind, factors in FACTORS.items():
        value = product_of(factors(multipliers))
        differs[kind] = value[left] * value[right] < 0.0
    differs[Kind.BRANCH_POINT] &= ~differs[Kind.FOLD]
    growing = _growing(branch_set)
    changed = growing[right] - growing[left]
    here = np.flatnonzero(np.any(list(differs.values()), axis=0) | (changed != 0))
    found = [tuple(kind for kind, at in differs.items() if at[i]) for i in here.tolist()]
    return _whole_folds(np.stack([left[here], right[here]], axis=-1), found, changed[here])


def _whole_folds(
    pairs: IntArray, found: list[tuple[Kind, ...]], changed: IntArray
) -> tuple[IntArray, list[tuple[Kind, ...]], IntArray]:
    """Join a fold, where the branch turns, with the multiplier's passing of 1 that belongs to it in the next segment.

    A point that Newton's method left a millionth beside its branch has a multiplier on the wrong side.
    """
    ends, kinds, by = pairs.tolist(), list(found), changed.tolist()
    turning, passing = (Kind.FOLD,), (Kind.BRANCH_POINT,)
    for i in range(len(ends) - 2, -1, -1):
        halves = ends[i][1] == ends[i + 1][0] and {kinds[i], kinds[i + 1]} == {turning, passing}
        alone = by[i] if kinds[i] == turning else by[i + 1]
        if halves and not _sums_to(turning, alone) and _sums_to(turning, by[i] + by[i + 1]):
            ends[i : i + 2], kinds[i : i + 2] = [[ends[i][0], ends[i + 1][1]]], [turning]
            by[i : i + 2] = [by[i] + by[i + 1]]
    return np.array(ends, dtype=np.intp).reshape(-1, 2), kinds, np.array(by, dtype=np.intp)


def _decided(branch_set: BranchSet) -> BoolArray:
    """Return at which points every multiplier is off the unit circle by more than its error, with some margin.

    Near the equilibrium a cycle has no direction that tells whether its branch turns or ends.
    """
    points, judged = branch_set.points, branch_set.floquet
    branch = points.branch
    first = np.append(True, branch[1:] != branch[:-1])[: branch.size]
    at_equilibrium = first & np.isfinite(branch_set.hopf_wind_speed[branch])
    size = np.abs(judged.multipliers)
    off = np.abs(size[:, 1:] - 1.0).min(axis=-1, initial=np.inf)
    error = np.maximum(judged.trivial_error, ROUNDING * size.max(axis=-1, initial=0.0))
    problem = branch_set.problem
    amplitude = total_size(problem.model, branch_set.member, branch_set.orbits.coefficients)
    at_equilibrium |= amplitude < TINY * problem.reference[branch]
    return np.asarray(~at_equilibrium & (off > MARGIN * error))


def product_of(factors: ComplexArray) -> FloatArray:
    """Return the product of factors (..., n), each limited to modulus 1 so that it cannot overflow: (...)."""
    with np.errstate(invalid="ignore"):  # multipliers that overflowed yield NaN
        limited = factors * (1.0 / np.maximum(np.abs(factors), 1.0))
        side_by_side = np.moveaxis(limited, -1, 0).copy()  # a product along the last axis takes three times as long
        return np.asarray(np.prod(side_by_side, axis=0).real)
