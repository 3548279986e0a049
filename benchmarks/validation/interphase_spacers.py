"""Phases that spacers tie: frequencies beside OpenSees, cycles beside two spans with a spring, and what spacers do."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from benchmarks.coupled_spans import Spring, middle_motion
from benchmarks.lines import source_line
from benchmarks.opensees import Conductor, Section
from benchmarks.opensees_phases import NEARLY_RIGID, HungPhase, Truss, tied_frequencies
from benchmarks.validation.common import percent, result, table
from engine.assemblies.assembly import natural_motions
from engine.assemblies.phases import assembled_phases
from engine.mechanics.finite_elements import U, V, W
from engine.result import LimitCycleRow, Result
from engine.spec import Analysis, Ice, InterphaseSpacer, Line, Model, Phase, Span, Support, Supports

LENGTH, MODES, MIDDLE = 125.88, 16, 62.94
ONE_LOOP = Analysis(loops=(1,), finite_element_loops=(1,), wind_speeds=(8.0,), models=(Model.FINITE_ELEMENT,))
SPRING = Spring(50.0, (0.6, 0.8), 2e3)
RIGID = InterphaseSpacer(MIDDLE, 20.0, ("this", "top"))
Hung = tuple[float, float, tuple[float, float]]  # tension [N], mass [kg/m], place (y, z) [m]
SPAN: Hung = (30e3, 2.379, (0.0, 0.0))
CASES: tuple[tuple[str, tuple[Hung, ...], tuple[Truss, ...]], ...] = (
    ("two equal ones, 7 m apart, rigid", (SPAN, (30e3, 2.379, (7.0, 0.0))), (Truss(MIDDLE, (0, 1), mass=20.0),)),
    ("two unequal ones, oblique, rigid", (SPAN, (27e3, 2.6, (5.0, 4.0))), (Truss(MIDDLE, (0, 1), mass=20.0),)),
    (
        "three, one spacer of 2 kN/m and one rigid",
        (SPAN, (30e3, 2.379, (5.0, 4.0)), (30e3, 2.379, (10.0, 0.0))),
        (Truss(MIDDLE, (0, 1), 2e3, 15.0), Truss(MIDDLE, (1, 2), mass=20.0)),
    ),
)


def section() -> Iterator[str]:
    """Yield the section's text."""
    yield "## Phases tied by interphase spacers\n"
    yield (
        f"The lowest {MODES} natural frequencies of tied phases, single conductors between dead ends with centred ice, "
        "beside OpenSees (160 bars a phase, truss bars between them; 1 GN/m stands for rigid). Hz.\n"
    )
    head = ["phases", "lowest", "OpenSees", f"highest of {MODES}", "OpenSees", "largest difference %"]
    yield table(head, [_frequencies(*case) for case in CASES])
    yield (
        "\nA twin and a phase 3 m above and 4 m beside it whose ice does not gallop (a_y1 = 0.2), tied by 2 kN/m at "
        "50 m, at 8 m/s: the cycle of the finite element model, and two single spans with a spring between them, "
        "integrated in time (benchmarks/coupled_spans.py). The modes of single spans approach the kink at the spring "
        "slowly. Amplitudes in the middle, m.\n"
    )
    yield table(["", "this", "the other"], list(_cycles()))
    yield (
        "\nWhat a spacer in the middle, 7 m up to a phase with the ice named, does to the source's twin at 8 m/s (one "
        "loop; the modes of larger numbers of loops are left out, with nodes at the spacer or near it):\n"
    )
    yield table(
        ["ice of the other phase", "spacer", "onset m/s", "vertical m", "smallest distance m"], list(_effects())
    )


