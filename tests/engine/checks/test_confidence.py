"""What is said of the trust in a cycle, against solving the changed problem in full and against direct integration."""

from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.checks.confidence import DETUNING, LINEAR, confidence, stretching_shift
from engine.cycles.harmonic_balance import Orbits, balance, half_peak_to_peak, residual, resized, select
from engine.cycles.search import Cycles, find_cycles
from engine.cycles.starts import energy_starts
from engine.kernels import compiled
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel, take
from engine.numerics.newton import NewtonOptions
from engine.spec import Analysis, Check, Stretching
from tests.builders import hybrid, source_line

WINDS = np.array([4.0, 6.0])


def cycles_of(model: ReducedModel, harmonics: int) -> Cycles:
    starts = energy_starts(model, WINDS, harmonics)
    return find_cycles(model, critical_wind_speeds(model, 30.0), WINDS, starts, harmonics)


def solved_anew(model: ReducedModel, cycles: Cycles, start: Orbits) -> FloatArray:
    orbits, solution = balance(model, cycles.member, start, NewtonOptions(tolerance=1e-10))
    assert solution.converged.all()
    return np.asarray(half_peak_to_peak(orbits.coefficients) / half_peak_to_peak(cycles.orbits.coefficients) - 1.0)


def test_truncation_is_what_one_harmonic_more_changes() -> None:
    model = hybrid(source_line(1), 1)
    cycles = cycles_of(model, 2)
    measured = confidence(model, cycles, Check.NONE)
    change = np.abs(solved_anew(model, cycles, resized(cycles.orbits, 3)))[:, 0]
    assert (measured.truncation > 1e-5).all()
    assert measured.truncation == pytest.approx(change, rel=0.1)
    assert (confidence(model, cycles_of(model, 7), Check.NONE).truncation < measured.truncation / 10.0).all()


def detuned(model: ReducedModel, shift: float) -> ReducedModel:
    factor = np.where(model.direction == 1, 1.0 + shift, 1.0)
    return replace(model, stiffness=model.stiffness * factor[:, None] * factor)


@pytest.mark.parametrize("subconductors", [1, 3])
def test_detuning_is_the_larger_change_of_a_higher_and_a_lower_horizontal_frequency(subconductors: int) -> None:
    model = hybrid(source_line(subconductors), 2)
    cycles = cycles_of(model, 5)
    main = (half_peak_to_peak(cycles.orbits.coefficients) * np.sqrt(model.modal_masses)).argmax(axis=-1)
    rise, fall = (
        solved_anew(detuned(model, shift), cycles, cycles.orbits)[np.arange(main.size), main]
        for shift in (DETUNING, -DETUNING)
    )
    measured = confidence(model, cycles, Check.NONE).detuning
    assert measured == pytest.approx(np.where(np.abs(rise) > np.abs(fall), rise, fall), rel=1e-4)
    assert (np.abs(measured) > 0.02).all()  # the close resonance of two loops is soft
    assert (rise * fall < 0.0).all()


def test_a_cycle_that_detuning_hardly_changes_has_the_sign_of_a_rise() -> None:
    model = hybrid(source_line(1), 1)
    cycles = cycles_of(model, 5)
    main = (half_peak_to_peak(cycles.orbits.coefficients) * np.sqrt(model.modal_masses)).argmax(axis=-1)
    rise = solved_anew(detuned(model, DETUNING), cycles, cycles.orbits)[np.arange(main.size), main]
    assert (np.abs(rise) < LINEAR).all()
    # The shifted cycles are known to some 1e-5 of their amplitude, and these change by 3e-4.
    assert confidence(model, cycles, Check.NONE).detuning == pytest.approx(rise, abs=3e-5)


def test_the_shift_of_stretching_is_that_of_the_theory() -> None:
    # Theory section 12.1, C11: two horizontal loops of 0.36 m are raised by 0.635 % if nothing else moves.
    model = hybrid(source_line(2), 2, Analysis(stretching=Stretching.INCLUDED))
    coefficients = np.zeros((1, model.mass.shape[-1], 11))
    coefficients[0, 1, 1] = 0.36 / np.abs(model.shapes[0, 1, 1]).max()
    orbit = Orbits(coefficients, np.array([5.6]), np.array([4.0]))
    assert stretching_shift(model, np.zeros(1, dtype=np.intp), orbit) == pytest.approx([0.00635], rel=0.01)
    assert stretching_shift(hybrid(source_line(2), 2), np.zeros(1, dtype=np.intp), orbit) == pytest.approx([0.0])


def test_detuning_looks_back_over_the_shift_that_stretching_causes() -> None:
    model = hybrid(source_line(2), 2, Analysis(stretching=Stretching.INCLUDED))
    cycles = cycles_of(model, 5)
    shift = stretching_shift(model, cycles.member, cycles.orbits)
    assert (shift > DETUNING).all()
    start = select(cycles.orbits, np.zeros(1, dtype=np.intp))
    before = half_peak_to_peak(start.coefficients)
    main = int((before[0] * np.sqrt(model.modal_masses)).argmax())
    changes = []
    for relative in (DETUNING, -DETUNING, -float(shift[0])):
        orbit, solution = balance(detuned(model, relative), cycles.member[:1], start)
        assert solution.converged.all()
        changes.append(float(half_peak_to_peak(orbit.coefficients)[0, main] / before[0, main] - 1.0))
    assert confidence(model, cycles, Check.NONE).detuning[0] == pytest.approx(max(changes, key=abs), rel=1e-3)
    assert max(changes, key=abs) == changes[2]


@pytest.mark.parametrize("available", [True, False])
def test_residual_is_that_of_the_harmonics_solved_for(available: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """The step with one more harmonic tells it; what is missing in that harmonic is truncation."""
    model = hybrid(source_line(2), 1)
    cycles = cycles_of(model, 2)
    moved = replace(cycles, orbits=replace(cycles.orbits, coefficients=1.01 * cycles.orbits.coefficients))
    expected = np.abs(residual(take(model, cycles.member), moved.orbits)).max(axis=(1, 2))
    elastic = np.abs(model.stiffness[cycles.member] @ moved.orbits.coefficients).max(axis=(1, 2))
    monkeypatch.setattr(compiled, "AVAILABLE", available and compiled.AVAILABLE)
    measured = confidence(model, moved, Check.NONE).residual
    assert measured == pytest.approx(expected / elastic, rel=1e-9)
    assert (measured > 1e-5).all()


def test_residual_is_that_of_rounding_and_direct_integration_agrees() -> None:
    model = hybrid(source_line(2), 1)
    cycles = cycles_of(model, 5)
    measured = confidence(model, cycles, Check.DIRECT)
    assert (measured.residual < 1e-9).all()
    assert (np.abs(measured.direct) < 5e-4).all()
    assert np.isnan(confidence(model, cycles, Check.NONE).direct).all()
