"""Points inserted on followed branches where too much happens between two of them. Theory sections 7.2 and 7.3.

A lightly damped mode that passes a multiple of half the cycle's frequency can fold the branch, or end and restore its
stability, within a ten-thousandth of the wind speed. The continuation steps over that without a trace; the Floquet
exponents show it, because one of them passes the real axis on its way.
"""

from dataclasses import replace
from enum import Enum

import numpy as np

from engine.arrays import BoolArray, ComplexArray, FloatArray, IntArray, ObjectArray, filled, lengths
from engine.cycles.branch_set import FINE_SHARE, BranchSet, CycleProblem
from engine.cycles.floquet import Floquet, floquet, monodromy
from engine.numerics.continuation import BranchPoints, StepControl, concatenated, continue_branches, make_points
from engine.outcome import Outcome, Stability
from engine.progress import driven

FINER_STEPS = (4, 16)  # factors on the number of steps of Floquet's integration, where its error leaves doubt
DOUBTFUL = 1e-6  # error of the multipliers, below which finer steps would not settle an unknown stability
OF_STEPS = 0.5  # share of an error that is left at most where the steps cause it: a quarter of their width leaves 1/256
INACCURATE = 1e-4  # error of the multipliers over the largest, above which finer steps are used in any case
CLUSTER = 0.05  # distance from 1 within which several multipliers err by far more than the trivial one
LIGHT = 1.0  # size of an exponent's real part beyond which a mode changes e-fold in a period: no resonance is sharp
FAR = 0.3  # rad, the farthest that an exponent may move between two points
SHARE = 0.5  # of its distance from 0 and i pi that an exponent may move between two points
SHARPEST = 2e-3  # smallest distance in that rule: sharper resonances than by a damping of 0.03 % are not resolved
ROUNDING = 1e-10  # share of the largest multiplier below which another one is lost in rounding
SHORTEST = 1e-3  # scaled length of a segment that is not divided again
PARTS = 4  # most parts into which a segment is divided at once
ROUNDS = 12
ACCURATE = 1e-7  # tolerance of points between others: short steps need errors that are far shorter
LONGEST = 40  # most points that replace a segment


def judged_points(problem: CycleProblem, points: BranchPoints) -> Floquet:
    """Return the multipliers of points on branches, with finer steps where they are inaccurate or leave doubt.

    Steps that do not lower the error show that too few harmonics cause it: still finer ones would not, either.
    """
    result = floquet(*problem.models(points.z, points.branch), problem.orbits(points.z, points.branch))
    by_steps = np.ones(points.branch.size, dtype=np.bool_)
    for fineness in FINER_STEPS:
        unknown = np.asarray(result.stability == Stability.UNKNOWN, dtype=np.bool_)
        largest = np.abs(result.multipliers).max(axis=-1, initial=1.0)
        doubtful = (unknown | crowded(result)) & (result.trivial_error > DOUBTFUL)
        index = np.flatnonzero((doubtful | (result.trivial_error > INACCURATE * largest)) & by_steps)
        if index.size == 0:
            break
        some = points.select(index)
        finer = floquet(*problem.models(some.z, some.branch), problem.orbits(some.z, some.branch), fineness)
        by_steps[index] = finer.trivial_error < OF_STEPS * result.trivial_error[index]
        for name in ("multipliers", "trivial_error", "stability"):
            getattr(result, name)[index] = getattr(finer, name)
    return result


KnownExponents = dict[tuple[int, bytes], ComplexArray]
"""Signed exponents of points by their branch and the bytes of their unknowns: most points stay from round to round."""


def crowded(judged: Floquet) -> BoolArray:
    """Return where several nontrivial multipliers lie close to 1: (cycles,).

    They come close to being one multiple eigenvalue, and the error of the trivial one tells little about the others'.
    """
    return np.asarray((np.abs(judged.multipliers[:, 1:] - 1.0) < CLUSTER).sum(axis=-1) > 1)


def refined(branch_set: BranchSet, known: KnownExponents) -> tuple[BranchSet, BoolArray]:
    """Return the branches with points inserted where an exponent moves too far from one point to the next.

    Parameters
    ----------
    branch_set : BranchSet
    known : dict
        Of exponents computed before; those computed here are added.

    Returns
    -------
    BranchSet, (branches,)
        The branches, and which of them were cut, because the continuation had left them; they go on from their last
        points.
    """
    left_alone = np.zeros(branch_set.points.branch.size, dtype=np.bool_)
    cut = np.zeros(branch_set.problem.member.size, dtype=np.bool_)
    for _ in range(ROUNDS):
        parts = _parts_needed(branch_set, known)
        segment = np.flatnonzero((parts > 1) & ~left_alone[: parts.size])
        if segment.size == 0:
            break
        branch_set, left_alone, now = divided(branch_set, segment, parts[segment], left_alone)
        cut |= now
    return branch_set, cut


