"""Torsional frequencies of bundles whose sub-conductors move along the span by themselves. Theory section 12.2."""

import math
from dataclasses import replace
from types import ModuleType

import pytest

from benchmarks.bundle_chain import torsional_frequency
from engine.spec import Analysis, CrossSection, Ice, Line, LongitudinalInertia, Model, Span, Support, Supports, Yoke
from tests.builders import run, source_line

RIGID, FREE = CrossSection.RIGID, CrossSection.FREE
TIES = {(RIGID, Yoke.HELD): "everywhere", (FREE, Yoke.HELD): "at ends", (FREE, Yoke.FREE): "nowhere"}
PUBLISHED = {  # theory section 12.2, Hz: one and two loops
    2: {(RIGID, Yoke.HELD): (0.6343, 1.1729), (FREE, Yoke.HELD): (0.5895, 0.9127), (FREE, Yoke.FREE): (0.4842, 0.9127)},
    3: {(RIGID, Yoke.HELD): (0.5559, 1.0633), (FREE, Yoke.HELD): (0.5243, 0.9130), (FREE, Yoke.FREE): (0.4668, 0.9130)},
}
PUBLISHED[4] = PUBLISHED[3]
CASES = [(n, section, yoke, loops) for n, rows in PUBLISHED.items() for section, yoke in rows for loops in (1, 2)]


def bundle_line(line: Line, section: CrossSection, yoke: Yoke) -> Line:
    """Return a line whose section moves in this way, with equal ends."""
    end = replace(line.supports.left, yoke=yoke)
    return replace(
        line, bundle=replace(line.bundle, section=section), supports=replace(line.supports, left=end, right=end)
    )


def torsional(line: Line, loops: int, model: Model) -> float:
    """Return the torsional frequency of a model [Hz]."""
    asked = Analysis(
        loops=(loops,), models=(model,), wind_speeds=(), longitudinal_inertia=LongitudinalInertia.CONDENSED
    )
    found = run(line, asked).frequencies[0].torsional_hz
    assert found is not None
    return found


def end_stiffness(line: Line) -> tuple[float, float]:
    """Return K_x of the ends as the result states it [N/m]."""
    stiffness = run(line, Analysis(wind_speeds=())).static.longitudinal_stiffness_n_per_m
    return (math.inf if stiffness is None else stiffness,) * 2


@pytest.mark.parametrize("model", list(Model))
@pytest.mark.parametrize(("subconductors", "section", "yoke", "loops"), CASES)
def test_source_bundles_have_the_frequencies_of_the_theory_page(
    subconductors: int, section: CrossSection, yoke: Yoke, loops: int, model: Model
) -> None:
    line = bundle_line(source_line(subconductors), section, yoke)
    expected = PUBLISHED[subconductors][section, yoke][loops - 1]
    assert torsional(line, loops, model) == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize("dead_ends", [True, False], ids=["dead ends", "springs"])
@pytest.mark.parametrize("tied", TIES, ids=TIES.get)
@pytest.mark.parametrize("subconductors", [2, 3])
def test_a_chain_of_bars_for_every_sub_conductor_has_them_too(
    subconductors: int, tied: tuple[CrossSection, Yoke], dead_ends: bool
) -> None:
    line = source_line(subconductors)
    deep = Span(200.0, horizontal_tension=25_000.0, elements=20)
    ends = Support(dead_end=dead_ends)
    line = bundle_line(replace(line, span=deep, supports=Supports(left=ends, right=ends)), *tied)
    for loops in (1, 2):
        expected = torsional_frequency(line, end_stiffness(line), loops, TIES[tied])
        assert torsional(line, loops, Model.FINITE_ELEMENT) == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("loops", [2, 4])
def test_even_loops_of_a_free_section_are_those_of_the_textbook(loops: int) -> None:
    # (k pi/L) sqrt((H r^2 + GJ)/(m r^2 + I)): only odd loops stretch a sub-conductor. The sag makes up the rest.
    line = bundle_line(replace(source_line(2), ice=Ice(source_line(2).ice.aerodynamics)), FREE, Yoke.HELD)
    square = 0.2355**2
    stiffness, inertia = 30_000.0 * square + 101.0, 2.379 * square + 3.334e-4
    expected = loops / (2.0 * 125.88) * math.sqrt(stiffness / inertia)
    assert torsional(line, loops, Model.FINITE_ELEMENT) == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize("loops", [1, 2])
@pytest.mark.parametrize("tied", TIES, ids=TIES.get)
def test_opensees_has_the_frequencies_of_two_chains(
    peer: ModuleType, tied: tuple[CrossSection, Yoke], loops: int
) -> None:
    # Bars have neither torsional rigidity nor polar inertia; the line here has next to none.
    line = source_line(2)
    bare = replace(line.conductor, torsional_rigidity=1e-6, polar_inertia=1e-12)
    line = bundle_line(replace(line, conductor=bare, ice=Ice(line.ice.aerodynamics)), *tied)
    conductor = peer.Conductor(bare.axial_rigidity, bare.mass, 30_000.0)
    section = peer.Section((125.88,), end_stiffness=end_stiffness(line))
    expected = peer.twin_torsional_frequency(conductor, section, loops, TIES[tied])
    assert torsional(line, loops, Model.FINITE_ELEMENT) == pytest.approx(expected, rel=1e-3)
