"""The order of the steps, and nothing else: lines and an analysis in, progress and results out."""

from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import FloatArray, IntArray, merged
from engine.checks.confidence import confidence
from engine.checks.direct_starts import direct_starts
from engine.cycles.bifurcations import bifurcations
from engine.cycles.families import Starts
from engine.cycles.harmonic_balance import Orbits, resized
from engine.cycles.search import Cycles, explicit_starts, find_cycles
from engine.mechanics.finite_elements import FIELDS
from engine.mechanics.modes import DirectionalShapes, FullModes, directional_shapes, full_modes
from engine.models.critical_wind_speeds import Crossings, critical_wind_speeds
from engine.models.discretization import Discretization, discretize
from engine.models.finite_element import finite_element_model
from engine.models.hybrid import hybrid_model, joint_model, with_published_load
from engine.models.reduced_model import ReducedModel, take
from engine.outcome import Fault, InvalidSpec
from engine.report.assembled import assembled
from engine.report.device_effects import device_effects
from engine.report.loop_competitions import loop_competitions
from engine.report.rows import Found, FrequencyTable, coupled_squares
from engine.result import LoopCompetitionRow, Progress, Result
from engine.spec import Analysis, Check, DeviceEffect, Line, LoopCompetition, Model, check_compatible
from engine.tori.quasi_periodic import integrated, quasi_periodic_motions


@dataclass(frozen=True, slots=True)
class _Prepared:
    """What every later step reads: the discretization, its shapes and, where asked for, its full modes."""

    made: Discretization
    shapes: DirectionalShapes
    modes: FullModes | None


