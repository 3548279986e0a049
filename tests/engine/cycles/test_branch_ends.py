"""Where branches end: the limit of the angle of attack, and distances that do not depend on the phase."""

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.cycles.branch_ends import LARGEST_ANGLE, from_start, meets_the_wind
from engine.cycles.branch_set import CycleProblem, points_of
from engine.cycles.harmonic_balance import Orbits, first_harmonic_angle
from engine.models.reduced_model import ReducedModel, take
from engine.numerics.continuation import BranchPoints, make_points
from tests.builders import hybrid, source_line

MEMBERS = 40


def problem_of(model: ReducedModel) -> CycleProblem:
    return CycleProblem(take(model, np.zeros(MEMBERS, dtype=np.intp)), np.arange(MEMBERS), np.ones(MEMBERS))


def points_with(problem: CycleProblem, coefficients: FloatArray) -> BranchPoints:
    count = len(coefficients)
    z = points_of(Orbits(coefficients, np.full(count, 6.0), np.full(count, 5.0)))
    return make_points(problem, np.arange(count), z, np.ones_like(z))


@pytest.mark.parametrize("loops", [1, 2])
def test_the_bound_decides_as_the_angle_along_the_span_does(loops: int) -> None:
    problem = problem_of(hybrid(source_line(2), loops))
    size = np.geomspace(0.05, 5.0, MEMBERS)[:, None, None]
    coefficients = size * np.random.default_rng(3).normal(size=(MEMBERS, 3, 5))
    points = points_with(problem, coefficients)
    steepest = np.abs(problem.model.load.angle).max(axis=1)
    angle = first_harmonic_angle(problem.model, problem.member, problem.orbits(points.z, points.branch))
    expected = angle < LARGEST_ANGLE
    assert 5 < expected.sum() < MEMBERS - 5
    assert meets_the_wind(problem, points, steepest).tolist() == expected.tolist()


def test_a_motion_that_is_no_number_does_not_meet_the_wind() -> None:
    problem = problem_of(hybrid(source_line(2), 1))
    points = points_with(problem, np.full((1, 3, 5), np.nan))
    assert not meets_the_wind(problem, points, np.abs(problem.model.load.angle).max(axis=1)).any()


def test_the_distance_from_the_start_does_not_depend_on_the_phase() -> None:
    problem = problem_of(hybrid(source_line(2), 1))
    coefficients = np.random.default_rng(4).normal(size=(1, 3, 5))
    shifted = coefficients.copy()
    for k, place in ((1, 1), (2, 3)):
        turn = np.exp(1j * k * 0.7)
        wave = (coefficients[..., place] + 1j * coefficients[..., place + 1]) * turn
        shifted[..., place], shifted[..., place + 1] = wave.real, wave.imag
    start, turned = points_with(problem, coefficients), points_with(problem, shifted)
    turned = BranchPoints(start.branch, turned.z, start.scale, start.tangent)
    distance, along = from_start(problem, start, turned, far=1.0)
    assert distance[0] < 1e-12
    assert along.all()


def test_a_distance_is_exact_up_to_the_one_that_counts_as_far_and_larger_beyond() -> None:
    problem = problem_of(hybrid(source_line(2), 1))
    coefficients = np.random.default_rng(5).normal(size=(MEMBERS, 3, 5))
    start = points_with(problem, coefficients)
    moved = points_with(problem, coefficients * np.linspace(0.1, 3.0, MEMBERS)[:, None, None])
    new = BranchPoints(start.branch, moved.z, start.scale, start.tangent)
    exact = from_start(problem, start, new, far=np.inf)[0]
    distance = from_start(problem, start, new, far=1.0)[0]
    assert 5 < (exact > 1.0).sum() < MEMBERS
    assert distance[exact <= 1.0] == pytest.approx(exact[exact <= 1.0])
    assert (distance[exact > 1.0] > 1.0).all()
    assert (distance <= exact * (1.0 + 1e-12)).all()
