"""Branches of limit cycles over a field of the line at a fixed wind speed, through folds. Theory section 7.2.

A point of a branch holds the coefficients of the cycle, its angular frequency and, in place of the wind speed, the
value of the field. The models at any value are built as an analysis builds them.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.cycles.bifurcations import Bifurcations, bifurcations_on, distinct
from engine.cycles.branch_set import BranchSet, CycleProblem
from engine.cycles.branches import follow_both_ways, guessed_cycles, reference_size
from engine.cycles.harmonic_balance import Orbits, linearized, residual
from engine.cycles.known_cycles import KnownCycles, Starts, solve_starts
from engine.cycles.transitions import Kind
from engine.models.critical_wind_speeds import at_wind, state_matrices
from engine.models.reduced_model import ReducedModel, take
from engine.numerics.continuation import NewtonStart, correct_by_newton
from engine.numerics.newton import NewtonOptions, Solution

PARTS = 5  # the scale of the field is this part of its range
DIFFERENCE = 1e-3  # of the range, to either side, for the derivative by the field
HOPF = 1e-10  # of the range, the accuracy of the zero of the growth rate
DOUBLINGS = 12  # of the interval that is searched for a Hopf point

ModelsAt = Callable[[FloatArray, IntArray], tuple[ReducedModel, BoolArray]]
"""Returns the models at values of the field (k,) of members (k,), and which of them exist."""


@dataclass(frozen=True, slots=True)
class FieldProblem(CycleProblem):
    """Harmonic balance at fixed wind speeds with a field of the line as parameter.

    model: leading axis (members,), at some value of the field: phases and sizes are measured in it; models_at: the
    models at any value; wind_speed: (members,) [m/s]; width: length of the range of values.
    """

    models_at: ModelsAt
    wind_speed: FloatArray
    width: float

    def orbits(self, z: FloatArray, branch: IntArray) -> Orbits:
        """Return the cycles at points (k, n + 1) of branches (k,), at their wind speeds."""
        m = self.model.mass.shape[-1]
        coefficients = z[:, :-2].reshape(z.shape[0], m, (z.shape[1] - 2) // m)
        return Orbits(coefficients, z[:, -2], self.wind_speed[self.member[branch]])

    def models(self, z: FloatArray, branch: IntArray) -> tuple[ReducedModel, IntArray]:
        """Return a model for each of the points (k, n + 1) of branches (k,), and their indices."""
        return self.models_at(z[:, -1], self.member[branch])[0], np.arange(branch.size)

    def system(self, z: FloatArray, anchor: FloatArray, branch: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return residuals and slopes of balance and phase condition; NaN where the field's value has no model."""
        count, step = branch.size, DIFFERENCE * self.width
        values = np.concatenate([z[:, -1] + shift for shift in (0.0, step, -step)])
        models, defined = self.models_at(values, np.tile(self.member[branch], 3))
        known = np.asarray(defined.reshape(3, count).all(axis=0))
        orbits, index = self.orbits(z, branch), np.arange(count)
        residuals, slopes = linearized(models, index, orbits)
        above, below = (residual(take(models, shift * count + index), orbits).reshape(count, -1) for shift in (1, 2))
        slopes[:, :, -1] = (above - below) / (2.0 * step)
        phase = self.phase(anchor, branch)
        drift = np.einsum("kx,kx->k", phase, z[:, :-2] - anchor[:, :-2])
        last = np.concatenate([phase, np.zeros((count, 2))], axis=-1)
        residuals = np.concatenate([residuals, drift[:, None]], axis=-1)
        return np.where(known[:, None], residuals, np.nan), np.concatenate([slopes, last[:, None]], axis=1)

    def correct(
        self, start: NewtonStart, branch: IntArray, condition: tuple[FloatArray, FloatArray], options: NewtonOptions
    ) -> tuple[Solution, FloatArray]:
        """Solve with one additional linear condition in numpy; the compiled kernel takes only one model per branch."""
        return correct_by_newton(self, start, branch, condition, options)

    def scale(self, z: FloatArray, branch: IntArray) -> FloatArray:
        """Return the scales of cycles as over the wind speed, and a part of the field's range as its scale."""
        size = CycleProblem.scale(self, z, branch)
        size[:, -1] = self.width / PARTS
        return size


@dataclass(frozen=True, slots=True)
class FieldCycles:
    """Cycles at values of a field and the bifurcations between them.

    member, value: (cycles,), indices; branch: (cycles,), number of the connected family within its member; orbits: of
    the cycles; given: (cycles,), whether the cycle was known before branches were followed; bifurcations: their
    parameter is the field.
    """

    member: IntArray
    value: IntArray
    branch: IntArray
    orbits: Orbits
    given: BoolArray
    bifurcations: Bifurcations