def _frequencies(name: str, hung: tuple[Hung, ...], trusses: tuple[Truss, ...]) -> list[object]:
    lines = [_bare(tension, mass) for tension, mass, _ in hung]
    names = ["this", *(str(i) for i in range(1, len(hung)))]
    others = tuple(Phase(names[i], *hung[i][2], line=lines[i]) for i in range(1, len(hung)))
    spacers = tuple(
        InterphaseSpacer(
            t.position,
            t.mass,
            (names[t.between[0]], names[t.between[1]]),
            None if t.stiffness == NEARLY_RIGID else t.stiffness,
        )
        for t in trusses
    )
    whole = assembled_phases(replace(lines[0], phases=others, devices=spacers))
    found = np.sqrt(natural_motions(whole.assembly, (U, V, W))[0][:MODES]) / (2.0 * np.pi)
    rigidity = lines[0].conductor.axial_rigidity
    phases = [HungPhase(Conductor(rigidity, mass, tension), place) for tension, mass, place in hung]
    expected = np.array(tied_frequencies(phases, Section((LENGTH,)), trusses, MODES))
    worst = int(np.abs(found / expected - 1.0).argmax())
    shown = [f"{value:.4f}" for value in (found[0], expected[0], found[-1], expected[-1])]
    return [name, *shown, percent(float(found[worst]), float(expected[worst]))]


def _bare(tension: float, mass: float) -> Line:
    line, dead_end = source_line(1), Support(dead_end=True)
    return replace(
        line,
        conductor=replace(line.conductor, mass=mass),
        ice=Ice(line.ice.aerodynamics),
        span=Span(LENGTH, horizontal_tension=tension, elements=20),
        supports=Supports(left=dead_end, right=dead_end),
    )


def _calm(slope: float) -> Ice:
    ice = source_line(2).ice
    return replace(ice, aerodynamics=replace(ice.aerodynamics, vertical=(slope, *ice.aerodynamics.vertical[1:])))


def _cycles() -> Iterator[list[object]]:
    ice = _calm(0.2)
    spacer = InterphaseSpacer(SPRING.position, 0.0, ("this", "top"), SPRING.stiffness)
    line = replace(source_line(2), phases=(Phase("top", 3.0, 4.0, ice=ice),), devices=(spacer,))
    row = _largest(result(line, ONE_LOOP))
    yield ["finite element model, one loop of each phase", f"{row.vertical_m:.3f}", ""]
    for loops in (3, 5, 7, 9):
        spans = source_line(2), replace(source_line(2), ice=ice)
        series, _ = middle_motion(spans, SPRING, loops, 8.0, ((1.15, -1.15), 700.0))
        own, other = (0.5 * np.ptp(series, axis=0)).tolist()
        yield [f"integrated, {loops} loops of each span", f"{own:.3f}", f"{other:.3f}"]


def _largest(found: Result) -> LimitCycleRow:
    stable = [row for row in found.limit_cycles if row.stability == "stable" and row.kind == "periodic"]
    return max(stable, key=lambda row: row.vertical_m or 0.0)


def _effects() -> Iterator[list[object]]:
    alone = result(source_line(2), ONE_LOOP)
    yield ["", "none", _onset(alone), f"{_largest(alone).vertical_m:.3f}", ""]
    kinds: tuple[tuple[str, Ice | None], ...] = (
        ("the same", None),
        ("a_y1 = 0.05", _calm(0.05)),
        ("a_y1 = 0.1", _calm(0.1)),
        ("a_y1 = 0.3", _calm(0.3)),
    )
    for name, ice in kinds:
        for stiffness in (500.0, None):
            spacer = replace(RIGID, axial_stiffness=stiffness)
            line = replace(source_line(2), phases=(Phase("top", 7.0, 0.0, ice=ice),), devices=(spacer,))
            found = result(line, ONE_LOOP)
            text = "rigid" if stiffness is None else "500 N/m"
            stable = any(row.stability == "stable" and row.kind == "periodic" for row in found.limit_cycles)
            amplitude = f"{_largest(found).vertical_m:.3f}" if stable else "rests"
            near = found.verdict[0].clearance_m
            yield [name, text, _onset(found), amplitude, "" if near is None else f"{near:.2f}"]


def _onset(found: Result) -> str:
    winds = [row.wind_speed_m_per_s for row in found.critical_wind_speeds]
    return f"{min(winds):.2f}" if winds else "none up to 30"
