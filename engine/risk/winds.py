"""At which wind speeds a line gallops, and at which that is not known, read off the tables of its result."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from engine.outcome import Outcome, Stability
from engine.result import CriticalWindSpeedRow, LimitCycleRow, Result
from engine.spec import Analysis, Model

Interval = tuple[float, float]

_MOVES, _RESTS, _UNKNOWN, _HOPF = "moves", "rests", "unknown", "hopf"


@dataclass(frozen=True, slots=True)
class WindRanges:
    """Wind speeds of stable motions, and wind speeds at which these are not known [m/s]: disjoint, rising, open.

    Elsewhere the span stays at rest.
    """

    moving: tuple[Interval, ...]
    unknown: tuple[Interval, ...]

    def scaled(self, factor: float) -> "WindRanges":
        """Return them with every wind speed times a factor."""
        moving, unknown = (tuple((a * factor, b * factor) for a, b in part) for part in (self.moving, self.unknown))
        return WindRanges(moving, unknown)


def united(ranges: Iterable[WindRanges]) -> WindRanges:
    """Return where any of several motions exists, and where none does but some are not known."""
    every = list(ranges)
    moving = _merged(part for one in every for part in one.moving)
    return WindRanges(moving, _without(_merged(part for one in every for part in one.unknown), moving))


def wind_ranges(result: Result, analysis: Analysis, model: Model, loops: int) -> WindRanges:
    """Return the wind speeds at which a line gallops in one model with one number of loops.

    Where the span at rest loses stability to an oscillation, from each onset to its restabilization, it gallops.
    Elsewhere the rows at the wind speeds asked for tell, and between these the folds at which a motion ends. Nothing is
    known above the search for critical wind speeds, nor, where rest is stable, above the highest wind speed asked for.

    Parameters
    ----------
    result : Result
    analysis : Analysis
        What was asked: its wind speeds and its limit of critical wind speeds.
    model : Model
    loops : int
    """
    rows = _rows(result.limit_cycles, model, loops)
    outcomes = {row.outcome for row in rows} | {row.outcome for row in result.frequencies if row.model == model}
    if Outcome.STATICALLY_UNSTABLE in outcomes:
        return WindRanges((), ((0.0, math.inf),))
    limit = analysis.critical_wind_limit
    crossings = [row for row in result.critical_wind_speeds if row.model == model and row.type == "oscillation"]
    unstable = _unstable([row for row in crossings if row.loops == loops], limit)
    others = [_unstable([row for row in crossings if row.loops == n], limit) for n in {row.loops for row in crossings}]
    rest = _Rest(rows, limit, _merged(part for one in others for part in one))
    folds = sorted(
        row.wind_speed_m_per_s
        for row in result.bifurcations
        if row.type == "fold" and (row.model, row.loops) == (model, loops)
    )
    pieces: list[tuple[Interval, str]] = [(part, _MOVES) for part in unstable]
    for stretch in _without(((0.0, limit),), unstable):
        # Motions were sought only if there was a wind speed to seek them at.
        pieces += _at_stable_rest(rest.anchors(stretch), folds) if rows else [(stretch, _UNKNOWN)]
    moving = _merged(part for part, state in pieces if state == _MOVES)
    unknown = [part for part, state in pieces if state == _UNKNOWN]
    return WindRanges(moving, _merged([*unknown, (limit, math.inf)]))


def _rows(rows: Sequence[LimitCycleRow], model: Model, loops: int) -> list[LimitCycleRow]:
    """Return the rows of a number of loops; the state at rest is that of the model where it has no row for them."""
    own = [row for row in rows if row.model == model and row.loops == loops]
    if any(row.kind == "equilibrium" for row in own):
        return own
    return [*own, *(row for row in rows if row.model == model and row.kind == "equilibrium")]


def _unstable(rows: Sequence[CriticalWindSpeedRow], limit: float) -> tuple[Interval, ...]:
    """Return where the span at rest is unstable to an oscillation: between its crossings, counted as they come."""
    count, first, found = 0, 0.0, []
    for row in sorted(rows, key=lambda row: row.wind_speed_m_per_s):
        before, count = count, max(0, count + (1 if row.crossing == "onset" else -1))
        if before == 0 and count > 0:
            first = row.wind_speed_m_per_s
        elif before > 0 and count == 0:
            found.append((first, row.wind_speed_m_per_s))
    found += [(first, limit)] if count > 0 else []
    return tuple((start, min(stop, limit)) for start, stop in found if start < limit)


@dataclass(frozen=True, slots=True)
class _Rest:
    """What is known where the span at rest is stable against these loops.

    rows: of these loops; limit: of the critical wind speeds [m/s]; unstable: where rest is unstable, whatever the
    loops.
    """

    rows: Sequence[LimitCycleRow]
    limit: float
    unstable: tuple[Interval, ...]

    def anchors(self, stretch: Interval) -> list[tuple[float, str]]:
        """Return the wind speeds of a stretch at which something is known, with what it is."""
        start, stop = stretch
        winds = sorted({row.wind_speed_m_per_s for row in self.rows if start < row.wind_speed_m_per_s < stop})
        first = (start, _HOPF if start > 0.0 else _RESTS)
        last = (stop, _HOPF if stop < self.limit else _UNKNOWN)
        return [first, *((wind, self._state(wind)) for wind in winds), last]

    def _state(self, wind: float) -> str:
        rows = [row for row in self.rows if row.wind_speed_m_per_s == wind]
        moving = any(row.kind != "equilibrium" and row.stability is Stability.STABLE for row in rows)
        if moving or any(row.outcome is Outcome.NO_BOUNDED_MOTION for row in rows):
            return _MOVES
        # Rest that other loops make unstable is rest for these: they count in their own rows.
        by_others = any(start <= wind <= stop for start, stop in self.unstable)
        rests = [row.stability is Stability.STABLE or by_others for row in rows if row.kind == "equilibrium"]
        return _RESTS if any(rests) and all(row.vertical_m is not None for row in rows) else _UNKNOWN


def _at_stable_rest(anchors: Sequence[tuple[float, str]], folds: Sequence[float]) -> list[tuple[Interval, str]]:
    """Return the pieces of a stretch between its anchors, and what the span does there."""
    pieces: list[tuple[Interval, str]] = []
    for (start, left), (stop, right) in pairwise(anchors):
        between = [fold for fold in folds if start < fold < stop]
        pieces += _between((start, stop), *_ends(left, right, bool(between)), between)
    return pieces


def _ends(left: str, right: str, has_fold: bool) -> tuple[str, str]:
    """Return what happens at both ends; beside a Hopf point it moves if the branch of that point ends at a fold."""
    if left == right == _HOPF:
        return (_MOVES, _MOVES) if has_fold else (_UNKNOWN, _UNKNOWN)
    beside = _MOVES if has_fold else right if left == _HOPF else left
    return (beside if left == _HOPF else left), (beside if right == _HOPF else right)


def _between(piece: Interval, left: str, right: str, folds: Sequence[float]) -> list[tuple[Interval, str]]:
    start, stop = piece
    if _UNKNOWN in (left, right) or (not folds and left != right):
        return [(piece, _UNKNOWN)]
    if not folds:
        return [(piece, left)]
    if len(folds) == 1 and left == right:
        return [(piece, _UNKNOWN)]
    return [((start, folds[0]), left), ((folds[0], folds[-1]), _UNKNOWN), ((folds[-1], stop), right)]


def _merged(intervals: Iterable[Interval]) -> tuple[Interval, ...]:
    found: list[Interval] = []
    for start, stop in sorted(part for part in intervals if part[0] < part[1]):
        if found and start <= found[-1][1]:
            found[-1] = (found[-1][0], max(found[-1][1], stop))
        else:
            found.append((start, stop))
    return tuple(found)


def _without(intervals: Sequence[Interval], removed: Sequence[Interval]) -> tuple[Interval, ...]:
    """Return what is left of disjoint intervals without others, which rise."""
    left = list(intervals)
    for first, last in removed:
        left = [
            part
            for start, stop in left
            for part in ((start, min(stop, first)), (max(start, last), stop))
            if part[0] < part[1]
        ]
    return tuple(left)