def follow_over_field(problem: FieldProblem, values: FloatArray, known: Starts) -> FieldCycles:
    """Follow the branch of every known cycle over a field in both directions until no new cycle appears.

    Parameters
    ----------
    problem : FieldProblem
        With one entry per member; its branches are replaced.
    values : (values,)
        In rising order.
    known : Starts
        Cycles with their member and, as wind, the index of their value.

    Returns
    -------
    FieldCycles
        Sorted by member, value and branch.
    """
    known_cycles = KnownCycles(problem.model)
    known_cycles.add(known, np.ones(known.member.size, dtype=np.bool_), "branch")
    given, branch_sets, followed = len(known_cycles), [], []
    while (unfollowed := known_cycles.unfollowed()).size:
        member, value = known_cycles.locations(unfollowed)
        start = known_cycles.orbits(unfollowed)
        here = FieldProblem(
            problem.model,
            member,
            reference_size(problem.model, member, start),
            problem.models_at,
            problem.wind_speed,
            problem.width,
        )
        z = np.concatenate([start.coefficients.reshape(member.size, -1), start.angular_frequency[:, None]], axis=-1)
        limits = float(values[0]), float(values[-1])
        branch_set = follow_both_ways(here, np.concatenate([z, values[value][:, None]], axis=-1), limits)
        branch_numbers = _add_cycles_on(known_cycles, branch_set, values)
        known_cycles.link(branch_numbers, np.tile(unfollowed, 2))
        branch_sets.append(branch_set)
        followed.append(branch_numbers)
    branch, families = known_cycles.families()
    member, value = known_cycles.locations(np.arange(len(known_cycles)))
    order = np.lexsort((branch, value, member))
    parts = [
        part
        for branch_set, branch_numbers in zip(branch_sets, followed, strict=True)
        for part in _bifurcations(branch_set, families[branch_numbers])
    ]
    return FieldCycles(
        member[order],
        value[order],
        branch[order],
        known_cycles.orbits(order),
        order < given,
        distinct(parts),
    )


def _add_cycles_on(known_cycles: KnownCycles, branch_set: BranchSet, values: FloatArray) -> IntArray:
    """Solve for the cycles where followed branches cross the values; return the numbers of these branches."""
    problem = branch_set.problem
    followed = known_cycles.add_branches(problem.member, branch_set.hopf_wind_speed)
    branch, value, orbits = guessed_cycles(branch_set, values)
    models, index = problem.models(values[value][:, None], branch)
    starts, good = solve_starts(models, Starts(index, value, orbits))
    branch_numbers = known_cycles.add(Starts(problem.member[branch], value, starts.orbits), good, "branch")
    known_cycles.link(followed[branch[good]], branch_numbers[good])
    return followed


def _bifurcations(branch_set: BranchSet, branch_numbers: IntArray) -> list[Bifurcations]:
    """Locate the bifurcations along followed branches and the Hopf points at which they end."""
    return [*bifurcations_on(branch_set, branch_numbers), _hopf_points(branch_set, branch_numbers)]


def _hopf_points(branch_set: BranchSet, branch_numbers: IntArray) -> Bifurcations:
    """Locate the Hopf points at which branches ended: values where the growth rate of the static state vanishes."""
    problem = branch_set.problem
    assert isinstance(problem, FieldProblem)
    ended = np.flatnonzero(branch_set.ended_at_equilibrium)
    found = [_hopf_point(problem, branch_set, int(i)) for i in ended]
    good = ended[[value is not None for value, _ in found]]
    rates = np.array([rate for value, rate in found if value is not None])
    orbits = branch_set.orbits
    mass = problem.model.modal_masses[problem.member[good]]
    share = mass * (orbits.coefficients[branch_set.last[good], :, 1:] ** 2).sum(axis=-1)
    return Bifurcations(
        member=problem.member[good],
        branch=branch_numbers[good],
        kind=np.array([Kind.HOPF] * good.size, dtype=np.object_),
        parameter=np.array([value for value, _ in found if value is not None]),
        angular_frequency=rates,
        second_frequency=np.full(good.size, np.nan),
        coordinate=share.argmax(axis=-1) if good.size else good,
        uncertainty=np.full(good.size, HOPF * problem.width),
        may_end_stability=np.ones(good.size, dtype=np.bool_),
    )


def _hopf_point(problem: FieldProblem, branch_set: BranchSet, branch: int) -> tuple[float | None, float]:
    """Return the value and the angular frequency at which a branch meets the static state; or None."""
    last = branch_set.points.z[branch_set.last[branch]]
    member = problem.member[[branch]]
    speed = problem.wind_speed[member]

    def pair(value: float) -> complex:
        models, known = problem.models_at(np.array([value]), member)
        if not known[0]:
            return complex(np.nan, np.nan)
        values = np.linalg.eigvals(at_wind(state_matrices(models), speed)[0])
        return complex(values[np.abs(values.imag - last[-2]).argmin()])

    here = pair(last[-1]).real
    for exponent in range(DOUBLINGS):
        for side in (1.0, -1.0):
            there = last[-1] + side * problem.width * 2.0**exponent * 1e-4
            if pair(there).real * here < 0.0:
                value = float(brentq(lambda p: pair(p).real, last[-1], there, xtol=HOPF * problem.width))
                return value, pair(value).imag
    return None, 0.0
