"""The order of the steps of an analysis, and nothing else: lines and an analysis in, progress and results out."""

from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from engine.arrays import FloatArray, IntArray, merge_axes, placed
from engine.cycles.harmonic_balance import Orbits, resized
from engine.cycles.known_cycles import Starts, stacked
from engine.cycles.search import Cycles
from engine.cycles.starts import explicit_starts
from engine.each_wind import analyse_lines
from engine.mechanics.coupled_eigenvalues import full_eigenvalues
from engine.mechanics.cross_sections import FEWER_POINTS, PIECE_POINTS
from engine.mechanics.finite_elements import FIELDS
from engine.mechanics.modes import DirectionalShapes, FullModes, directional_shapes, full_modes
from engine.model_findings import ModelStack, findings_of
from engine.models.critical_wind_speeds import Crossings, critical_wind_speeds
from engine.models.discretization import (
    Discretization,
    blocks_of_winds,
    discretize,
    fields_in_space,
    in_wind,
    shapes_in_wind,
    with_wind_twist,
)
from engine.models.finite_element import finite_element_model
from engine.models.hybrid import hybrid_model, joint_model, loop_groups, with_published_load
from engine.models.reduced_model import ReducedModel, take
from engine.models.scanned_wind_speeds import ModelOf, Scan, crossings_in_wind, scan_of
from engine.outcome import Fault, InvalidSpec
from engine.phases_analysis import analyse_phases
from engine.progress import Progress
from engine.report.comparisons.device_effects import device_effects
from engine.report.comparisons.loop_competitions import loop_competitions
from engine.report.findings import ModelFindings
from engine.report.frequencies import NaturalFrequencies, coupled_frequencies, full_frequencies
from engine.report.line_results import line_results
from engine.result import LoopCompetitionRow, Result
from engine.section_analysis import analyse_section
from engine.spec import Analysis, DeviceEffect, Line, LoopCompetition, Model, StaticTwist, check_compatible


@dataclass(frozen=True, slots=True)
class _Discretized:
    """What every later step reads: the discretization, its shapes and, where their motions are asked for, full modes.

    winds: (lines, winds), at which the motions of each are searched [m/s]; scan: static states over the wind speed,
    where these follow it.
    """

    discretization: Discretization
    shapes: DirectionalShapes
    modes: FullModes | None
    winds: FloatArray
    scan: Scan | None = None


def analyse(line: Line, analysis: Analysis) -> Generator[Progress, None, Result]:
    """Analyse one line.

    Parameters
    ----------
    line : Line
    analysis : Analysis

    Yields
    ------
    Progress

    Returns
    -------
    Result

    Raises
    ------
    InvalidSpec
        If the line cannot answer the analysis, see `engine.spec.check_compatible`.
    """
    results = yield from analyse_stack((line,), analysis)
    return results[0]


def analyse_stack(lines: Sequence[Line], analysis: Analysis) -> Generator[Progress, None, list[Result]]:
    """Analyse lines with equal numbers of elements side by side; as `analyse`, with one result per line.

    Raises
    ------
    InvalidSpec
        If a line cannot answer the analysis, or the lines differ in their number of elements.
    """
    for line in lines:
        check_compatible(line, analysis)
    if len({line.span.elements for line in lines}) != 1:
        raise InvalidSpec(Fault("span.elements", None, "must be equal within a stack of lines"))
    if analysis.device_effect is DeviceEffect.NEGLECTED:
        return (yield from analyse_lines(lines, analysis, _analyse))
    bare = [replace(line, devices=()) for line in lines if line.devices]
    results = yield from analyse_lines([*lines, *bare], analysis, _analyse)
    own, without = results[: len(lines)], placed(results[len(lines) :], [bool(line.devices) for line in lines])
    pairs = zip(own, without, strict=True)
    return [replace(one, device_effects=device_effects(other or one, one)) for one, other in pairs]


def _analyse(lines: Sequence[Line], analysis: Analysis) -> Generator[Progress, None, list[Result]]:
    """Analyse lines, each in its one static state: single spans as one stack, every assembly by itself."""
    spans = [line for line in lines if _is_single_span(line)]
    together = (yield from _analyse_spans(spans, analysis)) if spans else []
    results = []
    for line, result in zip(lines, placed(together, [_is_single_span(line) for line in lines]), strict=True):
        if result is not None:
            results.append(result)
        else:
            alone = analyse_phases if line.section is None else analyse_section
            results.append((yield from alone(line, analysis)))
    return results


def _is_single_span(line: Line) -> bool:
    return line.section is None and not line.interphase_spacers


