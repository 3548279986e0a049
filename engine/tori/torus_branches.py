"""Branches of quasi-periodic motions over the wind speed, from torus points of cycles on. Theory section 7.3."""

from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, ObjectArray
from engine.cycles.bifurcations import Bifurcations
from engine.cycles.branch_set import BranchSet, orbits_of
from engine.cycles.branches import guessed_points
from engine.cycles.floquet import floquet
from engine.cycles.harmonic_balance import Orbits, balance, resized, select
from engine.cycles.transitions import Kind
from engine.models.reduced_model import ReducedModel, of_each_member, take
from engine.numerics.continuation import BranchPoints, Problem, StepControl, continue_branches, make_points
from engine.numerics.newton import NewtonOptions
from engine.progress import driven
from engine.tori.spectrum import base_lines, line_strengths
from engine.tori.two_frequency_balance import (
    Order,
    Tori,
    harmonic_lattice,
    linearized,
    phase_rows,
    phasors,
    points_of,
    tori_of,
)

STEPS = StepControl(first=0.05, points=100)
FIRST_STEPS = StepControl(first=0.01, points=2)
SMALLEST_SHARE = 0.2  # of the torus' size: smallest scale of a coordinate that hardly moves
LOCATED = 1e-4  # largest relative uncertainty of a torus point from which a branch is followed
NEAR = NewtonOptions(tolerance=1e-3)  # convergence is quadratic
BESIDE = 1e-3  # relative distance in wind speed from a torus point at which its cycle's stability is examined
SAME_FREQUENCY = 1e-3  # relative difference of frequency up to which a point of a branch is the torus point


