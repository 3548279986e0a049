"""Sections of several spans beside OpenSees, and their motions in both models. Theory section 16."""

import time
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from benchmarks.lines import source_line
from benchmarks.opensees import Conductor, InsulatorString, natural_modes
from benchmarks.opensees import Section as PeerSection
from benchmarks.validation.common import percent, result, table
from engine.assemblies.assembled_line import assembled_section
from engine.assemblies.numbered_modes import directional_modes, largest_member, member_shares
from engine.spec import (
    Analysis,
    Line,
    Model,
    Physics,
    PhysicsRequest,
    Section,
    SectionSpan,
    Span,
    SuspensionString,
    with_physics,
)

BARS, ELEMENTS = 60, 20
SHOWN = 9
WIND = 6.0
SPEED_WINDS = (4.0, 5.0, 6.0)
_LETTERS = ("v", "h")


def section() -> Iterator[str]:
    """Yield the section's text."""
    yield "## Sections of several spans\n"
    yield (
        "One conductor of the source in spans between two dead ends, with suspension strings that swing along and\n"
        "across the line: the lowest vertical (v) and horizontal (h) modes, with the span of the largest share of\n"
        f"kinetic energy, {ELEMENTS} elements a span. OpenSees has {BARS} corotational bars a span, and the strings\n"
        "as springs and masses at the supports. Spans of equal length tie.\n"
    )
    rows = [row for name, line in SECTIONS.items() for row in _modes(name, line)]
    yield table(["section", "mode", "span", "Hz", "OpenSees", "difference %"], rows)
    yield (
        "\nThe twin in three spans of 350 m (40 kN, strings of 4.5 m and 2500 N) under full physics at "
        f"{WIND:g} m/s, as\nrigid sections: cycles of the hybrid model, one vertical mode each, beside those of the "
        "finite element model,\nwhich moves three vertical modes with their partners together. It tells which of them "
        "survive.\n"
    )
    head = ["mode", "hybrid V m", "W m", "stability", "finite element V m", "W m", "stability"]
    yield table(head, list(_motions()))


def _section_line(lengths: tuple[float, ...], tension: float, string: SuspensionString, subconductors: int = 1) -> Line:
    own = Section(tuple(SectionSpan(x) for x in lengths), (string,) * (len(lengths) - 1))
    span = Span(lengths[0], horizontal_tension=tension, elements=ELEMENTS)
    return replace(source_line(subconductors), span=span, section=own)


LONG = SuspensionString(4.5, 2500.0)
SECTIONS = {
    "5 x 350 m, 40 kN": _section_line((350.0,) * 5, 40e3, LONG),
    "280, 300, 330 m, 30 kN": _section_line((280.0, 300.0, 330.0), 30e3, SuspensionString(2.4, 600.0)),
}


def _modes(name: str, line: Line) -> Iterator[list[object]]:
    assert line.section is not None
    whole = assembled_section(line)
    found: list[tuple[float, str, int]] = []
    for direction, letter in enumerate(_LETTERS):
        modes = directional_modes(whole.assembly, direction)
        spans = largest_member(member_shares(whole.assembly, modes.displacement)) + 1
        hertz = np.sqrt(np.maximum(modes.squares, 0.0)) / (2.0 * np.pi)
        own = np.flatnonzero(modes.direction == direction)
        found += [(float(hertz[i]), f"{letter}{modes.number[i]}", int(spans[i])) for i in own]
    string = line.section.strings[0]
    peer = PeerSection(
        tuple(span.length for span in line.section.spans),
        (InsulatorString(string.length, string.weight),) * len(line.section.strings),
    )
    conductor = Conductor(line.conductor.axial_rigidity, line.conductor.mass, line.span.horizontal_tension or 0.0)
    _, expected = natural_modes(conductor, peer, SHOWN, BARS)
    for (frequency, mode, span), other in zip(sorted(found)[:SHOWN], expected, strict=True):
        difference = percent(frequency, other.frequency)
        yield [name, mode, span, f"{frequency:.5f}", f"{other.frequency:.5f}", difference]


def _motions() -> Iterator[list[object]]:
    line = _section_line((350.0,) * 3, 40e3, LONG, 2)
    line = replace(
        line,
        span=replace(line.span, elements=10),
        ice=replace(line.ice, aerodynamics=replace(line.ice.aerodynamics, at_rest=(0.0, 1.0, 0.0))),
    )
    both = Analysis(loops=(1, 2, 3), wind_speeds=(WIND,), finite_element_loops=(1, 2, 3))
    rows = result(line, with_physics(line, both, PhysicsRequest(Physics.FULL))).limit_cycles
    moving = [row for row in rows if row.kind == "periodic"]
    for mode in (1, 2, 3):
        own = [row for row in moving if row.loops == mode]
        cells: list[object] = [mode]
        for model in (Model.HYBRID, Model.FINITE_ELEMENT):
            row = max((r for r in own if r.model is model), key=lambda r: r.vertical_m or 0.0, default=None)
            cells += ["-"] * 3 if row is None else [f"{row.vertical_m:.3f}", f"{row.horizontal_m:.3f}", row.stability]
        yield cells


def seconds_a_line(repetitions: int = 5) -> float:
    """Return the processor time of the hybrid analysis of five spans, two modes and three wind speeds [s]."""
    line = _section_line((350.0,) * 5, 40e3, LONG, 2)
    line = replace(
        line,
        span=replace(line.span, elements=10),
        ice=replace(line.ice, aerodynamics=replace(line.ice.aerodynamics, at_rest=(0.0, 1.0, 0.0))),
    )
    asked = with_physics(line, Analysis(models=(Model.HYBRID,), wind_speeds=SPEED_WINDS), PhysicsRequest(Physics.FULL))
    result(line, asked)
    times = []
    for _ in range(repetitions):
        start = time.process_time()
        result(line, asked)
        times.append(time.process_time() - start)
    return min(times)
