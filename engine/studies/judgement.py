"""Whether a changed line is better than the line as it is: by its onset, its largest motion and its clearances."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from engine.outcome import Outcome, Stability
from engine.result import LimitCycleRow, Result
from engine.result.remedies import Change
from engine.spec import Analysis, Model

LEAST = 0.01  # relative change that counts: as much as a cycle may be off that direct integration confirms


@dataclass(frozen=True, slots=True)
class Figures:
    """What a line is judged by.

    onset: lowest wind speed at which rest turns into an oscillation [m/s], infinite without one; size: largest
    sqrt(V^2 + W^2) of the stable motions [m], 0 at rest, infinite where nothing bounds the motion, None where no wind
    speed was asked for; distance: smallest one to another phase [m], None where none is known. NaN: not known.
    """

    onset: float
    size: float | None = None
    distance: float | None = None


def figures(result: Result, model: Model, analysis: Analysis) -> Figures:
    """Return what one model says of a line."""
    failed = any(row.outcome is not Outcome.CONVERGED for row in result.frequencies if row.model is model)
    onsets = (
        row.wind_speed_m_per_s
        for row in result.critical_wind_speeds
        if row.model is model and row.crossing == "onset" and row.type == "oscillation"
    )
    rows = [row for row in result.limit_cycles if row.model is model]
    near = [
        row.distance_m
        for row in result.clearances
        if row.method == "computed" and row.model == model.value and row.stability is Stability.STABLE
    ]
    known = [distance for distance in near if distance is not None]
    return Figures(
        onset=math.nan if failed else min(onsets, default=math.inf),
        size=_size(rows, model) if analysis.wind_speeds else None,
        distance=min(known) if known and len(known) == len(near) else None,
    )


def compared(without: Figures, changed: Figures) -> Change:
    """Return whether a change is one for the better: no figure is worse, and one of them is better.

    Better in one and worse in another is no improvement. What is not known of either line leaves it undecided.
    """
    return _together(_measured(without, changed))


def is_worse(without: Figures, changed: Figures) -> bool:
    """Return whether a change is for the worse in any figure, or leaves one unknown that was known."""
    found = (_of_onset(without.onset, changed.onset), _of_size(without.size, changed.size))
    if "worse" in found:
        return True
    return math.isnan(changed.onset) or (changed.size is not None and not math.isfinite(changed.size))


def judged(without: Result, changed: Result, analysis: Analysis) -> Change:
    """Return whether a changed line is better, as `compared`, in the figures of every model that both results have."""
    found: set[Change] = set()
    for model in common_models(without, changed):
        found |= _measured(figures(without, model, analysis), figures(changed, model, analysis))
    return _together(found) if found else "undecided"


def common_models(*results: Result) -> list[Model]:
    """Return the models that all results have."""
    having = [{row.model for row in one.frequencies} | {row.model for row in one.limit_cycles} for one in results]
    return [model for model in Model if all(model in models for models in having)]


def few(wind_speeds: Sequence[float]) -> tuple[float, ...]:
    """Return the lowest, the middle and the highest of wind speeds [m/s], which stand for all of them in a search."""
    rising = sorted(set(wind_speeds))
    return tuple(sorted({rising[0], rising[len(rising) // 2], rising[-1]})) if rising else ()


def _measured(without: Figures, changed: Figures) -> set[Change]:
    found = {_of_onset(without.onset, changed.onset), _of_size(without.size, changed.size)}
    if without.distance is not None and changed.distance is not None:
        found.add(_of_larger(without.distance, changed.distance))
    return found


def _together(found: set[Change]) -> Change:
    if "undecided" in found:
        return "undecided"
    counted = found - {"no_improvement"}
    return counted.pop() if len(counted) == 1 else "no_improvement"


def _of_onset(without: float, changed: float) -> Change:
    if math.isnan(without) or math.isnan(changed):
        return "undecided"
    if without == changed:  # both infinite, too
        return "no_improvement"
    return _of_larger(without, changed)


def _of_larger(without: float, changed: float) -> Change:
    """Compare numbers of which the larger is better."""
    least = LEAST * abs(without) if math.isfinite(without) else 0.0
    if changed > without + least:
        return "better"
    return "worse" if changed < without - least else "no_improvement"


def _of_size(without: float | None, changed: float | None) -> Change:
    """Compare sizes: against one that is not known, only rest is better."""
    if without is None or changed is None:
        return "no_improvement"
    if math.isnan(without) or math.isnan(changed):
        return "undecided"
    if math.isinf(without):
        return "better" if changed == 0.0 else "undecided"
    return _of_larger(-without, -changed)


def _size(rows: Sequence[LimitCycleRow], model: Model) -> float:
    outcomes = {row.outcome for row in rows if row.vertical_m is None}
    if outcomes == {Outcome.NO_BOUNDED_MOTION}:
        return math.inf
    groups: dict[tuple[int | None, float], list[LimitCycleRow]] = {}
    for row in rows:
        loops = row.loops if model is Model.HYBRID else None  # the finite element model moves all loops together
        groups.setdefault((loops, row.wind_speed_m_per_s), []).append(row)
    if outcomes or not rows or not all(_is_known(group) for group in groups.values()):
        return math.nan
    stable = (row for row in rows if row.stability is Stability.STABLE)
    return max((math.hypot(row.vertical_m or 0.0, row.horizontal_m or 0.0) for row in stable), default=0.0)


def _is_known(rows: Sequence[LimitCycleRow]) -> bool:
    """Return whether the stable states at a wind speed are known: one at least, and none of unknown stability."""
    found = [row.stability for row in rows]
    return Stability.STABLE in found and Stability.UNKNOWN not in found
