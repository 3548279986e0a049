"""Sharp resonances that the continuation steps over, against what AUTO finds on the same lines."""

import numpy as np
import pytest

from engine.cycles.branches import follow_from_hopf_points
from engine.cycles.floquet import floquet
from engine.cycles.refinement import FAR, LIGHT, judged_points, signed_exponents
from engine.cycles.transitions import Kind
from engine.models.critical_wind_speeds import critical_wind_speeds
from tests.builders import hybrid, source_line
from tests.engine.motions import bifurcations_between, resonant_line

WINDS = np.linspace(1.0, 14.0, 5)


def test_the_folds_of_a_torsional_resonance_are_found() -> None:
    _, found = bifurcations_between(resonant_line(), 2, WINDS)
    of_branch = found.branch == 0
    at = {kind: found.parameter[of_branch & np.array([k is kind for k in found.kind])] for kind in Kind}
    assert at[Kind.FOLD] == pytest.approx([7.699, 7.716], abs=2e-3)
    assert at[Kind.TORUS][-2:] == pytest.approx([7.916, 10.510], abs=1e-3)
    assert at[Kind.UNRESOLVED].size == 0
    second = found.second_frequency[of_branch & np.array([k is Kind.TORUS for k in found.kind])]
    assert (np.abs(second / found.angular_frequency[of_branch][0] - 1.0) > 1e-4).all()


def test_a_torus_point_beside_another_in_the_same_step_is_found() -> None:
    _, found = bifurcations_between(source_line(1, torsional_ratio=0.01), 2, WINDS)
    torus = found.parameter[[kind is Kind.TORUS for kind in found.kind]]
    assert np.sort(torus) == pytest.approx([7.6919, 7.9830, 8.0869, 8.7815, 8.7906, 10.0424], abs=2e-3)


def test_no_exponent_moves_far_between_two_points() -> None:
    model = hybrid(resonant_line(), 2)
    crossings = critical_wind_speeds(model, 14.0)
    branch_set = follow_from_hopf_points(model, crossings, np.array([0]), 7, WINDS)
    exponents = signed_exponents(branch_set, np.arange(1, branch_set.points.branch.size))
    for i in range(1, branch_set.points.branch.size - 1):
        here, there = (row[np.abs(row.real) < LIGHT] for row in (exponents[i], exponents[i + 1]))
        gaps = np.abs(np.exp(here)[:, None] - np.exp(there)[None]).min(axis=1)
        assert gaps.max() < 1.1 * FAR


def test_a_strongly_damped_line_keeps_the_points_of_the_continuation() -> None:
    model = hybrid(source_line(2), 1)
    crossings = critical_wind_speeds(model, 14.0)
    branch_set = follow_from_hopf_points(model, crossings, np.array([0]), 5, np.array([4.0, 6.0]))
    assert branch_set.points.branch.size < 25


def test_finer_steps_are_taken_only_where_they_cause_the_error() -> None:
    model = hybrid(resonant_line(), 2)
    crossings = critical_wind_speeds(model, 14.0)
    branch_set = follow_from_hopf_points(model, crossings, np.array([0]), 3, WINDS)
    problem, points = branch_set.problem, branch_set.points
    judged = judged_points(problem, points)
    where = (problem.model, branch_set.member, branch_set.orbits)
    once, finer, finest = (floquet(*where, fineness) for fineness in (1, 4, 16))
    by_harmonics = (finer.trivial_error > 1e-6) & (finer.trivial_error > 0.9 * once.trivial_error)
    assert by_harmonics.sum() > 5
    assert (judged.trivial_error[by_harmonics] != finest.trivial_error[by_harmonics]).all()
    change = np.abs(judged.trivial_error - finest.trivial_error)[by_harmonics]
    assert (change < 1e-2 * finest.trivial_error[by_harmonics]).all()