def _analyse_spans(lines: Sequence[Line], analysis: Analysis) -> Generator[Progress, None, list[Result]]:
    yield Progress(0.0, "static state and modes")
    prepared = _discretized(lines, analysis)
    parts = _in_each_wind(prepared, analysis) if analysis.follows_twist else [prepared]
    found: list[list[ModelFindings]] = []
    frequencies: list[NaturalFrequencies] = []
    competitions: list[list[LoopCompetitionRow]] = [[] for _ in lines]
    for number, here in enumerate(parts):
        yield Progress(0.1 + 0.8 * number / len(parts), "critical wind speeds and limit cycles of the hybrid model")
        hybrid = [_analyse_hybrid(here, group, analysis) for group in loop_groups(analysis.loops, analysis)]
        found.append(list(hybrid) if Model.HYBRID in analysis.models else [])
        if here.modes is not None:
            found[-1].append((yield from _analyse_finite_element(here, here.modes, hybrid, analysis)))
        frequencies = frequencies or _frequencies(here, hybrid, analysis)
        for state, rows in enumerate(_competitions(here, hybrid, analysis)):
            competitions[state % len(lines)] += rows
    yield Progress(0.95, "result rows")
    # Model by model with rising wind speeds, however many of these make a part; states are numbered wind by wind.
    findings = tuple(replace(one, line=one.line % len(lines)) for alike in zip(*found, strict=True) for one in alike)
    about = _with_smallest_range(prepared, parts) if analysis.follows_twist else prepared.discretization
    results = line_results(about, prepared.shapes, tuple(frequencies), findings, analysis, competitions)
    yield Progress(1.0, "done")
    return results


def _frequencies(
    prepared: _Discretized, hybrid: Sequence[ModelFindings], analysis: Analysis
) -> list[NaturalFrequencies]:
    frequencies = [coupled_frequencies(part) for part in hybrid] if Model.HYBRID in analysis.models else []
    if Model.FINITE_ELEMENT not in analysis.models:
        return frequencies
    loops, modes = _loops_of_modes(analysis), prepared.modes
    if modes is not None:
        return [*frequencies, full_frequencies(loops, modes.eigenvalues)]
    eigenvalues = full_eigenvalues(prepared.discretization.matrices, prepared.shapes, loops)
    return [*frequencies, full_frequencies(loops, eigenvalues)]


def _in_each_wind(prepared: _Discretized, analysis: Analysis) -> list[_Discretized]:
    """Return the states in still air with no wind speed, then those at all wind speeds, each with its own."""
    lines, winds = len(prepared.discretization.lines), _winds(analysis)
    parts = [replace(prepared, winds=np.zeros((lines, 0)))]
    for block in blocks_of_winds(lines, winds.size):
        here = in_wind(prepared.discretization, block)
        own = np.repeat(winds[block], lines)[:, None]
        parts.append(_Discretized(here, shapes_in_wind(here, prepared.shapes), _modes(here, analysis), own))
    return parts


def _with_smallest_range(prepared: _Discretized, parts: list[_Discretized]) -> Discretization:
    """Return the state in still air with the range of angles that the tables hold at every wind speed."""
    lines = len(prepared.discretization.lines)
    ranges = [here.discretization.sections.fitted_range.reshape(-1, lines) for here in parts[1:]]
    smallest = np.min(np.concatenate([np.full((1, lines), np.inf), *ranges]), axis=0)
    sections = replace(prepared.discretization.sections, fitted_range=smallest)
    return replace(prepared.discretization, sections=sections)


def _discretized(lines: Sequence[Line], analysis: Analysis) -> _Discretized:
    points = FEWER_POINTS if analysis.load_stands else PIECE_POINTS
    discretization = discretize(lines, analysis.static_twist, points)
    twisted = analysis.static_twist is not StaticTwist.NEGLECTED and any(line.has_table for line in lines)
    if twisted or analysis.follows_twist:
        discretization = with_wind_twist(discretization, _winds(analysis))
    finite_element = Model.FINITE_ELEMENT in analysis.models
    extra = set(analysis.finite_element_loops) if finite_element else set()
    loops = tuple(sorted({*analysis.loops, 1, 2} | extra))
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, loops)
    scan = scan_of(discretization, analysis.critical_wind_limit, shapes) if analysis.follows_twist else None
    winds = np.broadcast_to(_winds(analysis), (len(lines), len(set(analysis.wind_speeds))))
    return _Discretized(discretization, shapes, _modes(discretization, analysis), winds, scan)


def _modes(discretization: Discretization, analysis: Analysis) -> FullModes | None:
    asked = Model.FINITE_ELEMENT in analysis.models and analysis.finite_element_loops
    return full_modes(discretization.matrices, _loops_of_modes(analysis)) if asked else None


def _loops_of_modes(analysis: Analysis) -> tuple[int, ...]:
    return tuple(sorted({*analysis.loops, *analysis.finite_element_loops}))


def _winds(analysis: Analysis) -> FloatArray:
    return np.array(sorted(set(analysis.wind_speeds)), dtype=np.float64)


