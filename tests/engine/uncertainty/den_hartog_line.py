"""A span whose onset is a formula: one conductor that only moves vertically, with three assumed values.

The wind feeds it rho d U (-a)/2 per velocity and the damping takes 2 zeta omega m, so U = 4 zeta omega m/(rho d (-a)).
"""

from collections.abc import Mapping
from dataclasses import replace
from functools import cache

from engine.spec import Aerodynamics, Analysis, Line, Model
from engine.uncertainty.inputs import Interval
from engine.uncertainty.weighing import Unknowns
from tests.builders import only, run, source_line

SLOPE, CUBIC = -0.9, 8.0
RATIO, DENSITY, FACTOR = "damping.vertical_ratio", "wind.air_density", "ice.aerodynamics.vertical_factor"
INPUTS = (
    Interval(RATIO, 0.004, 0.002, 0.02),
    Interval(DENSITY, 1.2929, 1.05, 1.4),
    Interval(FACTOR, 1.0, 0.7, 1.3),
)
WINDS = (2.0, 4.0, 8.0)
ASKED: Analysis = only(Model.HYBRID, loops=(1,), wind_speeds=WINDS)


def line_of(values: Mapping[str, float]) -> Line:
    """Return the span with other damping, air or slope."""
    factor = values.get(FACTOR, 1.0)
    line = source_line(1)
    still = (0.0, 0.0, 0.0)
    ice = replace(
        line.ice,
        aerodynamics=Aerodynamics((factor * SLOPE, 0.0, factor * CUBIC), still, still),
        eccentricity_y=0.0,
        eccentricity_z=0.0,
    )
    return replace(
        line,
        ice=ice,
        wind=replace(line.wind, air_density=values.get(DENSITY, 1.2929)),
        damping=replace(line.damping, vertical_ratio=values.get(RATIO, 0.004)),
    )


UNKNOWNS = Unknowns(INPUTS, line_of)


@cache
def constant() -> float:
    """Return 4 omega m/(d (-a)), with the frequency of the vertical mode: the onset is it times ratio over density."""
    line = line_of({})
    (row,) = run(line, ASKED).frequencies
    assert row.vertical_hz is not None
    omega = 2.0 * 3.141592653589793 * row.vertical_hz
    return 4.0 * omega * line.conductor.mass / (line.conductor.diameter * -SLOPE)


def onset(ratio: float, density: float, factor: float) -> float:
    """Return the onset [m/s]."""
    return constant() * ratio / (density * factor)
