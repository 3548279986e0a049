"""Harmonic balance along a branch of cycles: the equations of continuation, and the branches that were followed.

A point z of a branch holds the Fourier coefficients of the cycle, its angular frequency and the wind speed. Theory
section 7.2.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, ObjectArray, lengths, merge_axes
from engine.cycles.floquet import Floquet
from engine.cycles.harmonic_balance import Orbits, basis, linearized
from engine.kernels import compiled
from engine.models.reduced_model import ReducedModel
from engine.numerics.continuation import BranchPoints, NewtonStart, Problem, correct_by_newton
from engine.numerics.newton import NewtonOptions, Solution

SMALLEST_SHARE = 0.2  # of the cycle's size: smallest scale of a coordinate that hardly moves, in general
FINE_SHARE = 1e-3  # the same where torsion must count although it carries little kinetic energy


@dataclass(frozen=True, slots=True)
class CycleProblem(Problem):
    """Harmonic balance with the wind speed as parameter, in the form of `engine.numerics.continuation.Problem`.

    model: leading axis (members,); member: (branches,), model of each branch; reference: (branches,), smallest scale of
    the amplitudes on each branch, measured as the root of sum M_ii |q_i|^2; smallest_share: of the cycle's size, the
    smallest scale of a coordinate.
    """

    model: ReducedModel
    member: IntArray
    reference: FloatArray
    smallest_share: float = field(default=SMALLEST_SHARE, kw_only=True)

    def orbits(self, z: FloatArray, branch: IntArray) -> Orbits:
        """Return the cycles at points (k, n + 1) of branches (k,)."""
        return orbits_of(z, self.model.mass.shape[-1])

    def repeated(self, branch: IntArray) -> "CycleProblem":
        """Return the problem for selected, possibly repeated branches."""
        return replace(self, member=self.member[branch], reference=self.reference[branch])

    def models(self, z: FloatArray, branch: IntArray) -> tuple[ReducedModel, IntArray]:
        """Return a stack of models and, for points (k, n + 1) of branches (k,), the index of each one's model: (k,)."""
        return self.model, self.member[branch]

    def system(self, z: FloatArray, anchor: FloatArray, branch: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return residuals and slopes of the balance and of the phase condition <q - q_anchor, dq_anchor/dtau> = 0."""
        member, m = self.member[branch], self.model.mass.shape[-1]
        phase = self.phase(anchor, branch)
        drift = np.einsum("kx,kx->k", phase, z[:, :-2] - anchor[:, :-2])
        residuals, slopes = linearized(self.model, member, orbits_of(z, m))
        last = np.concatenate([phase, np.zeros((phase.shape[0], 2))], axis=-1)
        return np.concatenate([residuals, drift[:, None]], axis=-1), np.concatenate([slopes, last[:, None]], axis=1)

    def phase(self, anchor: FloatArray, branch: IntArray) -> FloatArray:
        """Return the derivative of the phase condition by the coefficients: (k, m (2 H + 1))."""
        near = orbits_of(anchor, self.model.mass.shape[-1]).coefficients
        weight = self.model.modal_masses[self.member[branch]][..., None]
        return merge_axes(weight * (near @ basis(near.shape[-1] // 2).derivative.T), -2)

    def correct(
        self, start: NewtonStart, branch: IntArray, condition: tuple[FloatArray, FloatArray], options: NewtonOptions
    ) -> tuple[Solution, FloatArray]:
        """Solve the balance with one additional linear condition, by the compiled kernel where it is available."""
        if not compiled.AVAILABLE:
            return correct_by_newton(self, start, branch, condition, options)
        phase = (self.phase(start.anchor, branch), start.anchor)
        return compiled.followed_balances(
            self.model, self.member[branch], phase, condition, (start.guess, start.scale, options)
        )

    def scale(self, z: FloatArray, branch: IntArray) -> FloatArray:
        """Return the scales of points: each coordinate's size or a share of the cycle's, frequency and wind speed."""
        weight = np.sqrt(self.model.modal_masses)[self.member[branch]]
        coefficients = orbits_of(z, weight.shape[-1]).coefficients
        own = weight * lengths(coefficients)
        whole = np.maximum(lengths(own), self.reference[branch])
        size = np.maximum(own, self.smallest_share * whole[:, None]) / weight
        return np.concatenate([np.repeat(size, coefficients.shape[-1], axis=-1), np.abs(z[:, -2:])], axis=-1)


@dataclass(frozen=True, slots=True)
class BranchSet:
    """Branches that were followed together.

    problem: with one entry per branch; points: sorted by branch, in the order in which they were computed; outcome:
    (branches,) of Outcome, CONVERGED where a branch ended or left the range of wind speeds; ended_at_equilibrium:
    (branches,), whether it ended at the equilibrium, in another Hopf point; hopf_wind_speed: (branches,), wind speed of
    the Hopf point where it started, infinite if it did not start at one [m/s]; floquet: of the points.
    """

    problem: CycleProblem
    points: BranchPoints
    outcome: ObjectArray
    ended_at_equilibrium: BoolArray
    hopf_wind_speed: FloatArray
    floquet: Floquet

    @property
    def orbits(self) -> Orbits:
        """The cycle of each point."""
        return self.problem.orbits(self.points.z, self.points.branch)

    @property
    def last(self) -> IntArray:
        """Index of the last point of each branch."""
        return np.searchsorted(self.points.branch, np.arange(self.problem.member.size), side="right") - 1

    @property
    def member(self) -> IntArray:
        """The model of each point."""
        return self.problem.member[self.points.branch]


def orbits_of(z: FloatArray, m: int) -> Orbits:
    """Convert points (k, m (2 H + 1) + 2) to orbits."""
    return Orbits(z[:, :-2].reshape(z.shape[0], m, (z.shape[1] - 2) // m), z[:, -2], z[:, -1])


def points_of(orbits: Orbits) -> FloatArray:
    """Convert orbits to points (k, m (2 H + 1) + 2)."""
    tail = np.stack([orbits.angular_frequency, orbits.wind_speed], axis=-1)
    return np.concatenate([merge_axes(orbits.coefficients, -2), tail], axis=-1)