def divided(
    branch_set: BranchSet, segment: IntArray, parts: IntArray, left_alone: BoolArray
) -> tuple[BranchSet, BoolArray, BoolArray]:
    """Follow segments (k,), given by their left points, again with shorter steps and insert the points found.

    Where they lead elsewhere than to the right point, the continuation had jumped to another branch or turned round:
    the points beyond are dropped, and the branch is cut.

    Parameters
    ----------
    branch_set : BranchSet
    segment : (k,)
    parts : (k,)
        Numbers of steps that each is divided into, about.
    left_alone : (points,)
        Left points of segments that could not be followed.

    Returns
    -------
    BranchSet, (points,), (branches,)
        The branches, the left points of segments that could not be followed, and which branches were cut.
    """
    problem, points = branch_set.problem, branch_set.points
    new, owner, ends = _points_between(problem, points.select(segment), points.select(segment + 1), parts)
    left_alone = left_alone.copy()
    left_alone[segment[ends == Ends.NOWHERE]] = True
    rank = np.arange(new.branch.size) - np.searchsorted(owner, owner)
    key = np.concatenate([np.arange(points.branch.size, dtype=np.float64), segment[owner] + (rank + 1.0) / 1e4])
    order = np.argsort(key, kind="stable")
    last, cut = np.full(problem.member.size, np.inf), np.zeros(problem.member.size, dtype=np.bool_)
    for at in segment[ends == Ends.ELSEWHERE][::-1].tolist():
        branch = points.branch[at]
        last[branch], cut[branch] = at + 1.0, True
    every, found = concatenated([points, new]), judged_points(problem, new)
    order = order[key[order] < last[every.branch[order]]]
    judged = Floquet(
        *(
            np.concatenate([getattr(branch_set.floquet, name), getattr(found, name)])[order]
            for name in ("multipliers", "trivial_error", "stability")
        )
    )
    left_alone = np.concatenate([left_alone, np.zeros(new.branch.size, dtype=np.bool_)])[order]
    return replace(branch_set, points=every.select(order), floquet=judged), left_alone, cut


class Ends(Enum):
    """Where a segment leads that is followed again: to its right point, to no end at all, or elsewhere."""

    THERE = "there"
    NOWHERE = "nowhere"
    ELSEWHERE = "elsewhere"


def _points_between(
    problem: CycleProblem, left: BranchPoints, right: BranchPoints, parts: IntArray
) -> tuple[BranchPoints, IntArray, ObjectArray]:
    """Follow branches from left to right points (k,) in smaller steps.

    Returns
    -------
    BranchPoints, (new points,), (k,)
        The points between, sorted by segment and in their order; the segment of each; how each segment ends, of Ends.
    """
    branch, segments = left.branch, np.arange(left.branch.size)
    some = replace(problem.repeated(branch), smallest_share=FINE_SHARE)
    left, right = (make_points(some, segments, end.z, end.tangent) for end in (left, right))
    step = lengths((right.z - left.z) / left.scale) / parts
    found: list[BranchPoints] = []
    ends, count = filled(segments.size, Ends.ELSEWHERE), np.zeros(segments.size, dtype=np.intp)

    def goes_on(new: BranchPoints) -> BoolArray:
        own = new.branch
        before, along = (right.z[own] - new.z) / left.scale[own], new.tangent / left.scale[own]
        ahead = np.einsum("ki,ki->k", before, along) / lengths(along)
        same_way = np.einsum("ki,ki->k", right.tangent[own] / left.scale[own], along) > 0.0
        arrived = same_way & (lengths(before) < 1.5 * step[own]) & (ahead < 0.05 * step[own])
        ends[own[arrived]] = filled(int(arrived.sum()), Ends.THERE)
        count[own] += 1
        found.append(new.select(~arrived))
        return np.asarray(~arrived & (count[own] < LONGEST))

    control = StepControl(first=step, largest=step, tolerance=ACCURATE)
    outcome = driven(continue_branches(some, left.z, left.tangent, control), goes_on)
    lost = np.flatnonzero(np.asarray((outcome != Outcome.CONVERGED) & (ends == Ends.ELSEWHERE), dtype=np.bool_))
    ends[lost] = filled(lost.size, Ends.NOWHERE)
    new = concatenated([left.select(segments[:0]), *found])
    order = np.argsort(new.branch, kind="stable")
    order = order[np.asarray(ends[new.branch[order]] != Ends.NOWHERE, dtype=np.bool_)]
    new = new.select(order)
    return BranchPoints(branch[new.branch], new.z, new.scale, new.tangent), new.branch, ends


def _parts_needed(branch_set: BranchSet, known: KnownExponents) -> IntArray:
    """Return the number of parts that each segment, given by its left point, needs: (points - 1,).

    Exponents are taken from those known, and the others are added to them.
    """
    points = branch_set.points
    parts = np.ones(max(points.branch.size - 1, 0), dtype=np.intp)
    candidate = np.flatnonzero(_candidates(branch_set))
    if candidate.size == 0:
        return parts
    index = np.union1d(candidate, candidate + 1)
    exponents, at = _exponents(branch_set, index, known), np.searchsorted(index, candidate)
    length = lengths((points.z[candidate + 1] - points.z[candidate]) / points.scale[candidate])
    fold = points.tangent[candidate, -1] * points.tangent[candidate + 1, -1] < 0.0
    needed = np.minimum(PARTS, np.ceil(_excess(exponents[at], exponents[at + 1]))).astype(np.intp)
    parts[candidate] = np.where((length > SHORTEST) & ~fold, needed, 0)
    return parts


