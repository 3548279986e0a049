"""Lines, discretizations and models for the tests of the engine; the lines are those of theory section 10."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine.analysis import analyse
from engine.arrays import FloatArray
from engine.mechanics.modes import directional_shapes, full_modes
from engine.models.aerodynamic_load import polynomial_load
from engine.models.discretization import Discretization, discretize
from engine.models.finite_element import finite_element_model
from engine.models.hybrid import hybrid_model, with_published_load
from engine.models.reduced_model import ReducedModel, take
from engine.progress import finished
from engine.result import LimitCycleRow, Result
from engine.spec import (
    Aerodynamics,
    Analysis,
    Bundle,
    Conductor,
    Damping,
    Ice,
    InterphaseSpacer,
    Line,
    Model,
    Phase,
    Section,
    SectionSpan,
    Span,
    Support,
    Supports,
    SuspensionString,
    Wind,
)

AXIAL_RIGIDITY = 4.78033e10 * 594.48e-6  # theory section 9: E times the iced area
RADIUS = 0.2355
ORIENTATION_DEG = {1: 0.0, 2: 90.0, 3: 0.0, 4: 45.0}
ICE_AT_40 = Aerodynamics((-0.1667, -4.0547, 8.3581), (0.8605, 0.8325, 1.7815), (-0.7272, 0.2935, 5.9704))
ICE_AT_270 = Aerodynamics((0.9423, -0.9245, 2.6352), (1.3186, -3.2000, -13.0623), (-0.8567, 0.9026, -0.2353))
ECCENTRICITY = (2.05e-3, -0.63e-3)


def source_line(subconductors: int, *, torsional_ratio: float = 0.308) -> Line:
    """Return the source's Table 1 line with the ice at 40 degrees."""
    radius = 0.0 if subconductors == 1 else RADIUS
    return Line(
        conductor=Conductor(0.0286, AXIAL_RIGIDITY, 101.0, 2.379, 3.334e-4),
        bundle=Bundle.regular(subconductors, radius, math.radians(ORIENTATION_DEG[subconductors])),
        span=Span(125.88, horizontal_tension=30_000.0),
        ice=Ice(ICE_AT_40, *ECCENTRICITY),
        wind=Wind(1.2929),
        damping=Damping(0.000515, 0.000515, torsional_ratio),
    )


def source_line_at_270(subconductors: int) -> Line:
    """Return the source's line with the ice at 270 degrees: the mass centre turns with it by 230 degrees."""
    turn = math.radians(230.0)
    e_y, e_z = ECCENTRICITY
    turned = (e_y * math.cos(turn) - e_z * math.sin(turn), e_y * math.sin(turn) + e_z * math.cos(turn))
    return replace(source_line(subconductors), ice=Ice(ICE_AT_270, *turned))


def tight_line(*, sag_ratio: float, rigidity_ratio: float, elements: int) -> Line:
    """Return a dead-ended single conductor without ice's offset: sag/L_x and EA/H are given, all else is plain."""
    length, tension = 100.0, 20_000.0
    sag = sag_ratio * length
    line = source_line(1)
    mass = tension * 8.0 * sag / (9.81 * length**2)
    dead_end = Support(dead_end=True)
    return replace(
        line,
        conductor=Conductor(0.03, rigidity_ratio * tension, 400.0, mass, 1e-3),
        span=Span(length, horizontal_tension=tension, elements=elements),
        supports=Supports(left=dead_end, right=dead_end),
        ice=Ice(Aerodynamics((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))),
    )


def discretized(*lines: Line) -> Discretization:
    """Make profile, sections and matrices of lines."""
    return discretize(lines)


def hybrid(line: Line, loops: int = 1, analysis: Analysis | None = None) -> ReducedModel:
    """Return the hybrid model of one line and number of loops, with a leading axis of length 1."""
    discretization = discretized(line)
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, tuple(sorted({1, loops})))
    return take(hybrid_model(discretization, shapes, (loops,), analysis or Analysis()), 0)


def published(line: Line, loops: int = 1) -> ReducedModel:
    """Return the hybrid model of one line under the published closure, with a leading axis of length 1."""
    discretization = discretized(line)
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, tuple(sorted({1, loops})))
    return take(with_published_load(discretization, hybrid_model(discretization, shapes, (loops,), Analysis())), 0)


def finite_element(line: Line, loops: tuple[int, ...] = (1, 2, 3), analysis: Analysis | None = None) -> ReducedModel:
    """Return the finite element model of one line, with a leading axis of length 1."""
    discretization = discretized(line)
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, tuple(sorted({1, *loops})))
    return finite_element_model(
        discretization, full_modes(discretization.matrices, loops), shapes, analysis or Analysis()
    )


def run(line: Line, analysis: Analysis) -> Result:
    """Analyse a line and drop the progress."""
    return finished(analyse(line, analysis))


def only(model: Model, **changes: object) -> Analysis:
    """Return an analysis with one model."""
    return replace(Analysis(), models=(model,), **changes)  # type: ignore[arg-type]


def stable_cycles(result: Result, *, loops: int, wind_speed: float, model: Model = Model.HYBRID) -> list[LimitCycleRow]:
    """Pick the rows of stable cycles."""
    return [
        row
        for row in result.limit_cycles
        if (row.model, row.loops, row.wind_speed_m_per_s) == (model, loops, wind_speed)
        and row.kind == "periodic"
        and row.stability == "stable"
    ]


