"""Results of a line whose blow-out follows the wind: every wind speed has a static state of its own.

An analysis takes one static state. So a line is analysed at each wind speed by itself, and the results are joined here.
A critical wind speed is one at which the static state of just that wind speed loses or regains stability.
"""

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

from engine.arrays import placed
from engine.progress import Progress, finished
from engine.report.phases.clearances import with_clearances
from engine.report.verdict import verdict
from engine.result import TABLES, BifurcationRow, CriticalWindSpeedRow, Result
from engine.risk.expectation import risk_rows
from engine.spec import Analysis, Line

STATES = 8  # static states from still air up to the limit whose critical wind speeds are starts
ITERATIONS = 20
TOLERANCE = 1e-9  # relative difference between a critical wind speed and the wind speed of its static state
SAME = 1e-6  # relative difference of two critical wind speeds that are one

Rows = tuple[CriticalWindSpeedRow, ...]
RowsAt = Callable[[Sequence[float]], Sequence[Rows]]
"""Returns the critical wind speeds in the static states of given wind speeds [m/s]."""


InOneState = Callable[[Sequence[Line], Analysis], Generator[Progress, None, list[Result]]]
"""Analyses a stack of lines, each in its one static state."""


@dataclass(frozen=True, slots=True)
class _Approach:
    """The wind speed of a static state and the critical wind speed found there, with those of the step before."""

    state: float
    row: CriticalWindSpeedRow
    before: tuple[float, float] | None = None

    @property
    def excess(self) -> float:
        """Critical wind speed less that of the static state [m/s]."""
        return self.row.wind_speed_m_per_s - self.state

    @property
    def settled(self) -> bool:
        """Whether the critical wind speed is that of its own static state."""
        return abs(self.excess) <= TOLERANCE * self.row.wind_speed_m_per_s

    @property
    def following(self) -> float:
        """The wind speed to try next: where the secant of the excess vanishes, else the critical wind speed [m/s]."""
        if self.before is None or self.before[1] == self.excess:
            return self.row.wind_speed_m_per_s
        state, excess = self.before
        secant = self.state - self.excess * (self.state - state) / (self.excess - excess)
        return secant if abs(secant - self.row.wind_speed_m_per_s) <= abs(self.excess) else self.row.wind_speed_m_per_s


def analyse_lines(
    lines: Sequence[Line], analysis: Analysis, in_one_state: InOneState
) -> Generator[Progress, None, list[Result]]:
    """Analyse lines as one stack, but each whose blow-out follows the wind at every wind speed by itself.

    Parameters
    ----------
    lines : sequence of Line
        All with the same number of elements.
    analysis : Analysis
    in_one_state : callable
        Analyses a stack of lines, each in its one static state.

    Returns
    -------
    list of Result
    """
    steady = [line for line in lines if not line.follows_wind]
    together = (yield from in_one_state(steady, analysis)) if steady else []
    results = []
    for line, own in zip(lines, placed(together, [not line.follows_wind for line in lines]), strict=True):
        result = (yield from _at_each_wind(line, analysis, in_one_state)) if own is None else own
        result = with_clearances(result, line)
        judged, risk = verdict(result, line, analysis), risk_rows(result, line, analysis)
        results.append(replace(result, verdict=(judged,), risk=risk))
    return results


def _at_each_wind(line: Line, analysis: Analysis, in_one_state: InOneState) -> Generator[Progress, None, Result]:
    at_winds = []
    winds = sorted(set(analysis.wind_speeds))
    for i, wind in enumerate(winds):
        yield Progress(i / (len(winds) + 1), f"wind speed {i + 1} of {len(winds)}")
        alone = in_one_state([line.blown_out_at(wind)], replace(analysis, wind_speeds=(wind,)))
        at_winds.append((wind, finished(alone)[0]))
    yield Progress(len(winds) / (len(winds) + 1), "critical wind speeds, each in its own static state")
    without_winds = replace(analysis, wind_speeds=())

    def rows_at(wind_speeds: Sequence[float]) -> list[Rows]:
        states = [line.blown_out_at(wind) for wind in wind_speeds]
        return [result.critical_wind_speeds for result in finished(in_one_state(states, without_winds))]

    still = finished(in_one_state([line.blown_out_at(0.0)], without_winds))[0]
    return joined(still, at_winds, critical_in_own_state(rows_at, analysis.critical_wind_limit))


