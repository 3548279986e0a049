"""The compiled kernels against the numpy forms that they stand for, and those forms where nothing was compiled."""

import shutil
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray, IntArray
from engine.checks.direct_starts import spread_starts
from engine.checks.settled_motion import SettledMotions, integrate_until_settled
from engine.cycles.first_harmonic import explicit_cycles
from engine.cycles.floquet import floquet, monodromy
from engine.cycles.harmonic_balance import Orbits, balance, linearized
from engine.cycles.search import Cycles, find_cycles
from engine.cycles.starts import energy_starts
from engine.kernels import compiled
from engine.mechanics.coefficients import fit_measured
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.discretization import nodal_motion
from engine.models.reduced_model import ReducedModel, take
from engine.models.relative_wind import largest_reach
from engine.numerics.newton import NewtonOptions, Solution
from engine.outcome import Outcome
from engine.spec import AerodynamicModel, Analysis, Closure, MeasuredCoefficients
from tests.builders import discretized, hybrid, source_line
from tests.engine.motions import COPIES, MODELS, TABLE, perturbed, random_orbits, relative_line, short


@pytest.mark.parametrize("model", list(AerodynamicModel))
@pytest.mark.parametrize("size", [0.3, 3.0])  # the larger motions outrun the wind
def test_the_reach_of_motions_is_that_of_the_numpy_form(model: AerodynamicModel, size: float) -> None:
    lines, rng = [relative_line(n) for n in (4, 2)], np.random.default_rng(5)
    shapes = np.concatenate([hybrid(line, 2).shapes for line in lines])
    motion = nodal_motion(discretized(*lines), np.arange(2), shapes, model)
    state = size * rng.normal(size=(COPIES, 7, 6)) * np.array([1.0, 1.0, 1.0, 0.5, 0.5, 2.0])
    member = np.arange(COPIES) % 2
    found = compiled.largest_reaches(motion, member, state)
    assert found == pytest.approx(largest_reach(motion, member, state), rel=1e-12)


def test_a_machine_with_a_compiler_has_them() -> None:
    assert compiled.AVAILABLE or shutil.which("cc") is None


