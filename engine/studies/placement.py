"""Placement of devices by differential evolution; each generation is analysed as one stack of lines."""

import math
from collections.abc import Generator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.optimize import Bounds, OptimizeResult, differential_evolution

from engine.analysis import analyse_stack
from engine.arrays import FloatArray
from engine.outcome import Outcome
from engine.progress import Progress, finished, translated
from engine.report.comparisons.device_effects import device_effects, largest_amplitude, lowest_onset
from engine.result import PlacedDeviceRow, Result
from engine.spec import (
    Analysis,
    DeviceEffect,
    Line,
    LoopCompetition,
    Model,
    Objective,
    Placement,
    check_placement,
)

SEARCH_SHARE = 0.8  # of the progress; the rest is the full analysis without and with the devices
TOLERANCE = 1e-3  # spread of a generation relative to its mean, below which the search has converged
ALIKE = 9  # decimals to which the unknowns of equal candidates agree


def place(line: Line, analysis: Analysis, placement: Placement) -> Generator[Progress, None, Result]:
    """Search for the best places, then analyse the line without and with the devices.

    The objective comes from the hybrid model at all loops asked for: the lowest onset, or the largest amplitude of a
    stable motion at the requested wind speeds. Devices already on the line stay where they are.

    Parameters
    ----------
    line : Line
    analysis : Analysis
    placement : Placement

    Yields
    ------
    Progress
        After every generation, and as `analyse_stack` does.

    Returns
    -------
    Result
        Of the line with the devices; `device_effects` compares it with the line as given, and `placements` holds the
        devices.

    Raises
    ------
    InvalidSpec
        If the placement does not fit the line and the analysis.
    """
    check_placement(line, analysis, placement)
    yield Progress(0.0, "first generation of places")
    candidates = _Candidates(line, analysis, placement)
    found = _evolved(candidates, placement, 0, None)
    generation = 0
    while generation < placement.generations and not found.success:
        generation += 1
        share = SEARCH_SHARE * (generation / placement.generations)
        yield Progress(share, f"generation {generation} of {placement.generations} of places")
        found = _evolved(candidates, placement, generation, found.population)
    fitted = candidates.line(found.x)
    steps = analyse_stack((line, fitted), replace(analysis, device_effect=DeviceEffect.NEGLECTED))
    without, result = yield from translated(steps, _later)
    value = None if not math.isfinite(found.fun) else abs(float(found.fun))
    rows = _rows(fitted, len(line.devices), placement, _Search(value, candidates.evaluations, generation))
    return replace(result, device_effects=device_effects(without, result), placements=rows)


class _Candidates:
    """The objective of a whole generation at once; a candidate seen before is not computed again."""

    def __init__(self, line: Line, analysis: Analysis, placement: Placement) -> None:
        self._line, self._placement = line, placement
        onset_sought = placement.objective is Objective.HIGHEST_CRITICAL_WIND_SPEED
        self._analysis = replace(
            analysis,
            models=(Model.HYBRID,),
            wind_speeds=() if onset_sought else analysis.wind_speeds,
            loop_competition=LoopCompetition.NEGLECTED,
            device_effect=DeviceEffect.NEGLECTED,
        )
        self._known: dict[tuple[float, ...], float] = {}

    @property
    def evaluations(self) -> int:
        """Number of different candidates computed."""
        return len(self._known)

    def line(self, unknowns: FloatArray) -> Line:
        """Return the line with the devices for given unknowns."""
        devices = self._placement.choice.devices(*unknowns.tolist())
        return replace(self._line, devices=(*self._line.devices, *devices))

    def __call__(self, unknowns: FloatArray) -> FloatArray:
        """Return the value to minimize for each column of unknowns (unknowns, candidates): (candidates,)."""
        keys = [tuple(np.round(column, ALIKE).tolist()) for column in unknowns.T]
        new = {key: column for key, column in zip(keys, unknowns.T, strict=True) if key not in self._known}
        if new:
            results = finished(analyse_stack([self.line(column) for column in new.values()], self._analysis))
            self._known.update(zip(new, map(self._value, results), strict=True))
        return np.array([self._known[key] for key in keys])

    def _value(self, result: Result) -> float:
        if any(row.outcome is not Outcome.CONVERGED for row in result.frequencies):
            return math.inf
        asked = self._analysis
        if self._placement.objective is Objective.HIGHEST_CRITICAL_WIND_SPEED:
            onsets = [lowest_onset(result, Model.HYBRID, loops) for loops in asked.loops]
            return -min(asked.critical_wind_limit if onset is None else onset for onset in onsets)
        places = [(loops, wind) for loops in asked.loops for wind in asked.wind_speeds]
        sizes = [largest_amplitude(result, Model.HYBRID, loops, wind) for loops, wind in places]
        return max(math.inf if size is None else size for size in sizes)


def _evolved(
    candidates: _Candidates, placement: Placement, generation: int, population: FloatArray | None
) -> OptimizeResult:
    """Draw the first generation, or evolve the given one once, so that the caller can stop after each."""
    low, high = np.array(placement.choice.bounds).T
    generator = np.random.default_rng((placement.seed, generation))
    if population is None:
        population = low + (high - low) * generator.random((placement.population, low.size))
    objective: Any = candidates  # takes a generation at once, which scipy's stubs do not describe
    return differential_evolution(
        objective,
        Bounds(low, high),
        init=population,
        maxiter=min(generation, 1),
        vectorized=True,
        updating="deferred",
        polish=False,
        tol=TOLERANCE,
        rng=generator,
    )


@dataclass(frozen=True, slots=True)
class _Search:
    """How a search ended: best objective (None if no candidate has one), numbers of candidates and generations."""

    value: float | None
    evaluations: int
    generations: int


def _rows(fitted: Line, before: int, placement: Placement, search: _Search) -> tuple[PlacedDeviceRow, ...]:
    """Return a row for each placed device; `before` is the number of devices that the line already had."""
    rows = []
    for number, device in enumerate(fitted.devices[before:], start=before):
        rows.append(
            PlacedDeviceRow(
                device=number,
                type=placement.choice.type,
                position_m=device.placed.get("position_m"),
                mass_kg=device.placed.get("mass_kg"),
                arm_m=device.placed.get("arm_m"),
                from_m=device.placed.get("from_m"),
                to_m=device.placed.get("to_m"),
                objective=placement.objective,
                objective_value=search.value,
                evaluations=search.evaluations,
                generations=search.generations,
            )
        )
    return tuple(rows)


def _later(of_analysis: Progress) -> Progress:
    """Place the progress of the full analysis after that of the search."""
    return Progress(SEARCH_SHARE + (1.0 - SEARCH_SHARE) * of_analysis.fraction, of_analysis.step)
