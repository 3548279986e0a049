"""Which models are their own mirror image, and that their alternating cycles are those of the whole balance."""

from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.cycles.floquet import floquet, monodromy
from engine.cycles.harmonic_balance import Orbits, balance, half_peak_to_peak, linearized, select
from engine.cycles.search import Cycles, find_cycles
from engine.cycles.starts import energy_starts
from engine.kernels import compiled
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel
from engine.spec import AerodynamicModel, Analysis, DetuningPendulum, Line, Span, Stretching
from tests.builders import hybrid, source_line
from tests.engine.motions import relative_line

FULL = Analysis(stretching=Stretching.INCLUDED, aerodynamic_model=AerodynamicModel.RELATIVE_WIND)
LENGTH = relative_line(2).span.length
WINDS = np.array([4.0, 7.0, 10.0])


def with_pendulums(*positions: float) -> Line:
    made = [DetuningPendulum(position=at, mass=20.0, arm=0.4) for at in positions]
    return replace(relative_line(2), devices=tuple(made))


@pytest.mark.parametrize(
    ("line", "loops", "parity"),
    [
        (relative_line(2), 2, [-1, -1, -1, 1]),
        (relative_line(2), 1, [0, 0, 0]),
        (relative_line(2), 3, [0, 0, 0, 0]),
        (with_pendulums(40.0), 2, [0, 0, 0, 0]),
        (with_pendulums(40.0, LENGTH - 40.0), 2, [-1, -1, -1, 1]),
        (with_pendulums(40.0, LENGTH - 40.1), 2, [0, 0, 0, 0]),
        (replace(relative_line(2), span=Span(LENGTH, horizontal_tension=3e4, level_difference=20.0)), 2, [0, 0, 0, 0]),
    ],
)
def test_equal_halves_make_a_mirror_image(line: Line, loops: int, parity: list[int]) -> None:
    found = hybrid(line, loops, FULL).parity
    assert found is not None
    assert found.tolist() == [parity]


def test_without_stretching_two_loops_need_no_relief() -> None:
    found = hybrid(source_line(2), 2).parity
    assert found is not None
    assert found.tolist() == [[-1, -1, -1]]


def cycles_of(model: ReducedModel) -> Cycles:
    return find_cycles(model, critical_wind_speeds(model, 30.0), WINDS, energy_starts(model, WINDS, 5), 5)


@pytest.mark.skipif(not compiled.AVAILABLE, reason="the numpy form always solves the whole balance")
@pytest.mark.parametrize("subconductors", [1, 2, 4])
def test_alternating_cycles_are_those_of_the_whole_balance(subconductors: int) -> None:
    model = hybrid(relative_line(subconductors), 2, FULL)
    found, expected = cycles_of(model), cycles_of(replace(model, parity=None))
    assert found.wind.tolist() == expected.wind.tolist()
    assert found.wind.size >= WINDS.size - 1
    assert found.floquet.stability.tolist() == expected.floquet.stability.tolist()
    for own, whole in (
        (half_peak_to_peak(found.orbits.coefficients), half_peak_to_peak(expected.orbits.coefficients)),
        (found.orbits.angular_frequency, expected.orbits.angular_frequency),
    ):
        assert own == pytest.approx(whole, rel=1e-7, abs=1e-9)


@pytest.mark.skipif(not compiled.AVAILABLE, reason="the numpy form always solves the whole balance")
def test_no_harmonic_that_is_left_out_is_driven() -> None:
    model = hybrid(relative_line(2), 2, FULL)
    orbits, _ = balance(model, *start_of(model))
    order = (np.arange(orbits.coefficients.shape[-1]) + 1) // 2
    kept = (order % 2 == 1) == (np.array([-1, -1, -1, 1]) < 0)[:, None]
    assert not orbits.coefficients[:, ~kept].any()
    assert orbits.coefficients[:, kept].all()
    residuals, _ = linearized(model, np.zeros(1, dtype=np.intp), orbits)
    elastic = np.abs(model.stiffness @ orbits.coefficients).max()
    assert np.abs(residuals).max() < 1e-8 * elastic


def start_of(model: ReducedModel) -> tuple[np.ndarray, Orbits]:
    cycles = cycles_of(replace(model, parity=None))
    largest = half_peak_to_peak(cycles.orbits.coefficients)[:, 1].argmax()
    orbit = select(cycles.orbits, np.array([largest]))
    return np.zeros(1, dtype=np.intp), Orbits(1.02 * orbit.coefficients, orbit.angular_frequency, orbit.wind_speed)


@pytest.mark.parametrize("steps", [1, 2])
def test_half_a_period_gives_the_multipliers_of_the_whole(steps: int) -> None:
    model = hybrid(relative_line(2), 2, FULL)
    member, start = start_of(model)
    orbits, _ = balance(model, member, start)
    whole = replace(model, parity=None)
    expected = monodromy(whole, member, orbits, steps)
    assert monodromy(model, member, orbits, steps) == pytest.approx(expected, rel=1e-9, abs=1e-9)
    assert floquet(model, member, orbits, 4).trivial_error[0] < 1e-6


def test_a_start_with_the_other_harmonics_keeps_them() -> None:
    """A mirror image does not make every cycle alternate: what starts otherwise is solved as a whole."""
    model = hybrid(relative_line(2), 2, FULL)
    member, start = start_of(model)
    bent: FloatArray = start.coefficients.copy()
    bent[:, 0, 3] += 0.05 * np.abs(bent[:, 0]).max()
    one_step = Orbits(bent, start.angular_frequency, start.wind_speed)
    found, how = balance(model, member, one_step)
    expected, how_expected = balance(replace(model, parity=None), member, one_step)
    assert found.coefficients == pytest.approx(expected.coefficients, rel=1e-12, abs=1e-12)
    assert how.iterations.tolist() == how_expected.iterations.tolist()