@dataclass(frozen=True, slots=True)
class TorusProblem(Problem):
    """Two-frequency balance with the wind speed as parameter, in the form of `engine.numerics.continuation.Problem`.

    model: leading axis (members,); member: (branches,).
    """

    model: ReducedModel
    member: IntArray
    order: Order

    def system(self, z: FloatArray, anchor: FloatArray, branch: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return residuals and slopes of the balance and both phase conditions <q - q_anchor, dq_anchor/dtheta> = 0."""
        member = self.member[branch]
        rows = phase_rows(self.read(anchor), self._weight(branch))
        residual, slopes = linearized(take(self.model, member), self.read(z))
        drift = np.einsum("kpx,kx->kp", rows, (z - anchor)[:, :-1])
        rows = np.concatenate([rows, np.zeros((*rows.shape[:2], 1))], axis=-1)
        return np.concatenate([residual, drift], axis=-1), np.concatenate([slopes, rows], axis=1)

    def scale(self, z: FloatArray, branch: IntArray) -> FloatArray:
        """Return the scales of points: each coordinate's size or a share of the torus', frequencies and wind speed."""
        weight = np.sqrt(self._weight(branch))
        coefficients = self.read(z).coefficients
        own = weight * np.linalg.norm(coefficients, axis=-1)
        size = np.maximum(own, SMALLEST_SHARE * np.linalg.norm(own, axis=-1, keepdims=True)) / weight
        return np.concatenate([np.repeat(size, coefficients.shape[-1], axis=-1), np.abs(z[:, -3:])], axis=-1)

    def read(self, z: FloatArray) -> Tori:
        """Convert points (k, N + 3) to tori."""
        return tori_of(z, self.model.mass.shape[-1], self.order)

    def _weight(self, branch: IntArray) -> FloatArray:
        return self.model.modal_masses[self.member[branch]]


@dataclass(frozen=True, slots=True)
class TorusStarts:
    """Torus points, as tori without modulation, from which branches are followed.

    member, family: (k,), index of the model and number of the family of cycles; tori: of these k points; direction:
    (k, N + 3), the disturbance that starts to grow there, of unit norm weighted with the mass.
    """

    member: IntArray
    family: IntArray
    tori: Tori
    direction: FloatArray

    def select(self, index: IntArray) -> "TorusStarts":
        """Select some of them."""
        return TorusStarts(self.member[index], self.family[index], self.tori.select(index), self.direction[index])


def starts_at_torus_points(
    model: ReducedModel, branch_sets: Sequence[BranchSet], found: Bifurcations, selected: BoolArray, order: Order
) -> TorusStarts:
    """Return the cycles at torus points with the critical disturbance of the second frequency.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    branch_sets : sequence of BranchSet
        Of the branches on which the torus points lie.
    found : Bifurcations
    selected : (bifurcations,)
        Which bifurcations are used; others than torus points are ignored.
    order : Order

    Returns
    -------
    TorusStarts
        Without those whose cycle could not be found again.
    """
    located = selected & np.isfinite(found.second_frequency) & (found.uncertainty < LOCATED * found.parameter)
    points = np.flatnonzero(located & np.array([kind is Kind.TORUS for kind in found.kind], dtype=np.bool_))
    guesses = [_guessed_cycle(branch_sets, found, int(i)) for i in points]
    points = points[[guess is not None for guess in guesses]]
    m = model.mass.shape[-1]
    guessed = [guess for guess in guesses if guess is not None]
    start = Orbits(
        np.concatenate([resized(g, order[0]).coefficients for g in guessed] or [np.zeros((0, m, 2 * order[0] + 1))]),
        np.array([g.angular_frequency[0] for g in guessed]),
        found.parameter[points],
    )
    member = found.member[points]
    orbits, solution = balance(model, member, start, NEAR)
    good = np.flatnonzero(solution.converged)
    base, second_frequency = orbits.angular_frequency[good], found.second_frequency[points[good]]
    beat = np.abs(second_frequency - np.round(second_frequency / base) * base)
    tori = tori_from_cycles(select(orbits, good), beat, order)
    return TorusStarts(
        member[good], found.branch[points[good]], tori, critical_directions(take(model, member[good]), tori)
    )


def tori_from_cycles(orbits: Orbits, beat: FloatArray, order: Order) -> Tori:
    """Convert cycles to tori without modulation, with W = beat (cycles,) [rad/s]."""
    pairs = harmonic_lattice(order).pairs
    coefficients = np.zeros((*orbits.coefficients.shape[:2], 2 * len(pairs) - 1))
    own = resized(orbits, order[0]).coefficients
    coefficients[..., 0] = own[..., 0]
    place = np.flatnonzero((pairs[:, 1] == 0) & (pairs[:, 0] > 0))
    coefficients[..., 2 * place - 1], coefficients[..., 2 * place] = own[..., 1::2], own[..., 2::2]
    return Tori(coefficients, np.stack([orbits.angular_frequency, beat], axis=-1), orbits.wind_speed, order)


def critical_directions(model: ReducedModel, tori: Tori) -> FloatArray:
    """Return the harmonics of order one in W that change the balance of unmodulated tori least: (tori, N + 3).

    The model has the leading axis (tori,).
    """
    count, m, size = tori.coefficients.shape
    first = np.repeat(np.abs(harmonic_lattice(tori.order).pairs[:, 1]) == 1, 2)[1:]
    index = np.flatnonzero(np.tile(first, m))
    scale = np.repeat(np.sqrt(model.modal_masses), size, axis=-1)[:, index]
    matrix = linearized(model, tori)[1][:, index[:, None], index] / scale[:, None] / scale[:, :, None]
    direction = np.zeros((count, m * size + 3))
    # Eigenvectors of A^T A cost a fifth of the singular vectors of A and are accurate enough for a start.
    direction[:, index] = np.linalg.eigh(matrix.swapaxes(-1, -2) @ matrix)[1][..., 0] / scale
    return direction


def starting_stable_tori(model: ReducedModel, starts: TorusStarts) -> IntArray:
    """Return the indices of the torus points from which stable tori start (supercritical ones).

    They lie on the side where the cycle is unstable, provided that the cycle is stable on the other side.
    """
    problem = TorusProblem(model, starts.member, starts.tori.order)
    steps = _continuation(problem, starts, FIRST_STEPS)
    speed, side = np.full((2, starts.member.size), np.nan)
    for new in steps:
        # Relative to the first point of the branch, because truncation of the harmonics shifts the torus point itself.
        side[new.branch] = np.sign(new.z[:, -1] - speed[new.branch])
        speed[new.branch] = new.z[:, -1]
    guessed = np.flatnonzero(np.isfinite(side))
    both = np.tile(guessed, 2)
    away = np.concatenate([side[guessed], -side[guessed]])
    cycles = select(cycles_from_tori(starts.tori), both)
    beside = replace(cycles, wind_speed=cycles.wind_speed * (1.0 + BESIDE * away))
    orbits, solution = balance(model, starts.member[both], beside, NEAR)
    multipliers = floquet(model, starts.member[both], orbits).multipliers[:, 1:]
    growing = np.where(solution.converged, (np.abs(multipliers) > 1.0).sum(axis=-1), -1).reshape(2, -1)
    return np.asarray(guessed[(growing[0] == 2) & (growing[1] == 0)])


def _continuation(
    problem: TorusProblem, starts: TorusStarts, steps: StepControl
) -> Generator[BranchPoints, BoolArray | None, ObjectArray]:
    """Continue from the torus points in their critical directions, with steps relative to the cycles' sizes."""
    start = points_of(starts.tori)
    size = np.linalg.norm(start / problem.scale(start, np.arange(starts.member.size)), axis=-1, keepdims=True)
    return continue_branches(problem, start, starts.direction * size, steps)


def cycles_from_tori(tori: Tori) -> Orbits:
    """Return the cycles that the harmonics of w alone make."""
    pairs = harmonic_lattice(tori.order).pairs
    place = np.flatnonzero((pairs[:, 1] == 0) & (pairs[:, 0] > 0))
    both = np.stack([2 * place - 1, 2 * place], axis=-1).ravel()
    kept = tori.coefficients[..., np.concatenate([[0], both])]
    return Orbits(kept, tori.angular_frequency[:, 0], tori.wind_speed)


def follow_tori(model: ReducedModel, starts: TorusStarts, winds: FloatArray) -> BranchPoints:
    """Follow branches of tori within the range of each one's wind speeds, until they end at another cycle.

    winds: (winds,) or (members, winds), in rising order [m/s].

    Returns
    -------
    BranchPoints
        Sorted by branch, in the order in which they were computed, without the starting points.
    """
    problem, own = TorusProblem(model, starts.member, starts.tori.order), of_each_member(model, winds)[starts.member]
    last = make_points(problem, np.arange(starts.member.size), points_of(starts.tori), starts.direction)
    found, at_start = [last.select(np.zeros(0, dtype=np.intp))], np.ones(starts.member.size, dtype=np.bool_)

    def goes_on(new: BranchPoints) -> BoolArray:
        ended = _passed_cycle(problem, last.select(new.branch), new) & ~at_start[new.branch]
        rising = new.tangent[:, -1] > 0.0
        found.append(new.select(~ended))
        at_start[new.branch] = False
        last.overwrite(new)
        lowest, highest = own[new.branch, 0], own[new.branch, -1]
        return np.asarray(~ended & np.where(rising, new.z[:, -1] < highest, new.z[:, -1] > lowest))

    driven(_continuation(problem, starts, STEPS), goes_on)
    every = BranchPoints(
        *(np.concatenate([getattr(p, name) for p in found]) for name in ("branch", "z", "scale", "tangent"))
    )
    return every.select(np.argsort(every.branch, kind="stable"))


def _guessed_cycle(branch_sets: Sequence[BranchSet], found: Bifurcations, point: int) -> Orbits | None:
    """Interpolate the cycle at a torus point from the branches of its model; None if none of them passes it."""
    nearest, best = SAME_FREQUENCY, None
    for branch_set in branch_sets:
        here = np.flatnonzero(branch_set.member == found.member[point])
        if here.size < 2:
            continue
        own = branch_set.points.select(here)
        orbits = orbits_of(guessed_points(own, found.parameter[[point]])[2], branch_set.problem.model.mass.shape[-1])
        gap = np.abs(orbits.angular_frequency / found.angular_frequency[point] - 1.0)
        if gap.min(initial=np.inf) < nearest:
            nearest, best = gap.min(), select(orbits, np.array([gap.argmin()]))
    return best


def _passed_cycle(problem: TorusProblem, before: BranchPoints, new: BranchPoints) -> BoolArray:
    """Return which branches passed through a cycle, where one of the two base lines changes its sign."""
    old, at_start = problem.read(before.z), problem.read(new.z)
    member = problem.member[new.branch]
    mass = problem.model.modal_masses[member]
    ended = np.zeros(new.branch.size, dtype=np.bool_)
    for i, strengths in enumerate(line_strengths(problem.model, member, old)):
        lines = base_lines(strengths, harmonic_lattice(problem.order).pairs)
        left, right = (phasors(tori.coefficients[i])[:, lines] for tori in (old, at_start))
        ended[i] = (mass[i] @ (left.conj() * right).real).min() < 0.0
    return ended
