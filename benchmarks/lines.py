"""The source's lines, and random lines for measurements."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from engine.spec import (
    Aerodynamics,
    Analysis,
    Bundle,
    Coefficients,
    Conductor,
    Damping,
    Ice,
    Line,
    Physics,
    PhysicsRequest,
    Span,
    StaticTwist,
    Wind,
    with_physics,
    with_section,
)

AXIAL_RIGIDITY = 4.78033e10 * 594.48e-6  # theory section 9: E times the iced area
C11_AT_40_DEG = Aerodynamics((-0.1667, -4.0547, 8.3581), (0.8605, 0.8325, 1.7815), (-0.7272, 0.2935, 5.9704))
AT_REST = (0.0, 1.0, 0.0)  # assumed: the source gives no coefficients at rest, and a cylinder has these
ORIENTATION_DEG = {1: 0.0, 2: 90.0, 3: 0.0, 4: 45.0}


def source_line(subconductors: int, *, torsional_ratio: float = 0.308) -> Line:
    """Return the line of the source's Table 1 with one to four sub-conductors (theory section 10)."""
    radius = 0.0 if subconductors == 1 else 0.2355
    return Line(
        conductor=Conductor(0.0286, AXIAL_RIGIDITY, 101.0, 2.379, 3.334e-4),
        bundle=Bundle.regular(subconductors, radius, math.radians(ORIENTATION_DEG[subconductors])),
        span=Span(125.88, horizontal_tension=30_000.0),
        ice=Ice(C11_AT_40_DEG, 2.05e-3, -0.63e-3),
        wind=Wind(1.2929),
        damping=Damping(0.000515, 0.000515, torsional_ratio),
    )


def random_line(generator: np.random.Generator) -> Line:
    """Draw a plausible line: the source's conductor and ice, varied by 20 to 50 %, on a span of 80 to 300 m."""

    def about(value: float, spread: float) -> float:
        return value * float(generator.uniform(1.0 - spread, 1.0 + spread))

    def row(values: Coefficients) -> Coefficients:
        first, second, third = values
        return about(first, 0.2), about(second, 0.2), about(third, 0.2)

    subconductors = int(generator.integers(2, 5))
    mass = about(2.379, 0.2)
    source = C11_AT_40_DEG
    ice = Aerodynamics(row(source.vertical), row(source.horizontal), row(source.torsional))
    return Line(
        conductor=Conductor(
            about(0.0286, 0.2), about(AXIAL_RIGIDITY, 0.3), about(101.0, 0.4), mass, about(3.334e-4, 0.2)
        ),
        bundle=Bundle.regular(subconductors, about(0.2355, 0.2), float(generator.uniform(0.0, math.pi))),
        span=Span(float(generator.uniform(80.0, 300.0)), catenary_parameter=float(generator.uniform(900.0, 1800.0))),
        ice=Ice(ice, about(2.05e-3, 0.5), about(-0.63e-3, 0.5)),
        wind=Wind(1.2929),
        damping=Damping(about(0.000515, 0.5), about(0.000515, 0.5), float(generator.uniform(0.05, 0.35))),
    )


def under_full_physics(lines: Sequence[Line], analysis: Analysis) -> tuple[list[Line], Analysis]:
    """Return the lines with coefficients at rest, and the analysis under full physics as they hang, without twist."""
    iced = [
        replace(line, ice=replace(line.ice, aerodynamics=replace(line.ice.aerodynamics, at_rest=AT_REST)))
        for line in lines
    ]
    free = [with_section(line, Physics.FULL) for line in iced]
    return free, with_physics(free[0], analysis, PhysicsRequest(Physics.FULL, static_twist=StaticTwist.NEGLECTED))
