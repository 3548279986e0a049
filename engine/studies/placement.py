"""Placement of devices by differential evolution; each generation is analysed as one stack of lines."""

import math
from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.optimize import Bounds, OptimizeResult, differential_evolution

from engine.analysis import analyse_stack
from engine.arrays import FloatArray
from engine.progress import Progress, finished, translated
from engine.report.comparisons.device_effects import device_effects
from engine.result import PlacedDeviceRow, Result
from engine.result.remedies import Change
from engine.spec import (
    Analysis,
    DeviceEffect,
    Line,
    Model,
    Objective,
    Placement,
    PointDevice,
    check_placement,
    separation_on,
)
from engine.studies.arrangements import Room, practice, taken_places
from engine.studies.judgement import Figures, few, figures, is_worse, judged
from engine.uncertainty.outcomes import State
from engine.uncertainty.runs import analysed, sampled_analysis

SEARCH_SHARE = 0.8  # of the progress; the rest is the full analysis without and with the devices
TOLERANCE = 1e-3  # spread of a generation relative to its mean, below which the search has converged
ALIKE = 9  # decimals to which the unknowns of equal candidates agree
FINALISTS = 2  # that the full analysis compares with the line as it is: of generations, and as many of practice
SHARES = (1.0, 0.5, 0.0)  # of the ranges of mass and arm, with which the arrangements of practice start


def place(line: Line, analysis: Analysis, placement: Placement) -> Generator[Progress, None, Result]:
    """Search for the best places, then analyse the line without and with the devices.

    The objective comes from the hybrid model at all loops asked for: the lowest onset, or the largest amplitude of a
    stable motion at the requested wind speeds. The search starts from arrangements of practice, keeps the separation,
    and takes no candidate that is worse than the line as it is, in its onset or its largest motion. Devices already on
    the line stay where they are.

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
        devices. If no candidate is better than nothing by every model asked for, of the line as given, with a warning.

    Raises
    ------
    InvalidSpec
        If the placement does not fit the line and the analysis.
    """
    check_placement(line, analysis, placement)
    yield Progress(0.0, "first generation of places")
    candidates = _Candidates(line, analysis, placement)
    found = _evolved(candidates, placement, 0, None)
    best = [found.x]
    generation = 0
    while generation < placement.generations and not found.success:
        generation += 1
        share = SEARCH_SHARE * (generation / placement.generations)
        yield Progress(share, f"generation {generation} of {placement.generations} of places")
        found = _evolved(candidates, placement, generation, found.population)
        best.append(found.x)
    asked = replace(analysis, device_effect=DeviceEffect.NEGLECTED)
    compared = yield from translated(_confirmed(line, candidates, best, asked), _later)
    if compared.chosen is None:
        warnings = (*compared.without.warnings, _no_improvement(candidates, compared.changes))
        return replace(compared.without, warnings=warnings)
    search = _Search(abs(candidates.value(compared.chosen)), candidates.evaluations, generation)
    rows = _rows(candidates.line(compared.chosen), len(line.devices), placement, search)
    result = compared.result
    if compared.changes[-1] == "undecided":
        text = "The line without the placed devices has no figures to compare with: whether they improve it is open."
        result = replace(result, warnings=(*result.warnings, text))
    return replace(result, device_effects=device_effects(compared.without, result), placements=rows)


@dataclass(frozen=True, slots=True)
class _Compared:
    """The line without devices, how the finalists compare with it, and the one chosen, if any, with its result."""

    without: Result
    changes: tuple[Change, ...]
    result: Result
    chosen: FloatArray | None


def _confirmed(
    line: Line, candidates: "_Candidates", best: Sequence[FloatArray], analysis: Analysis
) -> Generator[Progress, None, _Compared]:
    """Analyse finalists one after another, until one is better than nothing by every model asked for."""
    finalists = candidates.finalists(best)
    first = [candidates.line(unknowns) for unknowns in finalists[:1]]
    without, *results = yield from analyse_stack([line, *first], analysis)
    known = math.isfinite(candidates.nothing)
    changes: list[Change] = []
    for number, unknowns in enumerate(finalists):
        if number > 0:
            yield Progress(number / len(finalists), "another arrangement, because one did not improve the line")
            results = finished(analyse_stack([candidates.line(unknowns)], analysis))
        changes.append(judged(without, results[0], analysis))
        if changes[-1] == "better" or not known:
            return _Compared(without, tuple(changes), results[0], unknowns)
    return _Compared(without, tuple(changes), without, None)


def _no_improvement(candidates: "_Candidates", changes: Sequence[Change]) -> str:
    if changes and set(changes) == {"undecided"}:
        reason = "of the best ones it is not known whether they are better than nothing"
    else:
        reason = "none is better than nothing in onset and largest motion by every model asked for"
    return f"No improvement found: of {candidates.evaluations} arrangements {reason}. No device is placed."


