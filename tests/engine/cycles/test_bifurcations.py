"""Bifurcations of branches of cycles against exact ones, direct integration and what AUTO finds on the same lines."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine.arrays import ComplexArray, FloatArray
from engine.cycles.bifurcations import Bifurcations, bifurcations
from engine.cycles.branches import follow_from_hopf_points
from engine.cycles.harmonic_balance import Orbits, balance, resized, select, states
from engine.cycles.transitions import Kind
from engine.models.aerodynamic_load import force, force_gradient
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel, take
from engine.numerics.continuation import BranchPoints
from engine.spec import Analysis, Model
from tests.builders import Oscillators, hand_made, run, source_line
from tests.engine.motions import LIGHT, analysed


def of_kind(found: Bifurcations, kind: Kind) -> FloatArray:
    return found.parameter[[k is kind for k in found.kind]]


# The ranges in which AUTO finds torus points on the two-loop branches.
@pytest.mark.parametrize("subconductors", [1, 2, 3])
def test_two_loop_branches_with_light_damping_have_torus_points(subconductors: int) -> None:
    _, _, found = analysed(subconductors, LIGHT, 2)
    torus = of_kind(found, Kind.TORUS)
    assert torus.size >= 1
    assert ((torus > 7.0) & (torus < 12.0)).all()
    second_frequency = found.second_frequency[[k is Kind.TORUS for k in found.kind]]
    assert (
        np.abs(second_frequency / found.angular_frequency[[k is Kind.TORUS for k in found.kind]] - 1.0) < 0.02
    ).all()


def test_single_conductor_with_very_light_torsion_has_two_folds() -> None:
    _, _, found = analysed(1, 0.01, 1)
    assert of_kind(found, Kind.FOLD) == pytest.approx([5.31999, 5.32152], abs=2e-4)


def test_branch_joins_both_hopf_points_and_is_number_zero() -> None:
    _, cycles, found = analysed(1, 0.308, 1)
    assert of_kind(found, Kind.HOPF) == pytest.approx([2.400, 10.286], abs=2e-3)
    assert set(found.branch.tolist()) == {0}
    assert set(cycles.branch.tolist()) == {0}


def test_every_bifurcation_is_located_to_a_millionth() -> None:
    cases = [((1, LIGHT, 2), 6), ((2, LIGHT, 2), 4), ((3, LIGHT, 2), 3), ((1, 0.01, 1), 7)]
    for case, number in cases:
        _, _, found = analysed(*case)
        assert found.parameter.size == number
        assert (found.uncertainty <= 1e-6 * found.parameter).all()


def test_a_bifurcation_that_more_harmonics_do_not_locate_has_the_frequency_of_its_branch(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    model, cycles, located = analysed(1, 0.01, 1)

    def fails(_: object, points: BranchPoints) -> BranchPoints:
        none = np.full_like(points.z, np.nan)
        return BranchPoints(points.branch, none, points.scale, points.tangent)

    monkeypatch.setattr("engine.cycles.bifurcations.project_onto_branches", fails)
    crossings = critical_wind_speeds(model, 30.0)
    found = bifurcations(cycles.branch_sets, cycles.followed, model, crossings)
    assert {*found.kind} == {*located.kind}
    for i, kind in enumerate(found.kind):
        same_branch = np.flatnonzero(located.branch == found.branch[i]).tolist()
        alike = [j for j in same_branch if located.kind[j] is kind]
        near = min(alike, key=lambda j: abs(located.parameter[j] - found.parameter[i]))
        assert abs(located.parameter[near] - found.parameter[i]) <= found.uncertainty[i]
        assert found.angular_frequency[i] == pytest.approx(located.angular_frequency[near], rel=1e-2)


def multipliers_by_integration(model: ReducedModel, orbit: Orbits) -> ComplexArray:
    """Integrate the nonlinear equations with their variation over one period."""
    speed, period = float(orbit.wind_speed[0]), 2.0 * np.pi / float(orbit.angular_frequency[0])
    inverse = np.linalg.inv(model.mass)

    def rate(_: float, y: FloatArray) -> FloatArray:
        q, v, variation = y[:3], y[3:6], y[6:].reshape(6, 6)
        state = np.concatenate([q, v / speed])[None]
        gradient = force_gradient(model.load, state)[0]
        acceleration = inverse @ (speed**2 * force(model.load, state)[0] - model.stiffness @ q - model.damping @ v)
        by_q = inverse @ (speed**2 * gradient[:, :3] - model.stiffness)
        by_v = inverse @ (speed * gradient[:, 3:] - model.damping)
        slope = np.concatenate([variation[3:], by_q @ variation[:3] + by_v @ variation[3:]])
        return np.concatenate([v, acceleration, slope.ravel()])

    start = states(orbit, np.zeros(1))[0, 0] * np.repeat([1.0, speed], 3)
    run = solve_ivp(
        rate, (0.0, period), np.concatenate([start, np.eye(6).ravel()]), method="DOP853", rtol=1e-11, atol=1e-13
    )
    return np.asarray(np.linalg.eigvals(run.y[6:, -1].reshape(6, 6)), dtype=np.complex128)


def test_torus_point_has_a_pair_on_the_circle_by_direct_integration() -> None:
    model, cycles, found = analysed(1, LIGHT, 2)
    torus = int(np.flatnonzero([k is Kind.TORUS for k in found.kind])[0])
    branch_set = next(t for t in cycles.branch_sets if t.points.branch.size)
    near = int(
        np.abs(branch_set.orbits.wind_speed - found.parameter[torus]).argmin()
        if branch_set.problem.member.size == 1
        else np.hypot(
            branch_set.orbits.wind_speed / found.parameter[torus] - 1.0,
            100.0 * (branch_set.orbits.angular_frequency / found.angular_frequency[torus] - 1.0),
        ).argmin()
    )
    start = select(branch_set.orbits, np.array([near]))
    guess = Orbits(start.coefficients, start.angular_frequency, found.parameter[[torus]])
    orbit, solution = balance(model, np.zeros(1, dtype=np.intp), resized(guess, 9))
    assert solution.converged.all()
    values = multipliers_by_integration(take(model, 0), orbit)
    others = values[np.abs(values - 1.0) > 1e-6]
    pair = others[np.abs(np.abs(others) - 1.0).argmin()]
    assert abs(pair) == pytest.approx(1.0, abs=1e-6)
    beat = abs(found.second_frequency[torus] - found.angular_frequency[torus]) / found.angular_frequency[torus]
    assert abs(np.angle(pair)) / (2.0 * np.pi) == pytest.approx(beat, abs=1e-5)


def test_torus_point_of_two_oscillators_is_exact() -> None:
    # q_1'' + w_1^2 q_1 = mu (2 U - 1 - U q_1^2 - q_1'^2 / (U w_1^2)) q_1' runs on a circle of radius 1 at U = 1. Beside
    # it q_2'' + w_2^2 q_2 = nu (3 U - 2 - U q_1^2 - q_1'^2 / (U w_1^2)) q_2' is undamped just there.
    mu, nu, first, second_frequency = 0.05, 0.02, 1.0, 1.37
    terms: dict[tuple[int, tuple[int, ...]], float] = {
        (0, (2,)): 2.0 * mu,
        (0, (0, 0, 2)): -mu,
        (0, (2, 2, 2)): -mu / first**2,
        (1, (3,)): 3.0 * nu,
        (1, (0, 0, 3)): -nu,
        (1, (2, 2, 3)): -nu / first**2,
    }
    model = hand_made(Oscillators(np.eye(2), np.diag([mu, 2.0 * nu]), np.diag([first**2, second_frequency**2]), terms))
    crossings = critical_wind_speeds(model, 5.0)
    assert crossings.wind_speed == pytest.approx([0.5, 2.0 / 3.0])
    branch_set = follow_from_hopf_points(model, crossings, np.array([0]), 5, np.array([1.1]))
    found = bifurcations((branch_set,), np.zeros(1, dtype=np.intp), model, crossings)
    torus = [i for i, kind in enumerate(found.kind) if kind is Kind.TORUS]
    assert found.parameter[torus] == pytest.approx([1.0], abs=1e-6)
    assert found.angular_frequency[torus] == pytest.approx([first], abs=1e-6)
    assert found.second_frequency[torus] == pytest.approx([second_frequency], abs=1e-6)
    assert (found.uncertainty[torus] < 1e-6).all()


@pytest.mark.parametrize("winds", [(6.0, 10.0), (6.3, 10.0)])
def test_a_branch_point_is_located_although_the_trivial_multiplier_meets_the_critical_one(
    winds: tuple[float, ...],
) -> None:
    line = source_line(1, torsional_ratio=0.01)
    rows = run(line, Analysis(loops=(2,), models=(Model.HYBRID,), wind_speeds=winds)).bifurcations
    found = [row for row in rows if row.type == "branch_point"]
    assert [row.wind_speed_m_per_s for row in found] == pytest.approx([9.3199], abs=2e-4)
    assert found[0].uncertainty_m_per_s < 6e-3