def _analyse_hybrid(prepared: _Discretized, loops: tuple[int, ...], analysis: Analysis) -> ModelFindings:
    """Analyse the hybrid model of every line and a group of numbers of loops as one stack, line-major."""
    grid = hybrid_model(prepared.discretization, prepared.shapes, loops, analysis)
    line = np.repeat(np.arange(len(prepared.discretization.lines)), len(loops))
    column = np.tile(np.arange(len(loops)), len(prepared.discretization.lines))
    model = take(grid, (line, column))
    published = take(with_published_load(prepared.discretization, grid), (line, column))
    winds = prepared.winds[line]
    starts = explicit_starts(published, model, winds, analysis.harmonics)

    def model_of(states: Discretization, shapes: DirectionalShapes, lines: IntArray) -> ReducedModel:
        own = hybrid_model(states, shapes, loops, analysis, whole=False)
        return take(own, (lines, np.resize(column, lines.size)))

    crossings = _crossings(prepared, model, line, analysis, model_of)
    loops_of = np.array(loops)[column][:, None] * np.ones(model.mass.shape[-1], dtype=np.intp)
    return findings_of(ModelStack(Model.HYBRID, model, line, loops_of, crossings), winds, starts, analysis)


def _analyse_finite_element(
    prepared: _Discretized, modes: FullModes, hybrid: Sequence[ModelFindings], analysis: Analysis
) -> Generator[Progress, None, ModelFindings]:
    """Analyse the finite element model of every line, also starting from the cycles of the hybrid models."""
    yield Progress(0.4, "critical wind speeds of the finite element model")
    model = finite_element_model(prepared.discretization, modes, prepared.shapes, analysis)

    def model_of(states: Discretization, shapes: DirectionalShapes, lines: IntArray) -> ReducedModel:
        own = full_modes(states.matrices, modes.loops)
        return take(finite_element_model(states, own, shapes, analysis, whole=False), lines)

    crossings = _crossings(prepared, model, np.arange(len(prepared.discretization.lines)), analysis, model_of)
    yield Progress(0.5, "limit cycles of the finite element model")
    starts = stacked(
        [_cycles_in_full_modes(prepared.discretization, modes, part, model, analysis.harmonics) for part in hybrid]
    )
    line, coordinates = np.arange(len(prepared.discretization.lines)), model.shapes.shape[:2]
    own = np.resize(modes.loops, coordinates[1])  # those of each direction; a relief coordinate is never the largest
    loops = np.broadcast_to(own, coordinates)
    stack = ModelStack(Model.FINITE_ELEMENT, model, line, loops, crossings)
    return findings_of(stack, prepared.winds, starts, analysis)


def _crossings(
    prepared: _Discretized,
    model: ReducedModel,
    line: IntArray,
    analysis: Analysis,
    model_of: ModelOf,
) -> Crossings:
    """Return the critical wind speeds of a stack of models: by a scan in still air where the twist follows the wind."""
    if prepared.scan is not None:
        return crossings_in_wind(prepared.scan, line, model_of)
    return critical_wind_speeds(model, analysis.critical_wind_limit)


def _competitions(
    prepared: _Discretized, hybrid: Sequence[ModelFindings], analysis: Analysis
) -> list[list[LoopCompetitionRow]]:
    """Check whether the stable cycles of the hybrid models survive motions of other loops, if asked for."""
    if analysis.loop_competition is LoopCompetition.NEGLECTED:
        return [[] for _ in prepared.discretization.lines]
    joint = joint_model(prepared.discretization, prepared.shapes, analysis.loops, analysis)
    tables = [loop_competitions(prepared.discretization, joint, part, analysis.loops) for part in hybrid]
    return [list(chain.from_iterable(rows)) for rows in zip(*tables, strict=True)]


def _cycles_in_full_modes(
    discretization: Discretization, modes: FullModes, hybrid: ModelFindings, model: ReducedModel, harmonics: int
) -> Starts:
    """Project the hybrid cycles onto the modes of the finite element model, weighted with the mass."""
    cycles: Cycles = hybrid.cycles
    usable = ~model.statically_unstable[hybrid.line[cycles.member]]
    member = cycles.member[usable]
    line = hybrid.line[member]
    vectors = modes.vectors.reshape(modes.vectors.shape[0], -1, modes.vectors.shape[-1])
    momentum = (vectors @ discretization.matrices.mass).reshape(*vectors.shape[:2], -1, FIELDS).swapaxes(-1, -2)
    transverse = fields_in_space(discretization.profile, momentum)[:, :, 1:]
    projection = merge_axes(transverse, -2)[line] @ merge_axes(hybrid.model.shapes[member], -2).swapaxes(-1, -2)
    shares = projection @ cycles.orbits.coefficients[usable]
    relief = model.mass.shape[-1] - shares.shape[-2]  # a coordinate of no shape, which starts at rest
    orbits = Orbits(
        np.pad(shares, ((0, 0), (0, relief), (0, 0))),
        cycles.orbits.angular_frequency[usable],
        cycles.orbits.wind_speed[usable],
    )
    return Starts(line, cycles.wind[usable], resized(orbits, harmonics))