class _Candidates:
    """The objective of a whole generation at once; a candidate seen before is not computed again."""

    def __init__(self, line: Line, analysis: Analysis, placement: Placement) -> None:
        self._line, self._placement = line, placement
        self._separation = separation_on(line, placement.separation)
        self.bounds = placement.choice.bounds(self._separation)
        onset_sought = placement.objective is Objective.HIGHEST_CRITICAL_WIND_SPEED
        self._analysis = replace(
            sampled_analysis(analysis),
            wind_speeds=few(analysis.wind_speeds) if onset_sought else tuple(sorted(set(analysis.wind_speeds))),
        )
        self._known: dict[tuple[float, ...], float] = {}
        (alone,) = analysed([line], self._analysis)
        self._without = self._figures(alone)
        self.nothing = self._objective(self._without)

    @property
    def evaluations(self) -> int:
        """Number of different candidates computed."""
        return len(self._known)

    def starts(self) -> list[tuple[float, ...]]:
        """Return the unknowns of arrangements of practice."""
        choice, length = self._placement.choice, self._line.span.length
        room = Room(*choice.position, self._separation)
        places = practice(choice.count, room, length)
        return list(dict.fromkeys(choice.unknowns(one, share, self._separation) for share in SHARES for one in places))

    def line(self, unknowns: FloatArray) -> Line:
        """Return the line with the devices for given unknowns."""
        devices = self._placement.choice.devices(unknowns.tolist(), self._separation)
        return replace(self._line, devices=(*self._line.devices, *devices))

    def value(self, unknowns: FloatArray) -> float:
        """Return the value of a candidate that was computed."""
        return self._known[_key(unknowns)]

    def finalists(self, best: Sequence[FloatArray]) -> list[FloatArray]:
        """Return the best of generations and of practice that are not worse than nothing, the best first."""
        computed = [one for one in map(np.array, self.starts()) if _key(one) in self._known]
        chosen = [*self._first(best), *self._first(computed)]
        return sorted({_key(one): one for one in chosen}.values(), key=self.value)

    def _first(self, found: Sequence[FloatArray]) -> list[FloatArray]:
        distinct = {_key(one): one for one in found if math.isfinite(self.value(one))}
        return sorted(distinct.values(), key=self.value)[:FINALISTS]

    def __call__(self, unknowns: FloatArray) -> FloatArray:
        """Return the value to minimize for each column of unknowns (unknowns, candidates): (candidates,)."""
        keys = [_key(column) for column in unknowns.T]
        new = {key: column for key, column in zip(keys, unknowns.T, strict=True) if key not in self._known}
        lines = {key: self.line(column) for key, column in new.items()}
        free = {key: line for key, line in lines.items() if self._keeps_away(line)}
        self._known.update(dict.fromkeys(new.keys() - free.keys(), math.inf))
        if free:
            self._known.update(zip(free, map(self._value, analysed(list(free.values()), self._analysis)), strict=True))
        return np.array([self._known[key] for key in keys])

    def _keeps_away(self, line: Line) -> bool:
        """Return whether the placed devices keep their separation from those that the line had."""
        placed = line.devices[len(self._line.devices) :]
        taken = taken_places(self._line)
        own = [device.position for device in placed if isinstance(device, PointDevice)]
        return all(abs(place - other) >= self._separation for place in own for other in taken)

    def _figures(self, found: Result | State) -> Figures:
        return Figures(math.nan) if isinstance(found, State) else figures(found, Model.HYBRID, self._analysis)

    def _value(self, found: Result | State) -> float:
        changed = self._figures(found)
        return math.inf if is_worse(self._without, changed) else self._objective(changed)

    def _objective(self, found: Figures) -> float:
        if math.isnan(found.onset) or (found.size is not None and math.isnan(found.size)):
            return math.inf
        if self._placement.objective is Objective.HIGHEST_CRITICAL_WIND_SPEED:
            return -min(self._analysis.critical_wind_limit, found.onset)
        return math.inf if found.size is None else found.size


def _key(unknowns: FloatArray) -> tuple[float, ...]:
    return tuple(np.round(unknowns, ALIKE).tolist())


def _evolved(
    candidates: _Candidates, placement: Placement, generation: int, population: FloatArray | None
) -> OptimizeResult:
    """Draw the first generation, or evolve the given one once, so that the caller can stop after each."""
    low, high = np.array(candidates.bounds).T
    generator = np.random.default_rng((placement.seed, generation))
    if population is None:
        population = low + (high - low) * generator.random((placement.population, low.size))
        starts = np.array(candidates.starts()[: placement.population // 2]).reshape(-1, low.size)
        population[: len(starts)] = np.clip(starts, low, high)
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
    """How a search ended: objective of the devices placed, numbers of candidates and generations."""

    value: float
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