@dataclass(frozen=True, slots=True)
class Oscillators:
    """M, C, K (m, m) and the terms of the load divided by U^2: (output, factors among q and q'/U) -> coefficient."""

    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    terms: dict[tuple[int, tuple[int, ...]], float]


def hand_made(system: Oscillators, copies: int = 1) -> ReducedModel:
    """Make a reduced model of hand-written equations; the key (0, (0, 0, 1)) is the term x_0 x_0 x_1 of output 0."""
    m = len(system.mass)
    keys = sorted_products(2 * m)
    table = np.zeros((copies, 1, m, len(keys)))
    for (output, product), value in system.terms.items():
        table[:, 0, output, keys.index(tuple(sorted(product)))] = value
    forms = np.broadcast_to(np.eye(2 * m), (copies, 1, 2 * m, 2 * m))

    def spread(matrix: FloatArray) -> FloatArray:
        return np.broadcast_to(matrix, (copies, m, m))

    return ReducedModel(
        mass=spread(system.mass),
        damping=spread(system.damping),
        stiffness=spread(system.stiffness),
        load=polynomial_load(forms, table, 0.1 * forms[:, 0]),
        shapes=np.zeros((copies, m, 3, 3)),
        direction=np.arange(m) % 3,
        statically_unstable=np.zeros(copies, dtype=np.bool_),
    )


def sorted_products(variables: int) -> list[tuple[int, ...]]:
    """List the index products of degree 1 to 3 in the order that the polynomial tables document."""
    span = range(variables)
    pairs = [(i, j) for i in span for j in span if i <= j]
    triples = [(i, j, k) for i in span for j in span for k in span if i <= j <= k]
    return [*((i,) for i in span), *pairs, *triples]


def about(generator: np.random.Generator, values: Sequence[float], spread: float) -> list[float]:
    """Vary each value by a uniform factor from 1 - spread to 1 + spread."""
    return [float(v * generator.uniform(1.0 - spread, 1.0 + spread)) for v in values]


def deep(sag: float, dead_end: bool) -> Line:
    """Return a line of this sag; with dead ends lam2 = (8 sag/L)^2 EA/H passes 4 pi^2 near 2.5 m."""
    end = Support(dead_end=dead_end)
    return replace(source_line(1), span=Span(125.88, sag=sag), supports=Supports(left=end, right=end))


def random_line(generator: np.random.Generator) -> Line:
    """Draw a bundle or a single conductor around the source's line, all of its numbers changed by tens of percent."""
    n = int(generator.integers(1, 5))
    radius = 0.0 if n == 1 else float(generator.uniform(0.15, 0.35))
    conductor = about(generator, (0.0286, AXIAL_RIGIDITY, 101.0, 2.379, 3.6e-4), 0.25)
    a, b, c = (about(generator, row, 0.4) for row in (ICE_AT_40.vertical, ICE_AT_40.horizontal, ICE_AT_40.torsional))
    e_y, e_z = about(generator, ECCENTRICITY, 0.5)
    damping = generator.uniform((2e-4, 2e-4, 0.02), (3e-3, 3e-3, 0.35)).tolist()
    return Line(
        conductor=Conductor(*conductor),
        bundle=Bundle.regular(n, radius, float(generator.uniform(0.0, 6.0))),
        span=Span(float(generator.uniform(80.0, 140.0)), horizontal_tension=float(generator.uniform(2.2e4, 4e4))),
        ice=Ice(Aerodynamics((a[0], a[1], a[2]), (b[0], b[1], b[2]), (c[0], c[1], c[2])), e_y, e_z),
        wind=Wind(float(generator.uniform(1.0, 1.4))),
        damping=Damping(*damping),
    )


def lightly_damped_line(generator: np.random.Generator) -> Line:
    """Draw a line as `random_line` does, with 0.3 to 5 % of torsional damping; half of them are single conductors."""
    line = random_line(generator)
    ratio = float(np.exp(generator.uniform(np.log(0.003), np.log(0.05))))
    bundle = Bundle.regular(1, 0.0, 0.0) if generator.random() < 0.5 else line.bundle
    return replace(line, bundle=bundle, damping=replace(line.damping, torsional_ratio=ratio))


FIVE_SPANS = (350.0,) * 5
THREE_SPANS = (280.0, 300.0, 330.0)


FIVE_STRINGS = SuspensionString(4.5, 2500.0)
STIFF_STRINGS = SuspensionString(1e-8, 2500.0)


def phases_line(*spacers: InterphaseSpacer, subconductors: int = 2, above: Phase | None = None) -> Line:
    """Return the source's line with a phase "top" 7 m above it, unless another one is given, and spacers."""
    line = source_line(subconductors)
    return replace(line, phases=(above or Phase("top", 7.0, 0.0),), devices=spacers)


def section_line(
    lengths: tuple[float, ...] = FIVE_SPANS,
    *,
    subconductors: int = 1,
    interest: int = 1,
    elements: int = 10,
    string: SuspensionString | None = None,
) -> Line:
    """Return one of the two sections of theory section 16: five equal spans, else three with their shorter strings."""
    line = source_line(subconductors)
    tension, own = (40e3, FIVE_STRINGS) if len(lengths) == 5 else (30e3, SuspensionString(2.4, 600.0))
    string = string or own
    return replace(
        line,
        span=Span(lengths[interest - 1], horizontal_tension=tension, elements=elements),
        section=Section(tuple(SectionSpan(x) for x in lengths), (string,) * (len(lengths) - 1), interest),
    )