@pytest.fixture
def both(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    assert compiled.AVAILABLE
    return monkeypatch


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("harmonics", [1, 5, 12])
def test_a_newton_step_is_that_of_the_numpy_form(name: str, harmonics: int, both: pytest.MonkeyPatch) -> None:
    model = perturbed(MODELS[name]())
    start = random_orbits(model, harmonics, COPIES)
    member = np.arange(COPIES) % 4

    def stepped() -> tuple[Orbits, Solution]:
        return balance(model, member, start, NewtonOptions(iterations=1))

    found, how = stepped()
    both.setattr(compiled, "AVAILABLE", False)
    expected, expected_how = stepped()
    size = np.abs(expected.coefficients).max()
    assert found.coefficients == pytest.approx(expected.coefficients, rel=1e-9, abs=1e-9 * size)
    assert found.angular_frequency == pytest.approx(expected.angular_frequency, rel=1e-9)
    assert how.step == pytest.approx(expected_how.step, rel=1e-9)
    drift = expected_how.residual[:, -1]  # the phase condition, which the kernel leaves out
    assert drift.tolist() == [0.0] * COPIES
    force = np.abs(expected_how.residual).max()
    assert how.residual == pytest.approx(expected_how.residual[:, :-1], rel=1e-9, abs=1e-11 * force)
    assert how.iterations.tolist() == expected_how.iterations.tolist() == [1] * COPIES


@pytest.mark.parametrize("name", MODELS)
def test_slopes_are_those_of_the_numpy_form(name: str, both: pytest.MonkeyPatch) -> None:
    model = perturbed(MODELS[name]())
    orbits = random_orbits(model, 5, COPIES)
    member = np.arange(COPIES) % 4
    found = linearized(model, member, orbits)
    both.setattr(compiled, "AVAILABLE", False)
    expected = linearized(model, member, orbits)
    for mine, theirs in zip(found, expected, strict=True):
        size = np.abs(theirs).max(axis=(0, 1))
        assert (np.abs(mine - theirs) <= 1e-9 * np.abs(theirs) + 1e-11 * size).all()


@pytest.mark.parametrize("name", MODELS)
def test_a_step_along_a_branch_solves_the_slopes_and_both_conditions(name: str) -> None:
    model, rng = perturbed(MODELS[name]()), np.random.default_rng(3)
    orbits, member = random_orbits(model, 3, COPIES), np.arange(COPIES) % 4
    tail = [orbits.angular_frequency[:, None], orbits.wind_speed[:, None]]
    start = np.concatenate([orbits.coefficients.reshape(COPIES, -1), *tail], axis=-1)
    anchor, row, target = 1.1 * start, rng.normal(size=start.shape), rng.normal(size=COPIES)
    phase = rng.normal(size=start[:, :-2].shape)
    residual, slopes = linearized(model, member, orbits)
    drift = [((start - anchor)[:, :-2] * phase).sum(axis=-1), (row * start).sum(axis=-1) - target]
    right = np.concatenate([residual, np.stack(drift, axis=-1)], axis=-1)
    padded = np.concatenate([phase, np.zeros((COPIES, 2))], axis=-1)
    matrix = np.concatenate([slopes, padded[:, None], row[:, None]], axis=1)
    last = np.broadcast_to(np.eye(start.shape[-1])[-1], start.shape)
    change, direction = np.moveaxis(np.linalg.solve(matrix, np.stack([-right, last], axis=-1)), -1, 0)
    options = NewtonOptions(iterations=1, largest_step=np.inf)
    guess = (start, np.ones_like(start), options)
    how, tangent = compiled.followed_balances(model, member, (phase, anchor), (row, target), guess)
    for mine, theirs in ((how.x - start, change), (tangent, direction)):
        assert mine == pytest.approx(theirs, rel=1e-6, abs=1e-9 * np.abs(theirs).max())
    assert how.step == pytest.approx(np.sqrt((change**2).mean(axis=-1)))


def test_cycles_farther_than_their_reach_are_given_up_as_in_numpy(both: pytest.MonkeyPatch) -> None:
    model, member = perturbed(MODELS["hybrid"]()), np.arange(COPIES) % 4
    orbits = random_orbits(take(model, member), 3, COPIES)
    first = balance(model, member, orbits, NewtonOptions(iterations=1))[1].step
    options = NewtonOptions(reach=first * np.resize([0.9, 1.1], COPIES), tolerance=1e-9, iterations=3)
    found = balance(model, member, orbits, options)[1]
    both.setattr(compiled, "AVAILABLE", False)
    expected = balance(model, member, orbits, options)[1]
    assert found.iterations.tolist() == expected.iterations.tolist()
    assert (found.iterations[::2] == 1).all()
    assert (found.iterations[1::2] == 3).all()


@pytest.mark.parametrize("name", MODELS)
def test_multipliers_are_those_of_the_numpy_form(name: str, both: pytest.MonkeyPatch) -> None:
    model, member = perturbed(MODELS[name]()), np.arange(COPIES) % 4
    orbits = random_orbits(take(model, member), 5, COPIES)
    found = monodromy(model, member, orbits)
    both.setattr(compiled, "AVAILABLE", False)
    expected = monodromy(model, member, orbits)
    known = np.isfinite(expected).all(axis=(1, 2))
    assert known.any()
    for mine, theirs in zip(found[known], expected[known], strict=True):
        assert mine == pytest.approx(theirs, rel=1e-9, abs=1e-11 * np.abs(theirs).max())


def test_explicit_cycles_are_those_of_the_numpy_form(both: pytest.MonkeyPatch) -> None:
    closure = Analysis(closure=Closure.PUBLISHED)
    model = perturbed(hybrid(source_line(1, torsional_ratio=0.0308), 2, closure))
    winds = np.linspace(3.0, 14.0, COPIES)
    found = explicit_cycles(model, winds)
    both.setattr(compiled, "AVAILABLE", False)
    expected = explicit_cycles(model, winds)
    assert found.member.size > 4 * COPIES
    assert found.member.tolist() == expected.member.tolist()
    assert found.wind.tolist() == expected.wind.tolist()
    assert found.angle == pytest.approx(expected.angle, rel=1e-12)
    assert found.angular_frequency == pytest.approx(expected.angular_frequency, rel=1e-12, nan_ok=True)


def cycles_of(model: ReducedModel) -> Cycles:
    winds = np.array([4.0, 6.0, 8.0])
    return find_cycles(model, critical_wind_speeds(model, 30.0), winds, energy_starts(model, winds, 5), 5)


def test_the_numpy_form_finds_the_same_cycles(both: pytest.MonkeyPatch) -> None:
    model = take(hybrid(source_line(1, torsional_ratio=0.0308), 2), [0])
    found = cycles_of(model)
    both.setattr(compiled, "AVAILABLE", False)
    expected = cycles_of(model)
    assert found.wind.tolist() == expected.wind.tolist()
    assert found.floquet.stability.tolist() == expected.floquet.stability.tolist()
    assert found.orbits.angular_frequency == pytest.approx(expected.orbits.angular_frequency, rel=1e-9)
    assert sizes(found) == pytest.approx(sizes(expected), rel=1e-7)


def sizes(cycles: Cycles) -> FloatArray:
    return np.asarray(np.linalg.norm(cycles.orbits.coefficients, axis=(1, 2)))


def test_starts_that_are_no_numbers_are_left_alone() -> None:
    model = hybrid(source_line(2), 1)
    start = random_orbits(model, 3, 2)
    start.coefficients[0, 1, 2] = np.nan
    _, how = balance(model, np.zeros(2, dtype=np.intp), start)
    assert how.iterations[0] == 0
    assert np.isnan(how.residual[0]).all()
    assert np.isfinite(how.residual[1]).all()
    assert not how.converged[0]
    assert how.iterations[1] > 0


@pytest.mark.parametrize(
    ("member", "speeds", "error", "message"),
    [
        (np.zeros(2, dtype=np.intp), 3, ValueError, "must hold 2 numbers of kind d"),
        (np.zeros(2, dtype=np.int32), 2, ValueError, "of kind"),
        (np.array([0, 1]), 2, IndexError, "model 1 of a stack of 1"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(
    member: IntArray, speeds: int, error: type[Exception], message: str
) -> None:
    unknowns = np.ones((2, 3 * 7 + 1))
    with pytest.raises(error, match=message):
        compiled.solved_balances(
            hybrid(source_line(2), 1), member, np.ones(speeds), unknowns[:, 1:], (unknowns, unknowns, NewtonOptions())
        )


def test_overflow_is_a_value() -> None:
    model = hybrid(source_line(2), 1)
    orbits = random_orbits(model, 3, 1)
    wild = Orbits(1e200 * orbits.coefficients, orbits.angular_frequency, orbits.wind_speed)
    assert np.isnan(floquet(model, np.array([0]), wild).multipliers).all()


def test_the_engine_starts_without_them() -> None:
    program = (
        "import sys; sys.modules['engine.kernels._kernels'] = None\n"
        "from engine.kernels import compiled\n"
        "from tests.engine.kernels.test_compiled import cycles_of, hybrid, source_line\n"
        "assert not compiled.AVAILABLE\n"
        "print(len(cycles_of(hybrid(source_line(2), 1)).member))\n"
    )
    run = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    assert int(run.stdout) == 3


@pytest.mark.parametrize("name", MODELS)
def test_a_block_of_direct_integration_is_that_of_the_numpy_form(name: str, both: pytest.MonkeyPatch) -> None:
    model = perturbed(MODELS[name]())
    member, wind = np.arange(COPIES) % 4, np.linspace(2.0, 4.0, COPIES)
    start = spread_starts(model, member, wind, (0.05,), np.random.default_rng(1))[:, -1]

    def settled_after_one_block() -> SettledMotions:
        return integrate_until_settled(model, member, wind, start, 1)

    found = settled_after_one_block()
    both.setattr(compiled, "AVAILABLE", False)
    expected = settled_after_one_block()
    assert (expected.blocks == 1).all()
    for name_of_part in ("state", "size"):
        mine, theirs = getattr(found, name_of_part), getattr(expected, name_of_part)
        assert mine == pytest.approx(theirs, rel=1e-7, abs=1e-9 * np.abs(theirs).max())
    assert found.outcome.tolist() == expected.outcome.tolist()


@pytest.mark.parametrize("name", ["hybrid, table and stretching", "finite element, table", "hybrid, stretching"])
def test_states_without_a_number_are_noticed(name: str) -> None:
    model = MODELS[name]()
    start = np.full((3, 2 * model.mass.shape[-1]), 1e-3)
    start[0], start[1] = np.inf, np.nan
    runs = integrate_until_settled(model, np.zeros(3, dtype=np.intp), np.full(3, 5.0), start, 1, 8)
    assert runs.outcome.tolist()[:2] == [Outcome.NO_CONVERGENCE] * 2
    assert runs.outcome[2] is not Outcome.NO_CONVERGENCE


def test_direct_integration_that_diverges_is_noticed_by_both_forms(both: pytest.MonkeyPatch) -> None:
    model, wind = hybrid(source_line(1), 1), np.array([9.0, 9.0])
    member = np.zeros(2, dtype=np.intp)
    start = np.array([[0.01], [80.0]]) * spread_starts(model, member, wind, (1.0,), np.random.default_rng(1))[:, -1]
    for available in (True, False):
        both.setattr(compiled, "AVAILABLE", available)
        runs = integrate_until_settled(model, member, wind, start, 2)
        assert runs.outcome.tolist() == [Outcome.LIMIT_REACHED, Outcome.NO_CONVERGENCE]


UNEVEN = np.radians([-60.0, -33.0, -20.0, -12.0, -7.0, 0.0, 4.0, 9.0, 15.0, 31.0, 47.0])


@pytest.mark.parametrize("rows", [np.linspace(-0.7, 0.8, 16), UNEVEN, np.append(UNEVEN, UNEVEN[0] + 2.0 * np.pi)])
def test_the_load_of_a_table_is_that_of_the_numpy_form_whatever_its_rows(
    rows: FloatArray, both: pytest.MonkeyPatch
) -> None:
    """Rows at equal distances need no search; motions here leave a stretch at both ends and outrun the wind."""
    columns = (np.sin(2.0 * rows) + 0.3 * np.cos(rows), 1.0 - 0.5 * np.cos(2.0 * rows), 0.2 * np.sin(3.0 * rows))
    lift, drag, moment = (tuple(column.tolist()) for column in columns)
    table = MeasuredCoefficients(tuple(rows.tolist()), lift, drag, moment, 0.05, 0.5)
    line = short(source_line(3))
    line = replace(line, ice=replace(line.ice, aerodynamics=fit_measured(table)))
    model = hybrid(line, 2, TABLE)
    orbits = random_orbits(model, 3, 8)
    orbits = replace(orbits, coefficients=np.geomspace(0.01, 3.0, 8)[:, None, None] * orbits.coefficients)
    found = linearized(model, np.zeros(8, dtype=np.intp), orbits)
    both.setattr(compiled, "AVAILABLE", False)
    expected = linearized(model, np.zeros(8, dtype=np.intp), orbits)
    for mine, theirs in zip(found, expected, strict=True):
        size = np.abs(theirs).max(axis=0)
        assert (np.abs(mine - theirs) <= 1e-9 * np.abs(theirs) + 1e-11 * size).all()
