"""Vertical frequencies of two loops beside OpenSees, from taut to slack spans. Theory section 12."""

import math
from collections.abc import Iterator
from dataclasses import replace

from benchmarks import opensees
from benchmarks.lines import source_line
from benchmarks.validation.common import percent, result, table
from engine.spec import Analysis, Line, LongitudinalInertia, Model, Support, Supports

LENGTHS = (300.0, 800.0)
SAG_SHARES = (0.005, 0.01, 0.02, 0.04, 0.08)


def section() -> Iterator[str]:
    """Yield the section's text."""
    yield "## Longitudinal inertia: two loops from taut to slack spans\n"
    yield (
        "Vertical frequency of two loops of the source's single conductor, in Hz, by the hybrid model with condensed\n"
        "longitudinal inertia, which full physics has, and without, as in the source, beside OpenSees (160\n"
        "corotational bars). Springs have the stiffness (A10) of equal adjacent spans. "
        "Twenty elements; difference in %.\n"
    )
    head = [
        "span m",
        "ends",
        "sag, share of the span",
        "OpenSees",
        "condensed",
        "difference",
        "neglected",
        "difference",
    ]
    yield table(
        head, [_row(length, dead, share) for length in LENGTHS for dead in (True, False) for share in SAG_SHARES]
    )


def _row(length: float, dead_ends: bool, sag_share: float) -> list[object]:
    line = source_line(1)
    span = replace(line.span, length=length, horizontal_tension=None, sag=length * sag_share, elements=20)
    end = Support(dead_end=dead_ends)
    hung = replace(line, span=span, supports=Supports(left=end, right=end))
    expected = _expected(hung)
    found = [_frequency(hung, inertia) for inertia in (LongitudinalInertia.CONDENSED, LongitudinalInertia.NEGLECTED)]
    cells = [cell for value in found for cell in (f"{value:.5f}", percent(value, expected))]
    return [f"{length:g}", "dead" if dead_ends else "springs", f"{100.0 * sag_share:g} %", f"{expected:.5f}", *cells]


def _frequency(line: Line, inertia: LongitudinalInertia) -> float:
    asked = Analysis(loops=(2,), models=(Model.HYBRID,), wind_speeds=(), longitudinal_inertia=inertia)
    frequency = result(line, asked).frequencies[0].vertical_hz
    assert frequency is not None
    return frequency


def _expected(line: Line) -> float:
    static = result(line, Analysis(loops=(2,), models=(Model.HYBRID,), wind_speeds=())).static
    stiffness = static.longitudinal_stiffness_n_per_m
    end = math.inf if stiffness is None else stiffness
    conductor = opensees.Conductor(line.conductor.axial_rigidity, line.conductor.mass, static.horizontal_tension_n)
    return opensees.vertical_frequency(conductor, opensees.Section((line.span.length,), end_stiffness=(end, end)), 2)
