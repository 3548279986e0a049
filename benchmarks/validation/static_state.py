"""Static state under wind and level differences, against OpenSees and mechaphlowers. Theory sections 15 and 16."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from benchmarks import mechaphlowers, opensees
from benchmarks.lines import source_line
from benchmarks.validation.common import percent, table
from engine.arrays import FloatArray
from engine.mechanics.along_span import mean_drag
from engine.mechanics.modes import full_modes
from engine.models.discretization import Discretization, discretize
from engine.spec import BlowOut, Ice, Line, Span, Support, Supports, Wind

DEAD_ENDS = Supports(left=Support(dead_end=True), right=Support(dead_end=True))
TENSIONS = ((350.0, 60e3), (125.88, 30e3))
SPANS = ((350.0, 60e3, 20.0, 0.0), (300.0, 30e3, 20.0, 0.0), (300.0, 30e3, 0.0, 60.0), (300.0, 30e3, 0.0, 120.0))
SPANS = (*SPANS, (300.0, 30e3, 20.0, 120.0))


def hung_line(length: float, tension: float, wind_speed: float = 0.0, rise: float = 0.0) -> Line:
    """Return the source's single conductor, without the offset of its ice, between dead ends in a steady wind."""
    line = source_line(1)
    return replace(
        line,
        span=Span(length, horizontal_tension=tension, level_difference=rise, elements=20),
        supports=DEAD_ENDS,
        ice=Ice(line.ice.aerodynamics),
        wind=Wind(1.2929, blow_out=BlowOut(wind_speed, 1.0)),
    )


def peer(line: Line) -> tuple[opensees.Conductor, opensees.Section]:
    """Return the same line for OpenSees."""
    tension, stiffness = line.span.horizontal_tension, line.supports.longitudinal_stiffness
    assert tension is not None
    ends = math.inf if stiffness is None else stiffness
    conductor = opensees.Conductor(line.conductor.axial_rigidity, line.conductor.mass, tension, mean_drag(line))
    return conductor, opensees.Section((line.span.length,), (), line.span.level_difference, (ends, ends))


def lowest_frequencies(discretization: Discretization) -> FloatArray:
    """Return those of one and two loops in and out of the plane of the sag, in rising order [Hz]."""
    values = full_modes(discretization.matrices, (1, 2)).eigenvalues[0, :2]
    return np.asarray(np.sort(np.sqrt(values).ravel()) / (2.0 * math.pi))


def section() -> Iterator[str]:
    """Yield the section's text."""
    yield "## Static state under wind, and level differences\n"
    yield (
        "The source's conductor without offset of its ice, drag coefficient 1, twenty elements; OpenSees has 160 "
        "corotational bars a span, mechaphlowers has elastic catenaries between dead ends. Horizontal tension of a "
        "blown-out span, between dead ends and between springs with the stiffness (A10) of the adjacent spans in still "
        "air:\n"
    )
    head = ["span m", "H in still air N", "ends", "wind m/s", "H", "OpenSees", "difference %", "mechaphlowers"]
    yield table(head, [row for length, tension in TENSIONS for row in _tension_rows(length, tension)])
    yield (
        "\nNatural frequencies of one and two loops between dead ends, in rising order. In wind they are those in and "
        "out of the plane of the sag:\n"
    )
    head = ["span m", "wind m/s", "level difference m", "Hz", "OpenSees", "largest difference %"]
    yield table(head, [_frequency_row(hung_line(*span)) for span in SPANS])


def _tension_rows(length: float, tension: float) -> Iterator[list[object]]:
    for name in ("dead", "springs"):
        for speed in (10.0, 20.0, 30.0):
            line = hung_line(length, tension, speed)
            if name == "springs":
                own = discretize([replace(line, supports=Supports())]).profile.end_stiffness[0, 0]
                line = replace(line, supports=Supports(longitudinal_stiffness=float(own)))
            found = float(discretize([line]).profile.horizontal_tension[0])
            expected = opensees.tension_in_wind(*peer(line))
            cells = [f"{length:g}", f"{tension:.0f}", name, f"{speed:g}"]
            second = f"{_tension_of_catenary(line):.1f}" if name == "dead" else "-"
            yield [*cells, f"{found:.1f}", f"{expected:.1f}", percent(found, expected), second]


def _tension_of_catenary(line: Line) -> float:
    tension, conductor, blow_out = line.span.horizontal_tension, line.conductor, line.wind.blow_out
    assert tension is not None
    assert blow_out is not None
    assert blow_out.wind_speed is not None
    cable = mechaphlowers.HungCable(
        conductor.diameter, conductor.axial_rigidity, conductor.mass, line.span.length, tension
    )
    pressure = 0.5 * line.wind.air_density * blow_out.wind_speed**2
    return mechaphlowers.horizontal_tension(cable, mechaphlowers.Weather(wind_pressure=pressure))


def _frequency_row(line: Line) -> list[object]:
    found = lowest_frequencies(discretize([line]))
    expected = np.array([mode.frequency for mode in opensees.natural_modes(*peer(line), found.size)[1]])
    blow_out = line.wind.blow_out
    assert blow_out is not None
    cells = [f"{line.span.length:g}", f"{blow_out.wind_speed:g}", f"{line.span.level_difference:g}"]
    worst = int(np.abs(found / expected - 1.0).argmax())
    texts = [", ".join(f"{value:.4f}" for value in values) for values in (found, expected)]
    return [*cells, *texts, percent(float(found[worst]), float(expected[worst]))]
