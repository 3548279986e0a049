"""Torsional frequencies of bundles with rigid and free sections beside chains of bars, OpenSees and the textbook."""

import math
from collections.abc import Iterator
from dataclasses import replace

from benchmarks.bundle_chain import torsional_frequency
from benchmarks.lines import source_line
from benchmarks.opensees import Conductor, Section, twin_torsional_frequency
from benchmarks.validation.common import percent, result, table
from engine.spec import Analysis, CrossSection, Ice, Line, LongitudinalInertia, Yoke

LOOPS = (1, 2, 3)
KINDS = (  # section, yoke, name of both, how chains of bars are tied
    (CrossSection.RIGID, Yoke.HELD, "rigid", "everywhere"),
    (CrossSection.FREE, Yoke.HELD, "free, yokes held", "at ends"),
    (CrossSection.FREE, Yoke.FREE, "free, yokes free", "nowhere"),
)
ANALYSIS = Analysis(loops=LOOPS, wind_speeds=(), longitudinal_inertia=LongitudinalInertia.CONDENSED)


def section() -> Iterator[str]:
    """Yield the section's text."""
    yield "## Torsional frequencies: rigid and free sections\n"
    yield (
        "In a free section (theory section 12.2) each sub-conductor moves along the span by itself. The chains of bars "
        "(benchmarks/bundle_chain.py, 100 bars for each sub-conductor, with common V, W and Theta at every joint) "
        "share no element, shape or bundle sum with the engine. `textbook` is "
        "(k/2L) sqrt((H r^2 + GJ)/(m r^2 + I)), a bundle without sag and ice. Condensed longitudinal inertia; Hz. "
        "No measurement on a real bundle stands beside these figures: none was found in the open with the data of its "
        "line.\n"
    )
    head = ["n", "section", "loops", "hybrid", "finite element", "chains of bars", "difference %", "textbook"]
    yield table(head, [row for n in (2, 3, 4) for row in _beside_chains(n)])
    yield (
        "\nTwo chains of OpenSees stand for a horizontal twin: they move across the line together and are opposite "
        "in a torsional mode. Their bars have no torsional rigidity and no polar inertia, so the line here has neither "
        "and its ice no eccentricity.\n"
    )
    yield table(["section", "loops", "finite element", "OpenSees", "difference %"], list(_beside_opensees()))


def _beside_chains(subconductors: int) -> Iterator[list[object]]:
    for kind, yoke, name, tied in KINDS:
        line = _bundle(source_line(subconductors), kind, yoke)
        found = result(line, ANALYSIS)
        ends = (found.static.longitudinal_stiffness_n_per_m or math.inf,) * 2
        hybrid, full = (
            {row.loops: row.torsional_hz or math.nan for row in found.frequencies if row.model == model}
            for model in ANALYSIS.models
        )
        for loops in LOOPS:
            chain = torsional_frequency(line, ends, loops, tied)
            cells = f"{hybrid[loops]:.4f}", f"{full[loops]:.4f}", f"{chain:.4f}", percent(full[loops], chain)
            yield [subconductors, name, loops, *cells, f"{_textbook(line, loops):.4f}"]


def _beside_opensees() -> Iterator[list[object]]:
    line = source_line(2)
    bare = replace(line.conductor, torsional_rigidity=1e-6, polar_inertia=1e-12)
    line = replace(line, conductor=bare, ice=Ice(line.ice.aerodynamics))
    for kind, yoke, name, tied in KINDS:
        found = result(_bundle(line, kind, yoke), ANALYSIS)
        end = found.static.longitudinal_stiffness_n_per_m or math.inf
        conductor = Conductor(bare.axial_rigidity, bare.mass, found.static.horizontal_tension_n)
        for row in found.frequencies:
            if row.model == "finite_element":
                section = Section((line.span.length,), end_stiffness=(end, end))
                expected = twin_torsional_frequency(conductor, section, row.loops, tied)
                value = row.torsional_hz or math.nan
                yield [name, row.loops, f"{value:.4f}", f"{expected:.4f}", percent(value, expected)]


def _bundle(line: Line, kind: CrossSection, yoke: Yoke) -> Line:
    """Return a line with such sections and equal ends."""
    end = replace(line.supports.left, yoke=yoke)
    return replace(
        line, bundle=replace(line.bundle, section=kind), supports=replace(line.supports, left=end, right=end)
    )


def _textbook(line: Line, loops: int) -> float:
    conductor, square = line.conductor, sum(p * p for p in line.bundle.positions[0])
    stiffness = (line.span.horizontal_tension or math.nan) * square + conductor.torsional_rigidity
    inertia = conductor.mass * square + conductor.polar_inertia
    return loops / (2.0 * line.span.length) * math.sqrt(stiffness / inertia)