def critical_in_own_state(rows_at: RowsAt, limit: float) -> tuple[Rows, int]:
    """Return the critical wind speeds of static states that are those of the same wind speed.

    The static state changes smoothly with the wind speed. The states of a few wind speeds each give all of their
    critical wind speeds. The secant method starts from those that lie near their state, and from those that lie above
    theirs where they lie below it in the next one, or the other way round. A crossing that vanishes on the way there
    does not exist in its own state.

    Parameters
    ----------
    rows_at : callable
    limit : float
        Largest wind speed [m/s].

    Returns
    -------
    rows : tuple of CriticalWindSpeedRow
        In the order of models, numbers of loops and wind speeds.
    unsettled : int
        Number of starts from which no state was reached.
    """
    step = limit / STATES
    states = [step * i for i in range(STATES + 1)]
    pending = _starts(states, rows_at(states), step)
    settled: list[_Approach] = []
    for _ in range(ITERATIONS):
        settled += [approach for approach in pending if approach.settled]
        pending = [approach for approach in pending if not approach.settled]
        if not pending:
            break
        found = rows_at([approach.following for approach in pending])
        moved = [_moved(approach, rows) for approach, rows in zip(pending, found, strict=True)]
        pending = [approach for approach in moved if approach is not None]
    rows = [approach.row for approach in settled if approach.row.wind_speed_m_per_s <= limit]
    return _distinct(rows), len(pending)


def joined(still: Result, at_winds: Sequence[tuple[float, Result]], critical: tuple[Rows, int]) -> Result:
    """Join the results of one line in the static states of several wind speeds.

    Parameters
    ----------
    still : Result
        In still air: static state, natural frequencies, and what else does not depend on the wind.
    at_winds : sequence of (float, Result)
        Wind speed [m/s] in rising order, and the result for it alone. Of its bifurcations and curves, which lie at
        other wind speeds, those remain that are nearest to it.
    critical : tuple
        As `critical_in_own_state` returns it.

    Returns
    -------
    Result
    """
    winds = [wind for wind, _ in at_winds]
    tables: dict[str, Any] = {}
    for name, table in TABLES.items():
        if "wind_speed_m_per_s" in {field.name for field in fields(table.row)}:
            parts = [_own_rows(getattr(result, name), wind, winds) for wind, result in at_winds]
            tables[name] = tuple(row for part in parts for row in part)
    tables["critical_wind_speeds"], unsettled = critical
    moved = (_in_own_state(row, at_winds, critical[0]) for row in tables["bifurcations"])
    tables["bifurcations"] = tuple(dict.fromkeys(moved))
    first, orbits = 0, []
    for _, result in at_winds:
        orbits += [replace(orbit, cycle=orbit.cycle + first) for orbit in result.orbits]
        first += len(result.limit_cycles)
    texts = dict.fromkeys(text for result in (still, *(result for _, result in at_winds)) for text in result.warnings)
    warnings = (*texts, *_unsettled_warnings(unsettled))
    return replace(still, **tables, orbits=tuple(orbits), warnings=warnings)


def _starts(states: Sequence[float], found: Sequence[Rows], step: float) -> list[_Approach]:
    """Return the approaches to begin with: close to a state, or on both sides of the way to the next one."""
    starts = []
    for state, rows, beyond, further in zip(states, found, [*states[1:], None], [*found[1:], ()], strict=True):
        for row in rows:
            here = _Approach(state, row)
            other = _nearest(row, further)
            if beyond is not None and other is not None and here.excess * (other.wind_speed_m_per_s - beyond) < 0.0:
                starts.append(_Approach(state, row, (beyond, other.wind_speed_m_per_s - beyond)))
            elif abs(here.excess) <= step:
                starts.append(here)
    return starts


