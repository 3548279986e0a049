"""Newton's method on stacks: what it solves, and that failure is a value."""

import numpy as np
import pytest

from engine.arrays import FloatArray, IntArray
from engine.numerics.newton import NewtonOptions, System, downhill, newton
from engine.outcome import Outcome


def quadratics(targets: FloatArray) -> System:
    """Return the systems x_0^2 = a, x_1 - x_0 = 1."""

    def system(x: FloatArray, active: IntArray) -> tuple[FloatArray, FloatArray]:
        a = targets[active]
        rows = np.stack([x[:, 0] ** 2 - a, x[:, 1] - x[:, 0] - 1.0], axis=-1)
        zero, one = np.zeros_like(a), np.ones_like(a)
        return rows, np.stack([np.stack([2.0 * x[:, 0], zero], -1), np.stack([-one, one], -1)], axis=-2)

    return system


def test_every_member_of_a_stack_is_solved_on_its_own() -> None:
    targets = np.array([4.0, 9.0, 1e4])
    found = newton(quadratics(targets), np.tile([1.0, 1.0], (3, 1)), np.ones((3, 2)), NewtonOptions(largest_step=1e9))
    assert found.converged.all()
    assert found.x == pytest.approx(np.stack([np.sqrt(targets), np.sqrt(targets) + 1.0], axis=-1), rel=1e-12)
    assert found.iterations[0] < found.iterations[2]
    assert found.residual.tolist() == [[1.0 - target, -1.0] for target in targets]  # at the start


def test_no_solution_is_an_outcome_and_leaves_the_others_alone() -> None:
    found = newton(quadratics(np.array([4.0, -1.0])), np.ones((2, 2)), np.ones((2, 2)))
    assert found.outcome.tolist() == [Outcome.CONVERGED, Outcome.NO_CONVERGENCE]
    assert found.x[0] == pytest.approx([2.0, 3.0], rel=1e-12)


def test_start_that_is_not_a_number_does_not_converge() -> None:
    start = np.array([[np.nan, 1.0], [1.0, 1.0], [np.inf, 0.0]])
    found = newton(quadratics(np.array([4.0, 4.0, 4.0])), start, np.ones((3, 2)))
    assert found.converged.tolist() == [False, True, False]
    assert found.x[1] == pytest.approx([2.0, 3.0], rel=1e-12)


def test_singular_jacobian_fails_one_member_only() -> None:
    # At x_0 = 0 the first row of the Jacobian vanishes.
    found = newton(quadratics(np.array([4.0, 4.0])), np.array([[0.0, 1.0], [1.0, 1.0]]), np.ones((2, 2)))
    assert found.converged.tolist() == [False, True]
    assert found.x[1] == pytest.approx([2.0, 3.0], rel=1e-12)


def test_steps_are_no_longer_than_allowed() -> None:
    # From 1 to 100 in steps of the root mean square size 0.5: both unknowns move alike, so 0.5 each.
    found = newton(quadratics(np.array([1e4])), np.array([[99.0, 100.0]]), np.ones((1, 2)))
    assert found.converged.all()
    far = newton(quadratics(np.array([1e4])), np.array([[1.0, 2.0]]), np.ones((1, 2)), NewtonOptions(iterations=12))
    assert not far.converged.any()
    assert far.x[0, 0] == pytest.approx(1.0 + 12 * 0.5, rel=1e-12)


def test_systems_that_are_not_finite_do_not_converge() -> None:
    def system(x: FloatArray, _: IntArray) -> tuple[FloatArray, FloatArray]:
        return np.full_like(x, np.nan), np.tile(np.eye(2), (x.shape[0], 1, 1))

    assert not newton(system, np.zeros((3, 2)), np.ones((3, 2))).converged.any()


def test_empty_stack_is_solved() -> None:
    found = newton(quadratics(np.zeros(0)), np.zeros((0, 2)), np.ones((0, 2)))
    assert found.x.shape == (0, 2)
    assert found.converged.shape == (0,)


def test_downhill_tangents_have_the_absolute_eigenvalues_whatever_stands_beside_them() -> None:
    convex, saddle = np.array([[2.0, 1.0], [1.0, 2.0]]), np.array([[1.0, 2.0], [2.0, 1.0]])  # eigenvalues 1, 3; -1, 3
    assert downhill(np.stack([convex, saddle])) == pytest.approx(np.stack([convex, convex]), rel=1e-14)
    assert downhill(convex[None]).tolist() == [convex.tolist()]


def test_a_start_that_is_farther_than_the_reach_is_given_up_after_its_first_step() -> None:
    targets, start = np.array([4.0, 4.0, 4.0]), np.tile([3.0, 4.0], (3, 1))
    first = 5.0 / 6.0  # of both unknowns, from x_0 = 3 to (9 + 4) / 6
    options = NewtonOptions(largest_step=1.0, reach=np.array([0.99 * first, 1.01 * first, np.inf]))
    found = newton(quadratics(targets), start, np.ones((3, 2)), options)
    assert found.converged.tolist() == [False, True, True]
    assert found.iterations[0] == 1
    assert found.step[0] == pytest.approx(first)
