"""Coefficients over the whole angle (theory section 14): the static twist in the wind, and cubics as their limit."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from benchmarks.lines import source_line
from benchmarks.validation.common import percent, result, table
from engine.mechanics.coefficients import fit_measured
from engine.models.discretization import discretize, with_wind_twist
from engine.outcome import Stability
from engine.result import LimitCycleRow
from engine.spec import (
    AerodynamicModel,
    Aerodynamics,
    Analysis,
    CrossSection,
    Line,
    LongitudinalInertia,
    MeasuredCoefficients,
    Model,
    Stretching,
)
from tests.engine.synthetic_table import series, with_table

RISING = (4.0, 10.0, 20.0)
TWISTS = {  # theory section 14: sub-conductors and static angle [deg]; twist at mid-span at these winds [deg]
    (2, 20.0): (-0.0068, -0.0436, -0.1877),
    (2, 40.0): (0.1228, 0.785, 3.388),
    (1, 20.0): (-1.693, -15.44, -20.67),
    (1, -20.0): (4.473, 17.60, 21.57),
}
STEPS = (2.5, 1.0, 0.25)  # of tables [deg]
ABOVE_ONSET = (1.01, 1.03, 1.1, 1.3, 2.0)  # wind speeds over that of the onset
CUBIC = Analysis(
    loops=(1,),
    models=(Model.HYBRID,),
    wind_speeds=(),
    critical_wind_limit=15.0,
    aerodynamic_model=AerodynamicModel.RELATIVE_WIND,
    longitudinal_inertia=LongitudinalInertia.CONDENSED,
    stretching=Stretching.INCLUDED,
)
TABLE = replace(CUBIC, aerodynamic_model=AerodynamicModel.TABLE)


def section() -> Iterator[str]:
    """Yield the section's text."""
    yield "## Coefficients over the whole angle\n"
    yield (
        "The source prints no table over the whole circle. The one used here is synthetic: Fourier series of order 7 "
        "every degree that have the source's coefficients at angle zero. Static twist at mid-span in a rising wind, "
        "beside that of an independent implementation of theory section 14; further equilibria are those that a search "
        "at that wind finds besides.\n"
    )
    head = ["n", "static angle deg", "wind m/s", "twist deg", "independent", "further equilibria"]
    yield table(head, [row for case in TWISTS for row in _twists(*case)])
    yield (
        "\nCycles of the twin in one loop, by tables of the series with different steps as they stand, against the "
        "source's cubics: difference of the vertical amplitude in %. With the size of "
        "the motion only the error of the table's splines is left, whose third derivative jumps at each of its angles; "
        "it falls with the step. Relative wind, rigid section, condensed inertia and stretching in all.\n"
    )
    head = ["wind over onset", "wind m/s", "cubics, vertical m", *(f"every {step:g} deg" for step in STEPS)]
    yield table(head, list(_limits()))


def _twists(subconductors: int, static_angle: float) -> Iterator[list[object]]:
    line = with_table(source_line(subconductors), static_angle)
    found = with_wind_twist(discretize([line]), np.array(RISING)).wind_twist
    assert found is not None
    middle = np.degrees(found.angle[0, :, found.angle.shape[-1] // 2])
    for i, (speed, expected) in enumerate(zip(RISING, TWISTS[subconductors, static_angle], strict=True)):
        further = int((found.further_wind == i).sum())
        yield [subconductors, f"{static_angle:g}", f"{speed:g}", f"{middle[i]:.4f}", f"{expected:g}", further]


def _limits() -> Iterator[list[object]]:
    twin = source_line(2)
    twin = replace(twin, bundle=replace(twin.bundle, section=CrossSection.RIGID))
    cubic = _with(twin, replace(twin.ice.aerodynamics, at_rest=(0.0, 1.0, 0.0)))
    (onset,) = (
        row.wind_speed_m_per_s
        for row in result(cubic, CUBIC).critical_wind_speeds
        if row.direction == "vertical" and row.crossing == "onset"
    )
    winds = tuple(onset * share for share in ABOVE_ONSET)
    expected = _stable_sizes(cubic, replace(CUBIC, wind_speeds=winds))
    found = [_stable_sizes(_with(twin, tabulated_every(step)), replace(TABLE, wind_speeds=winds)) for step in STEPS]
    for i, (share, speed) in enumerate(zip(ABOVE_ONSET, winds, strict=True)):
        differences = [percent(sizes[i], expected[i]) for sizes in found]
        yield [f"{share:g}", f"{speed:.3f}", f"{expected[i]:.5f}", *differences]


def _with(line: Line, aerodynamics: Aerodynamics) -> Line:
    return replace(line, ice=replace(line.ice, aerodynamics=aerodynamics))


def tabulated_every(step_deg: float) -> Aerodynamics:
    """Return the synthetic coefficients at equal steps over the circle."""
    angle = np.radians(np.linspace(-180.0, 180.0, round(360.0 / step_deg) + 1))
    lift, drag, moment = (tuple(series(name, angle)[0].tolist()) for name in ("cl", "cd", "cm"))
    return fit_measured(MeasuredCoefficients(tuple(angle.tolist()), lift, drag, moment, 0.0, np.radians(20.0)))


def _stable_sizes(line: Line, analysis: Analysis) -> list[float]:
    rows = [row for row in result(line, analysis).limit_cycles if row.stability is Stability.STABLE]
    return [_largest(rows, speed) for speed in analysis.wind_speeds]


def _largest(rows: list[LimitCycleRow], speed: float) -> float:
    return max(row.vertical_m or 0.0 for row in rows if row.wind_speed_m_per_s == speed)