def _moved(approach: _Approach, rows: Rows) -> _Approach | None:
    """Return the next step of an approach, None if the crossing has vanished."""
    nearest = _nearest(approach.row, rows)
    return None if nearest is None else _Approach(approach.following, nearest, (approach.state, approach.excess))


def _nearest(row: CriticalWindSpeedRow, rows: Rows) -> CriticalWindSpeedRow | None:
    """Return the crossing of the same kind at the nearest wind speed, None if there is none."""
    same = [other for other in rows if _kind(other) == _kind(row)]
    return min(same, key=lambda other: abs(other.wind_speed_m_per_s - row.wind_speed_m_per_s), default=None)


def _kind(row: CriticalWindSpeedRow) -> tuple[object, ...]:
    return row.model, row.loops, row.type, row.crossing


def _distinct(rows: Sequence[CriticalWindSpeedRow]) -> Rows:
    """Return the rows in order, each crossing once."""
    kept: list[CriticalWindSpeedRow] = []
    for row in sorted(rows, key=lambda row: (row.model != "hybrid", row.loops, row.wind_speed_m_per_s)):
        alike = (other for other in kept if _kind(other) == _kind(row))
        if all(
            abs(other.wind_speed_m_per_s - row.wind_speed_m_per_s) > SAME * row.wind_speed_m_per_s for other in alike
        ):
            kept.append(row)
    return tuple(kept)


def _own_rows(rows: Sequence[Any], wind: float, winds: Sequence[float]) -> list[Any]:
    """Return the rows to whose wind speed the one of their static state is nearest."""
    return [row for row in rows if min(winds, key=lambda other: abs(other - row.wind_speed_m_per_s)) == wind]


def _in_own_state(row: BifurcationRow, at_winds: Sequence[tuple[float, Result]], critical: Rows) -> BifurcationRow:
    """Move a Hopf point to its critical wind speed, and widen the uncertainty of any other bifurcation.

    It lies away from the wind speed of its static state; the two nearest states show how fast it moves with them. Where
    the other one does not have it, it is taken to move as fast as the wind.
    """
    alike = [other for other in critical if (other.model, other.loops) == (row.model, row.loops)]
    if row.type == "hopf" and alike:
        own = min(alike, key=lambda other: abs(other.wind_speed_m_per_s - row.wind_speed_m_per_s))
        return replace(row, wind_speed_m_per_s=own.wind_speed_m_per_s, frequency_hz=own.frequency_hz)
    states = sorted(at_winds, key=lambda at: abs(at[0] - row.wind_speed_m_per_s))
    rate = _rate(row, states[0][0], states[1]) if len(states) > 1 else 1.0
    shift = rate * abs(row.wind_speed_m_per_s - states[0][0])
    return replace(row, uncertainty_m_per_s=row.uncertainty_m_per_s + shift)


def _rate(row: BifurcationRow, state: float, other: tuple[float, Result]) -> float:
    """Return by how much a bifurcation moves with the wind speed of its static state, seen from another state."""
    wind, result = other
    alike = [r for r in result.bifurcations if (r.model, r.loops, r.type) == (row.model, row.loops, row.type)]
    moves = [abs(r.wind_speed_m_per_s - row.wind_speed_m_per_s) for r in alike]
    return min(moves) / abs(wind - state) if moves else 1.0


def _unsettled_warnings(unsettled: int) -> tuple[str, ...]:
    if not unsettled:
        return ()
    text = "{} critical wind speeds are left out, since the static states of the blown-out span did not lead to them."
    return (text.format(unsettled),)