def _candidates(branch_set: BranchSet) -> BoolArray:
    """Return the segments (points - 1,) on branches where an exponent of a lightly damped mode moves far.

    The unsigned angle of a multiplier is enough to tell: on branches where none moves far, no signs are computed.
    """
    branch = branch_set.points.branch
    start = np.append(True, branch[1:] != branch[:-1])[: branch.size]
    at_equilibrium = start & np.isfinite(branch_set.hopf_wind_speed[branch])
    segments = (branch[1:] == branch[:-1]) & ~at_equilibrium[:-1]
    with np.errstate(divide="ignore", invalid="ignore"):
        exponent = np.log(branch_set.floquet.multipliers[:, 1:])
    angle = np.sort(np.where(np.abs(exponent.real) < LIGHT, np.abs(exponent.imag), 0.0), axis=-1)
    moved = np.nan_to_num(np.abs(np.diff(angle, axis=0)).max(axis=-1, initial=0.0)) * segments
    count = branch_set.problem.member.size
    far = np.zeros(count, dtype=np.bool_)
    np.logical_or.at(far, branch[:-1], moved > FAR / 3.0)
    return np.asarray(segments & far[branch[:-1]])


def _exponents(branch_set: BranchSet, index: IntArray, known: KnownExponents) -> ComplexArray:
    """Return the signed exponents of points (k,), computed where they are not known: (k, 2 m), padded with NaN."""
    points = branch_set.points
    keys = [(int(points.branch[i]), points.z[i].tobytes()) for i in index.tolist()]
    new = np.array([i for i, key in zip(index.tolist(), keys, strict=True) if key not in known], dtype=np.intp)
    if new.size:
        rows = signed_exponents(branch_set, new)
        known.update({key: rows[i] for i, key in zip(index.tolist(), keys, strict=True) if i in rows})
    result = np.full((index.size, branch_set.floquet.multipliers.shape[-1]), np.nan, dtype=np.complex128)
    for row, key in zip(result, keys, strict=True):
        row[: known[key].size] = known[key]
    return result


def signed_exponents(branch_set: BranchSet, index: IntArray) -> dict[int, ComplexArray]:
    """Return the exponents log(multiplier) of points, the trivial one aside, by point.

    Of a complex pair one is kept: that whose angle is the mode's phase over a period (positive Krein signature), so
    that its angle tells on which side of the resonance the mode is.
    """
    problem, points = branch_set.problem, branch_set.points.select(index)
    model, member = problem.models(points.z, points.branch)
    matrices = monodromy(model, member, problem.orbits(points.z, points.branch))
    m = model.mass.shape[-1]
    values, vectors = np.linalg.eig(np.nan_to_num(matrices))
    q, p = vectors[:, :m], vectors[:, m:]
    signature = np.einsum("kin,kij,kjn->kn", q.conj(), model.mass[member], p).imag
    size = np.abs(values)
    kept = ((signature > 0.0) | (values.imag == 0.0)) & (size > ROUNDING * size.max(axis=-1, keepdims=True))
    trivial = np.abs(values - 1.0).argmin(axis=-1)
    kept[np.arange(index.size), trivial] = False
    with np.errstate(divide="ignore"):
        exponents = np.log(values.astype(np.complex128))
    return {int(i): row[keep] for i, row, keep in zip(index, exponents, kept, strict=True)}


def _excess(left: ComplexArray, right: ComplexArray) -> FloatArray:
    """Return by how much complex exponents (k, n), padded with NaN, move farther than they may between points: (k,)."""
    worst = np.zeros(left.shape[0])
    for here, there in ((left, right), (right, left)):
        own = np.asarray((here.imag != 0.0) & (np.abs(here.real) < LIGHT))
        difference = there[:, None] - here[:, :, None]
        turn = np.hypot(difference.real, (difference.imag + np.pi) % (2.0 * np.pi) - np.pi)
        turn = np.where(np.isnan(turn), np.inf, turn)
        nearest = turn.argmin(axis=-1)
        moved = np.take_along_axis(turn, nearest[..., None], axis=-1)[..., 0]
        distance = np.minimum(_distance(here), np.take_along_axis(_distance(there), nearest, axis=-1))
        share = moved / np.clip(SHARE * distance, SHARPEST, FAR)
        worst = np.maximum(worst, np.where(own & np.isfinite(moved), share, 0.0).max(axis=-1, initial=0.0))
    return worst


def _distance(exponent: ComplexArray) -> FloatArray:
    """Return the distance of exponents from those at which a branch folds or its period doubles, 0 and i pi."""
    return np.minimum(np.abs(exponent), np.abs(exponent.real + 1j * (np.abs(exponent.imag) - np.pi)))
