"""Pseudo-arclength continuation on curves that are known exactly."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.numerics.branch_zeros import locate_zeros, project_onto_branches
from engine.numerics.continuation import (
    BranchPoints,
    Problem,
    StepControl,
    continue_branches,
    interpolate,
    make_points,
    tangents,
)
from engine.outcome import Outcome
from engine.progress import driven


@dataclass(frozen=True, slots=True)
class Circles(Problem):
    """Circles x^2 + p^2 = r^2, one a branch; folds at p = +-r."""

    radius: FloatArray

    def system(self, z: FloatArray, anchor: FloatArray, branch: IntArray) -> tuple[FloatArray, FloatArray]:
        del anchor
        residual = (z**2).sum(axis=-1) - self.radius[branch] ** 2
        return residual[:, None], 2.0 * z[:, None, :]

    def scale(self, z: FloatArray, branch: IntArray) -> FloatArray:
        return np.repeat(self.radius[branch][:, None], z.shape[-1], axis=-1)


@dataclass(frozen=True, slots=True)
class Kink(Problem):
    """x = |p| near p = 0 has no solution at all beyond: (x - 1)^2 + max(p, 0) = 0 ends at p = 0."""

    def system(self, z: FloatArray, anchor: FloatArray, branch: IntArray) -> tuple[FloatArray, FloatArray]:
        del anchor, branch
        beyond = np.sqrt(np.where(z[:, 1] > 0.0, np.nan, 1.0))
        return (z[:, :1] - 1.0) * beyond[:, None], np.stack([beyond, np.zeros_like(beyond)], axis=-1)[:, None]

    def scale(self, z: FloatArray, branch: IntArray) -> FloatArray:
        del branch
        return np.ones_like(z)


def followed(
    problem: Problem, start: FloatArray, direction: FloatArray, steps: StepControl | None = None
) -> list[BranchPoints]:
    return list(continue_branches(problem, start, direction, steps))


CIRCLES = Circles(np.array([1.0, 3.0]))
START = np.array([[0.0, 1.0], [3.0, 0.0]])
ALONG = np.array([[1.0, 0.0], [0.0, -1.0]])


def test_points_lie_on_the_curves_and_go_round_all_of_them() -> None:
    points = followed(CIRCLES, START, ALONG, StepControl(points=150))
    for branch, radius in enumerate(CIRCLES.radius):
        z = np.array([p.z[p.branch == branch][0] for p in points])
        assert np.hypot(*z.T) == pytest.approx(radius, rel=1e-7)
        angle = np.unwrap(np.arctan2(z[:, 1], z[:, 0]))
        assert abs(angle[-1] - angle[0]) > 2.0 * np.pi
        assert (np.diff(angle) * np.sign(angle[-1] - angle[0]) > 0.0).all()


def test_caller_ends_a_branch() -> None:
    alive = iter([np.array([False, True]), np.array([False])])
    seen: list[list[int]] = []

    def answer(points: BranchPoints) -> BoolArray | None:
        seen.append(points.branch.tolist())
        return next(alive, None)

    outcome = driven(continue_branches(CIRCLES, START, ALONG), answer)
    assert seen == [[0, 1], [1]]
    assert outcome.tolist() == [Outcome.CONVERGED, Outcome.CONVERGED]


def test_end_of_a_curve_is_an_outcome() -> None:
    points: list[BranchPoints] = []
    outcome = driven(continue_branches(Kink(), np.array([[1.0, -0.3]]), np.array([[0.0, 1.0]])), points.append)
    assert outcome.tolist() == [Outcome.NO_CONVERGENCE]
    assert -1e-3 < points[-1].z[0, 1] <= 0.0
    assert points[-1].z[0, 0] == pytest.approx(1.0)


def test_largest_number_of_points_is_an_outcome() -> None:
    points: list[BranchPoints] = []
    outcome = driven(continue_branches(CIRCLES, START, ALONG, StepControl(points=2)), points.append)
    assert [p.branch.tolist() for p in points] == [[0, 1], [0, 1]]
    assert outcome.tolist() == [Outcome.LIMIT_REACHED, Outcome.LIMIT_REACHED]


def test_folds_are_located() -> None:
    points = followed(
        CIRCLES, np.array([[1.0, 0.0], [3.0, 0.0]]), np.array([[0.0, 1.0], [0.0, 1.0]]), StepControl(points=50)
    )
    for branch, radius in enumerate(CIRCLES.radius):
        own = [p.select(p.branch == branch) for p in points]
        at = next(i for i in range(len(own)) if own[i].tangent[0, -1] * own[i + 1].tangent[0, -1] < 0.0)
        before = own[at].tangent.copy(), own[at + 1].tangent.copy()
        fold = locate_zeros(CIRCLES, own[at], own[at + 1], lambda p, _: p.tangent[:, -1], 1e-12)
        assert (own[at].tangent == before[0]).all()  # the function's values are a part of them
        assert (own[at + 1].tangent == before[1]).all()
        assert fold.points.z[0, 0] == pytest.approx(0.0, abs=1e-4)
        assert fold.points.z[0, 1] == pytest.approx(radius, rel=1e-9)
        assert fold.uncertainty[0] < 1e-9


def test_a_test_function_is_met_inside_a_segment() -> None:
    left = make_points(CIRCLES, np.array([0]), np.array([[1.0, 0.0]]), np.array([[0.0, 1.0]]))
    right = make_points(CIRCLES, np.array([0]), np.array([[0.0, 1.0]]), np.array([[-1.0, 0.0]]))
    found = locate_zeros(CIRCLES, left, right, lambda p, _: p.z[:, 1] - 0.6, 1e-12)
    assert found.points.z[0] == pytest.approx([0.8, 0.6], abs=1e-10)


def test_each_pair_may_have_a_function_of_its_own() -> None:
    left = make_points(CIRCLES, np.array([0, 0]), np.array([[1.0, 0.0]] * 2), np.array([[0.0, 1.0]] * 2))
    right = make_points(CIRCLES, np.array([0, 0]), np.array([[0.0, 1.0]] * 2), np.array([[-1.0, 0.0]] * 2))
    height = np.array([0.6, 0.8])
    found = locate_zeros(CIRCLES, left, right, lambda p, pair: p.z[:, 1] - height[pair], 1e-12)
    assert found.points.z == pytest.approx(np.array([[0.8, 0.6], [0.6, 0.8]]), abs=1e-10)


def test_tangents_and_hermite_interpolation() -> None:
    angle = np.array([0.3, 0.5])
    z = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    branch = np.array([0, 0])
    tangent = tangents(CIRCLES, z, branch, np.array([[-1.0, 0.0], [-1.0, 0.0]]))
    assert tangent == pytest.approx(np.stack([-np.sin(angle), np.cos(angle)], axis=-1))
    ends = [make_points(CIRCLES, branch[i : i + 1], z[i : i + 1], tangent[i : i + 1]) for i in (0, 1)]
    middle = interpolate(ends[0], ends[1], np.array([0.5]))
    assert middle[0] == pytest.approx([np.cos(0.4), np.sin(0.4)], abs=2e-5)


def test_points_are_put_onto_the_branch() -> None:
    near = make_points(CIRCLES, np.array([1]), np.array([[3.1, 0.0]]), np.array([[0.0, 3.0]]))
    assert project_onto_branches(CIRCLES, near).z[0] == pytest.approx([3.0, 0.0], abs=1e-9)


def test_first_and_largest_steps_may_differ_between_branches() -> None:
    steps = StepControl(first=np.array([0.01, 0.1]), largest=np.array([0.02, 0.4]), points=12)
    points = followed(CIRCLES, START, ALONG, steps)
    turned = []
    for branch in (0, 1):
        z = np.concatenate([START[[branch]], *(p.z[p.branch == branch] for p in points)])
        turned.append(np.hypot(*np.diff(z, axis=0).T) / CIRCLES.radius[branch])
    assert turned[0][0] == pytest.approx(0.01, rel=1e-3)
    assert turned[1][0] == pytest.approx(0.1, rel=1e-2)
    assert turned[0].max() == pytest.approx(0.02, rel=1e-3)
    assert turned[1].max() < 0.42


def test_steps_become_as_long_as_the_prediction_allows_wherever_they_begin() -> None:
    def turn(**control: float) -> float:
        steps = replace(StepControl(largest=5.0, points=30), **control)  # type: ignore[arg-type]
        points = followed(Circles(np.ones(1)), START[:1], ALONG[:1], steps)
        z = np.array([p.z[0] for p in points])[-2:]
        return float(abs(np.diff(np.unwrap(np.arctan2(z[:, 1], z[:, 0])))[0]))

    assert turn(first=0.01) == pytest.approx(turn(first=0.5), rel=1e-4)
    # The cubic misses by the fourth power of the step, so the share of the step by the third.
    assert turn(first=0.1, aim=0.0025) == pytest.approx(0.5 * turn(first=0.1, aim=0.02), rel=0.02)