@dataclass(frozen=True, slots=True)
class _Reduced:
    """A stack of models before its motions are sought; the fields are those of Found."""

    name: Model
    model: ReducedModel
    line: IntArray
    loops: IntArray
    crossings: Crossings


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
        If the analysis cannot be asked of this line.
    """
    results = yield from analyse_stack((line,), analysis)
    return results[0]


def analyse_stack(lines: Sequence[Line], analysis: Analysis) -> Generator[Progress, None, list[Result]]:
    """Analyse lines with equal numbers of elements side by side; as `analyse`, with one result a line.

    Raises
    ------
    InvalidSpec
        If the analysis cannot be asked of a line, or the lines differ in their number of elements.
    """
    for line in lines:
        check_compatible(line, analysis)
    if len({line.span.elements for line in lines}) != 1:
        raise InvalidSpec(Fault("span.elements", None, "must be equal within a stack of lines"))
    if analysis.device_effect is DeviceEffect.NEGLECTED:
        return (yield from _analysed(lines, analysis))
    bare = [replace(line, devices=()) for line in lines]
    results = yield from _analysed([*lines, *bare], analysis)
    pairs = zip(results[len(lines) :], results, strict=False)
    return [replace(fitted, device_effects=device_effects(without, fitted)) for without, fitted in pairs]


def _analysed(lines: Sequence[Line], analysis: Analysis) -> Generator[Progress, None, list[Result]]:
    yield Progress(0.0, "static state and modes")
    prepared = _prepare(lines, analysis)
    yield Progress(0.1, "critical wind speeds and limit cycles of the hybrid model")
    hybrid = _hybrid(prepared, analysis)
    wanted = Model.HYBRID in analysis.models
    found = [hybrid] if wanted else []
    squares = [FrequencyTable(Model.HYBRID, hybrid.line, hybrid.loops, coupled_squares(hybrid.model))] if wanted else []
    if prepared.modes is not None:
        squares.append(_full_squares(prepared.modes))
        if analysis.finite_element_loops:
            found.append((yield from _finite_element(prepared, prepared.modes, hybrid, analysis)))
    yield Progress(0.95, "result rows")
    competitions = _competitions(prepared, hybrid, analysis)
    results = assembled(prepared.made, prepared.shapes, tuple(squares), tuple(found), analysis, competitions)
    yield Progress(1.0, "done")
    return results


def _prepare(lines: Sequence[Line], analysis: Analysis) -> _Prepared:
    made = discretize(lines, analysis.static_twist)
    system, arc_length = made.matrices, made.profile.arc_length
    finite_element = Model.FINITE_ELEMENT in analysis.models
    loops = set(analysis.loops) | {1, 2}
    extra = set(analysis.finite_element_loops) if finite_element else set()
    shapes = directional_shapes(system, arc_length, tuple(sorted(loops | extra)))
    modes = full_modes(system, tuple(sorted(set(analysis.loops) | extra))) if finite_element else None
    return _Prepared(made, shapes, modes)


def _winds(analysis: Analysis) -> FloatArray:
    return np.array(sorted(set(analysis.wind_speeds)), dtype=np.float64)


def _hybrid(prepared: _Prepared, analysis: Analysis) -> Found:
    """Analyse the hybrid model of every line and number of loops as one stack, line-major."""
    loops = analysis.loops
    grid = hybrid_model(prepared.made, prepared.shapes, loops, analysis)
    line = np.repeat(np.arange(len(prepared.made.lines)), len(loops))
    column = np.tile(np.arange(len(loops)), len(prepared.made.lines))
    model = take(grid, (line, column))
    published = take(with_published_load(prepared.made, grid), (line, column))
    winds = _winds(analysis)
    starts = explicit_starts(published, winds, analysis.harmonics)
    crossings = critical_wind_speeds(model, analysis.critical_wind_limit)
    directions = np.array(loops)[column][:, None] * np.ones(3, dtype=np.intp)
    return _found(_Reduced(Model.HYBRID, model, line, directions, crossings), winds, starts, analysis)


def _finite_element(
    prepared: _Prepared, modes: FullModes, hybrid: Found, analysis: Analysis
) -> Generator[Progress, None, Found]:
    """Analyse the finite element model of every line, started from the cycles of the hybrid one as well."""
    yield Progress(0.4, "critical wind speeds of the finite element model")
    model = finite_element_model(prepared.made, modes, prepared.shapes, analysis)
    crossings = critical_wind_speeds(model, analysis.critical_wind_limit)
    yield Progress(0.5, "limit cycles of the finite element model")
    starts = _lifted(prepared.made, modes, hybrid, model, analysis.harmonics)
    line, loops = np.arange(len(prepared.made.lines)), np.broadcast_to(np.tile(modes.loops, 3), model.shapes.shape[:2])
    return _found(_Reduced(Model.FINITE_ELEMENT, model, line, loops, crossings), hybrid.winds, starts, analysis)


def _found(reduced: _Reduced, winds: FloatArray, starts: Starts, analysis: Analysis) -> Found:
    """Find all motions of a stack of models at the wind speeds, and hold them against direct integration if asked."""
    model, direct = reduced.model, analysis.check is Check.DIRECT
    arrived = direct_starts(model, winds, analysis.harmonics) if direct else None
    cycles = find_cycles(model, reduced.crossings, winds, starts, analysis.harmonics, arrived)
    turning = bifurcations(cycles.traces, cycles.followed, model, reduced.crossings)
    tori = quasi_periodic_motions(model, cycles, turning, winds, analysis.quasi_periodic)
    return Found(
        name=reduced.name,
        model=model,
        line=reduced.line,
        loops=reduced.loops,
        crossings=reduced.crossings,
        cycles=cycles,
        confidence=confidence(model, cycles, analysis.check),
        bifurcations=turning,
        quasi_periodic=integrated(model, tori) if direct else tori,
        winds=winds,
    )


def _competitions(prepared: _Prepared, hybrid: Found, analysis: Analysis) -> list[list[LoopCompetitionRow]]:
    """Hold the stable cycles of the hybrid model against one another's loops, if that is asked for."""
    if analysis.loop_competition is LoopCompetition.NEGLECTED:
        return [[] for _ in prepared.made.lines]
    joint = joint_model(prepared.made, prepared.shapes, analysis.loops, analysis)
    return loop_competitions(prepared.made, joint, hybrid, analysis.loops)


def _full_squares(modes: FullModes) -> FrequencyTable:
    count = modes.eigenvalues.shape[0]
    loops = np.broadcast_to(np.tile(modes.loops, 3), (count, 3 * len(modes.loops)))
    return FrequencyTable(Model.FINITE_ELEMENT, np.arange(count), loops, modes.eigenvalues.reshape(count, -1))


def _lifted(made: Discretization, modes: FullModes, hybrid: Found, model: ReducedModel, harmonics: int) -> Starts:
    """Express the hybrid cycles in the modes of the finite element model, by projection in the mass."""
    cycles: Cycles = hybrid.cycles
    usable = ~model.statically_unstable[hybrid.line[cycles.member]]
    member = cycles.member[usable]
    line = hybrid.line[member]
    vectors = modes.vectors.reshape(modes.vectors.shape[0], -1, modes.vectors.shape[-1])
    momentum = (vectors @ made.matrices.mass)[line]
    shapes = hybrid.model.shapes[member]
    whole: FloatArray = np.zeros((*shapes.shape[:2], shapes.shape[-1], FIELDS))
    whole[..., 1:] = shapes.swapaxes(-1, -2)
    lift = momentum @ merged(whole, -2).swapaxes(-1, -2)
    orbits = Orbits(
        lift @ cycles.orbits.coefficients[usable],
        cycles.orbits.angular_frequency[usable],
        cycles.orbits.wind_speed[usable],
    )
    return Starts(line, cycles.wind[usable], resized(orbits, harmonics))
