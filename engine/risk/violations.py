"""At which wind speeds a line comes closer to another phase than required, read off its clearances."""

from collections.abc import Sequence
from itertools import pairwise

from engine.outcome import Stability
from engine.result import PhaseClearanceRow, Result
from engine.risk.winds import Interval, WindRanges
from engine.spec import Analysis, Model

_BROKEN, _KEPT, _UNKNOWN = "broken", "kept", "unknown"


def asks_for_clearance(result: Result) -> bool:
    """Tell whether any computed clearance has a required one to be held against."""
    return any(row.method == "computed" and row.required_m is not None for row in result.clearances)


def violation_ranges(result: Result, analysis: Analysis, model: Model, loops: int, ranges: WindRanges) -> WindRanges:
    """Return the wind speeds at which a stable motion breaks a required clearance.

    Between two wind speeds asked for it is broken where it is at both, kept where it is at both, else not known; so it
    is below the first one, from rest on. Above the last one nothing is known where the line gallops.

    Parameters
    ----------
    result : Result
    analysis : Analysis
    model : Model
    loops : int
    ranges : WindRanges
        Wind speeds at which it gallops, as `wind_ranges` returns them.
    """
    rows = [
        row
        for row in result.clearances
        if (row.method, row.model, row.loops, row.stability) == ("computed", model, loops, Stability.STABLE)
    ]
    anchors = [(0.0, _KEPT), *((wind, _state(wind, rows, ranges)) for wind in sorted(set(analysis.wind_speeds)))]
    pieces = [
        ((start, stop), before if before == after else _UNKNOWN) for (start, before), (stop, after) in pairwise(anchors)
    ]
    pieces.append(((anchors[-1][0], float("inf")), _UNKNOWN))
    broken, unknown = ([piece for piece, state in pieces if state == wanted] for wanted in (_BROKEN, _UNKNOWN))
    return WindRanges(
        _common(broken, ranges.moving), tuple(sorted((*_common(unknown, ranges.moving), *ranges.unknown)))
    )


def _state(wind: float, rows: Sequence[PhaseClearanceRow], ranges: WindRanges) -> str:
    here = [row.ok for row in rows if row.wind_speed_m_per_s == wind and row.required_m is not None]
    if False in here:
        return _BROKEN
    gallops = any(start < wind < stop for start, stop in (*ranges.moving, *ranges.unknown))
    return _KEPT if (here and None not in here) or not (here or gallops) else _UNKNOWN


def _common(some: Sequence[Interval], others: Sequence[Interval]) -> tuple[Interval, ...]:
    """Return what two sequences of disjoint intervals have in common, in rising order."""
    both = [(max(a, c), min(b, d)) for a, b in some for c, d in others]
    return tuple(sorted(part for part in both if part[0] < part[1]))
