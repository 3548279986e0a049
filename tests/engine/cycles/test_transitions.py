"""Every change of stability on a branch has its bifurcation, and none depends on the wind speeds asked for."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.cycles.bifurcations import Bifurcations
from engine.cycles.search import Cycles
from engine.cycles.transitions import FACTORS, Kind
from engine.outcome import Stability
from engine.spec import AerodynamicModel, Analysis, Line, LongitudinalInertia, Physics, Span, Stretching, with_section
from tests.builders import lightly_damped_line, source_line
from tests.engine.motions import bifurcations_between, resonant_line

FULL = Analysis(
    aerodynamic_model=AerodynamicModel.RELATIVE_WIND,
    longitudinal_inertia=LongitudinalInertia.CONDENSED,
    stretching=Stretching.INCLUDED,
)
FEW, MANY = np.linspace(3.0, 13.0, 6), np.linspace(3.0, 13.0, 21)
SAME = 1e-4  # relative difference of two wind speeds that are the same bifurcation


def drawn(number: int) -> Line:
    generator = np.random.default_rng(number)
    return lightly_damped_line(generator)


def crowded_line() -> Line:
    """Return a line on whose branch three multipliers come close to the trivial one at a fold."""
    line = source_line(1, torsional_ratio=0.00714149627216)
    return replace(line, span=Span(96.80325492792808, horizontal_tension=26255.41758840855))


LINES = [resonant_line(), crowded_line(), *(drawn(number) for number in range(5))]


def unexplained(cycles: Cycles, found: Bifurcations) -> list[tuple[float, float]]:
    """Return neighbours, by their wind speeds, between which stability changes without a bifurcation."""
    missing, first = [], 0
    for branch_set in cycles.branch_sets:
        points, stability = branch_set.points, branch_set.floquet.stability
        known = np.flatnonzero(stability != Stability.UNKNOWN)
        for left, right in itertools.pairwise(known.tolist()):
            if points.branch[left] != points.branch[right] or stability[left] == stability[right]:
                continue
            low, high = sorted((float(points.z[left, -1]), float(points.z[right, -1])))
            own = found.branch == cycles.followed[first + points.branch[left]]
            reach = found.uncertainty + SAME * found.parameter
            if not (own & (found.parameter > low - reach) & (found.parameter < high + reach)).any():
                missing.append((low, high))
        first += branch_set.problem.member.size
    return missing


def within(found: Bifurcations, kind: Kind) -> FloatArray:
    inside = (found.parameter > FEW[0]) & (found.parameter < FEW[-1])
    return np.sort(found.parameter[inside & np.array([k is kind for k in found.kind], dtype=np.bool_)])


def assert_independent(line: Line, loops: int, analysis: Analysis) -> None:
    """Compare bifurcations and stable cycles for two sets of wind speeds, and look for changes without a row."""
    few, many = (bifurcations_between(line, loops, winds, analysis) for winds in (FEW, MANY))
    for cycles, found in (few, many):
        assert unexplained(cycles, found) == []
        assert Kind.UNRESOLVED not in found.kind.tolist()
    for kind in Kind:
        assert within(few[1], kind) == pytest.approx(within(many[1], kind), rel=SAME)
    stable = [cycles.floquet.stability == Stability.STABLE for cycles, _ in (few, many)]
    counts = [np.bincount(cycles.wind[at], minlength=21) for (cycles, _), at in zip((few, many), stable, strict=True)]
    assert counts[0][:6].tolist() == counts[1][::4].tolist()


@pytest.mark.parametrize("line", LINES, ids=["resonant", "crowded", *map(str, range(5))])
@pytest.mark.parametrize("loops", [1, 2])
def test_every_change_of_stability_has_its_row_whatever_wind_speeds_are_asked_for(line: Line, loops: int) -> None:
    assert_independent(line, loops, Analysis())


@pytest.mark.parametrize("number", [3, 4, 8])
@pytest.mark.parametrize("loops", [1, 2])
def test_the_same_holds_under_full_physics(number: int, loops: int) -> None:
    line = drawn(number)
    at_rest = replace(line.ice.aerodynamics, at_rest=(0.0, 1.0, 0.0))
    line = with_section(replace(line, ice=replace(line.ice, aerodynamics=at_rest)), Physics.FULL)
    assert_independent(line, loops, FULL)


def test_the_crowded_line_has_the_bifurcations_that_sixteen_harmonics_give() -> None:
    _, found = bifurcations_between(crowded_line(), 1, FEW)
    near = (found.branch == 0) & (found.parameter > 11.0) & (found.parameter < 12.0)
    assert [found.kind[i] for i in np.flatnonzero(near)] == [Kind.FOLD, Kind.TORUS, Kind.FOLD, Kind.TORUS]
    assert found.parameter[near] == pytest.approx([11.5838, 11.5845, 11.8306, 11.9622], abs=2e-4)


def test_multipliers_beyond_all_numbers_cross_nothing_and_warn_of_nothing() -> None:
    huge = np.array([1e200 + 1e200j, 1e200 - 1e200j, 0.5])
    assert not np.isfinite(FACTORS[Kind.TORUS](huge)).all()
    assert FACTORS[Kind.TORUS](np.array([0.5, 3.0, 2.0])) == pytest.approx([-0.5, 0.0, -5.0])
