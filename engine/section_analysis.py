"""The order of the steps of the analysis of one section of several spans. Theory section 16."""

from collections.abc import Generator, Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray, IntArray, merge_axes
from engine.assemblies.assembled_finite_element import assembled_finite_element, modes_together
from engine.assemblies.assembled_hybrid import assembled_hybrid, assembled_published_load, groups_of
from engine.assemblies.assembled_line import AssembledLine, assembled_section
from engine.assemblies.assembly import by_member
from engine.assemblies.hybrid_shapes import HybridShapes, hybrid_shapes
from engine.assemblies.numbered_modes import NumberedModes, all_modes, directional_modes
from engine.cycles.harmonic_balance import Orbits, resized
from engine.cycles.known_cycles import Starts, stacked
from engine.cycles.starts import explicit_starts
from engine.mechanics.finite_elements import V
from engine.model_findings import ModelStack, findings_of
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel, take
from engine.progress import Progress
from engine.report.findings import ModelFindings
from engine.report.frequencies import NaturalFrequencies, coupled_frequencies
from engine.report.sections.section_modes import section_mode_rows
from engine.report.sections.section_results import SectionFindings, section_result
from engine.result import Result, SectionModeRow
from engine.spec import Analysis, Line, Model

VERTICAL, HORIZONTAL, TORSIONAL = range(3)


@dataclass(frozen=True, slots=True)
class _Part:
    """What one model gave: rows of its modes, frequencies, and findings of its groups."""

    modes: list[SectionModeRow]
    frequencies: list[NaturalFrequencies]
    findings: list[ModelFindings]


def analyse_section(line: Line, analysis: Analysis) -> Generator[Progress, None, Result]:
    """Analyse a line that is a section.

    Raises
    ------
    InvalidSpec
        If the spans do not fit together, or have fewer modes than are asked for.
    """
    yield Progress(0.0, "static state and modes of the section")
    whole = assembled_section(line, analysis.static_twist)
    directional = [directional_modes(whole.assembly, direction) for direction in range(3)]
    shapes = hybrid_shapes(whole, tuple(sorted(analysis.loops)), analysis)
    yield Progress(0.1, "critical wind speeds and limit cycles of the hybrid model")
    hybrid = _hybrid(whole, shapes, directional, analysis)
    parts = [hybrid] if Model.HYBRID in analysis.models else []
    if Model.FINITE_ELEMENT in analysis.models:
        yield Progress(0.4, "critical wind speeds and limit cycles of the finite element model")
        parts.append(_finite_element(whole, hybrid.findings, analysis))
    yield Progress(0.95, "result rows")
    first = directional[VERTICAL]
    lowest = float(first.squares[first.place(VERTICAL, 1)])
    found = SectionFindings(
        whole,
        [row for part in parts for row in part.modes],
        [table for part in parts for table in part.frequencies],
        [one for part in parts for one in part.findings],
        float(np.sqrt(max(lowest, 0.0)) / (2.0 * np.pi)) or float("inf"),
    )
    result = section_result(found, analysis)
    yield Progress(1.0, "done")
    return result


def _winds(analysis: Analysis) -> FloatArray:
    return np.array(sorted(set(analysis.wind_speeds)), dtype=np.float64)


def _hybrid(
    whole: AssembledLine, shapes: HybridShapes, directional: Sequence[NumberedModes], analysis: Analysis
) -> _Part:
    """Analyse the hybrid models of all vertical modes asked for, those of equally many coordinates as one stack."""
    numbers = sorted(analysis.loops)
    rows = [
        row
        for direction, modes in enumerate(directional)
        for row in section_mode_rows(whole, Model.HYBRID, modes, numbers)
        if row.direction == ("vertical", "horizontal", "torsional")[direction]
    ]
    findings, frequencies = [], []
    for group in groups_of(shapes):
        grid = assembled_hybrid(whole, shapes, group, analysis)
        model, published = (
            take(each, (0, np.arange(len(group)))) for each in (grid, assembled_published_load(whole, grid))
        )
        line = np.zeros(len(group), dtype=np.intp)
        loops = np.array(group)[:, None] * np.ones(model.mass.shape[-1], dtype=np.intp)
        crossings = critical_wind_speeds(model, analysis.critical_wind_limit)
        winds = _winds(analysis)
        starts = explicit_starts(published, model, winds, analysis.harmonics)
        stack = ModelStack(Model.HYBRID, model, line, loops, crossings)
        findings.append(findings_of(stack, winds, starts, analysis))
        squares = coupled_frequencies(findings[-1]).squared_frequency[:, :3].copy()
        for direction in (HORIZONTAL, TORSIONAL):
            squares[:, direction] = _squares(directional[direction], direction, group)
        frequencies.append(NaturalFrequencies(Model.HYBRID, line, loops[:, :3], squares))
    return _Part(rows, frequencies, findings)


def _finite_element(whole: AssembledLine, hybrid: Sequence[ModelFindings], analysis: Analysis) -> _Part:
    """Analyse the finite element model, also starting from the cycles of the hybrid models."""
    numbers = tuple(sorted({*analysis.loops, *analysis.finite_element_loops}))
    modes = all_modes(whole.assembly)
    rows = section_mode_rows(whole, Model.FINITE_ELEMENT, modes, numbers)
    squares = np.stack([_squares(modes, direction, analysis.loops) for direction in range(3)])
    one_line = np.zeros(1, dtype=np.intp)
    loops = np.tile(np.array(analysis.loops, dtype=np.intp), 3)[None]
    frequencies = [NaturalFrequencies(Model.FINITE_ELEMENT, one_line, loops, squares.reshape(1, -1))]
    if not analysis.finite_element_loops:
        return _Part(rows, frequencies, [])
    chosen = modes_together(whole, modes, numbers)
    model = assembled_finite_element(whole, modes, chosen, analysis)
    crossings = critical_wind_speeds(model, analysis.critical_wind_limit)
    starts = stacked([_cycles_in_modes(whole, modes, chosen, part, model) for part in hybrid])
    stack = ModelStack(Model.FINITE_ELEMENT, model, one_line, modes.number[chosen][None], crossings)
    return _Part(rows, frequencies, [findings_of(stack, _winds(analysis), starts, analysis)])


def _squares(modes: NumberedModes, direction: int, numbers: Sequence[int]) -> FloatArray:
    """Return the squared frequencies of the modes of a direction with these numbers: (numbers,)."""
    return np.array([modes.squares[modes.place(direction, k)] for k in numbers])


def _cycles_in_modes(
    whole: AssembledLine, modes: NumberedModes, chosen: IntArray, hybrid: ModelFindings, model: ReducedModel
) -> Starts:
    """Project the hybrid cycles onto the modes of the finite element model, weighted with the mass."""
    cycles = hybrid.cycles
    usable = np.full(cycles.member.size, not model.statically_unstable[0])
    member = cycles.member[usable]
    momentum = by_member(modes.displacement[chosen] @ whole.assembly.mass, whole.assembly.members)[..., V:, :]
    across = merge_axes(np.moveaxis(momentum, 0, -2), -3)  # (modes, fields with all nodes)
    projection = across @ merge_axes(hybrid.model.shapes[member], -2).swapaxes(-1, -2)
    orbits = Orbits(
        projection @ cycles.orbits.coefficients[usable],
        cycles.orbits.angular_frequency[usable],
        cycles.orbits.wind_speed[usable],
    )
    harmonics = (cycles.orbits.coefficients.shape[-1] - 1) // 2
    return Starts(np.zeros(member.size, dtype=np.intp), cycles.wind[usable], resized(orbits, harmonics))
