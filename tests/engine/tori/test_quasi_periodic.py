"""Which quasi-periodic motions an analysis reports: exact oscillators, and the source's lines."""

from dataclasses import replace

import numpy as np
import pytest

from engine.cycles.bifurcations import bifurcations
from engine.cycles.search import find_cycles
from engine.cycles.starts import energy_starts
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.outcome import Outcome, Stability
from engine.result import LimitCycleRow
from engine.spec import Model, TorusSearch
from engine.tori.quasi_periodic import QuasiPeriodicMotions, check_by_integration, quasi_periodic_motions
from engine.tori.spectrum import amplitude_range, base_frequencies
from tests.builders import only, run, source_line
from tests.engine.coupled_circles import FREQUENCIES, coupled_circles, two_lines
from tests.engine.motions import LIGHT

ONE = np.zeros(1, dtype=np.intp)


def motions(linear: tuple[float, float], winds: list[float], search: TorusSearch) -> QuasiPeriodicMotions:
    """Find the tori of two circles; the second one begins to move beside the first at U = 1."""
    model, speeds = coupled_circles((0.4, 1.0), linear), np.array(winds)
    crossings = critical_wind_speeds(model, 5.0)
    cycles = find_cycles(model, crossings, speeds, energy_starts(model, speeds, 5), 5)
    found = bifurcations(cycles.branch_sets, cycles.followed, model, crossings)
    return quasi_periodic_motions(model, cycles, found, speeds, search)


@pytest.mark.parametrize("search", TorusSearch)
def test_a_torus_that_takes_over_from_its_cycle_is_found_and_stable(search: TorusSearch) -> None:
    found = motions((2.0, 3.0), [0.9, 1.02, 1.2], search)
    assert found.wind.tolist() == [1, 2]
    assert found.stability.tolist() == [Stability.STABLE, Stability.STABLE]
    assert found.found_by == ("torus_point", "torus_point")
    assert found.residual.max() < 1e-12
    assert found.truncation.max() < 1e-4
    frequencies, _ = base_frequencies(coupled_circles((0.4, 1.0)), found.member, found.tori)
    assert frequencies == pytest.approx(np.array([FREQUENCIES, FREQUENCIES]), rel=2e-3)
    assert found.missing.size == 0


def test_direct_integration_stays_on_a_stable_torus() -> None:
    found = motions((2.0, 3.0), [1.2], TorusSearch.LASTING)
    assert np.isnan(found.direct).all()
    direct = check_by_integration(coupled_circles((0.4, 1.0), (2.0, 3.0)), found).direct
    assert np.abs(direct) == pytest.approx([0.0], abs=1e-4)
    wrong = replace(found, tori=replace(found.tori, coefficients=1.1 * found.tori.coefficients))
    assert np.abs(check_by_integration(coupled_circles((0.4, 1.0), (2.0, 3.0)), wrong).direct) > 0.01


def test_it_is_found_from_one_wind_speed_alone() -> None:
    alone, among = (motions((2.0, 3.0), winds, TorusSearch.LASTING) for winds in ([1.2], [0.9, 1.02, 1.2]))
    assert alone.tori.angular_frequency[0] == pytest.approx(among.tori.angular_frequency[1], rel=1e-6)


def test_amplitudes_of_two_lines_are_their_sum_and_difference() -> None:
    torus = two_lines((0.8, 0.3), FREQUENCIES, (2, 2))
    series = np.concatenate([torus.coefficients[0], torus.coefficients[0].sum(axis=0, keepdims=True)])
    largest, smallest = amplitude_range(series, torus, FREQUENCIES[0])
    assert largest == pytest.approx([0.8, 0.3, 1.1], rel=1e-3)
    assert smallest[:2] == pytest.approx([0.8, 0.3], rel=2e-3)
    # Not slow against each other: within one period the lines are never quite opposed.
    assert 0.5 < smallest[2] < 0.8


def rows(subconductors: int, wind: float, search: TorusSearch) -> list[LimitCycleRow]:
    asked = only(Model.HYBRID, loops=(2,), wind_speeds=(wind,), quasi_periodic=search)
    result = run(source_line(subconductors, torsional_ratio=LIGHT), asked)
    return [row for row in result.limit_cycles if row.kind == "quasi_periodic"]


@pytest.mark.parametrize(("subconductors", "wind"), [(1, 9.0), (2, 12.0), (3, 12.0)])
def test_two_stable_cycles_of_a_source_line_are_parted_by_an_unstable_torus(subconductors: int, wind: float) -> None:
    (row,) = rows(subconductors, wind, TorusSearch.EVERY)
    assert (row.stability, row.found_by) == (Stability.UNSTABLE, "torus_point")
    assert row.horizontal_ratio is not None
    assert row.outcome is (Outcome.BEYOND_DATA if row.horizontal_ratio > 1.0 else Outcome.CONVERGED)
    assert row.frequency_hz == pytest.approx(0.8915, rel=2e-3)
    assert row.second_frequency_hz == pytest.approx(0.889, rel=5e-3)
    assert row.horizontal_min_m is not None
    assert row.horizontal_m is not None
    assert 0.0 < row.horizontal_min_m < 0.7 * row.horizontal_m
    assert row.truncation is not None
    assert row.truncation < 1e-5
    assert rows(subconductors, wind, TorusSearch.LASTING) == []
