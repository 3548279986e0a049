"""What became of each sample: whether it gallops at each wind speed, how far, and from which onset."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from engine.arrays import FloatArray
from engine.outcome import Outcome, Stability
from engine.result import CriticalWindSpeedRow, LimitCycleRow, Result
from engine.risk.expectation import Motion
from engine.risk.winds import WindRanges

_BEYOND = {Outcome.OUTSIDE_FIT, Outcome.BEYOND_DATA}
DIRECTIONS = ("vertical_m", "horizontal_m", "torsional_rad")


class State(StrEnum):
    """What a sample does. Only the first three are answers.

    SIZE_UNKNOWN: it gallops, and no stable motion is known, as where nothing bounds the motion.
    """

    GALLOPS = "gallops"
    SIZE_UNKNOWN = "size_unknown"
    RESTS = "rests"
    UNKNOWN = "unknown"
    STATICALLY_UNSTABLE = "statically_unstable"
    IMPOSSIBLE = "impossible"


@dataclass(frozen=True, slots=True)
class AtWind:
    """A sample at one wind speed, or at all of them.

    amplitudes: largest of stable motions by direction [m, m, rad]: 0 at rest, infinite where a galloping span's is not
    known, so that it never passes for small, NaN without an answer; beyond_data: whether one of these motions leaves
    what the input vouches for.
    """

    state: State
    amplitudes: tuple[float, float, float]
    beyond_data: bool = False


@dataclass(frozen=True, slots=True)
class SampleOutcome:
    """A sample at each wind speed and at all of them; onset [m/s]: infinite without one, NaN if not known.

    ranges: of the wind across the line in which it gallops, where a risk is asked for.
    """

    onset: float
    winds: tuple[AtWind, ...]
    overall: AtWind
    ranges: Mapping[Motion, WindRanges] | None = None


NOTHING = (np.nan, np.nan, np.nan)
ANY = (np.inf, np.inf, np.inf)


def without_answer(state: State, winds: int) -> SampleOutcome:
    """Return the outcome of a sample that has no result."""
    return SampleOutcome(np.nan, (AtWind(state, NOTHING),) * winds, AtWind(state, NOTHING))


def sample_outcome(result: Result, wind_speeds: Sequence[float]) -> SampleOutcome:
    """Read the outcome of a sample off its result.

    Parameters
    ----------
    result : Result
    wind_speeds : sequence of float
        Those asked for, rising [m/s].
    """
    rows: dict[float, list[LimitCycleRow]] = {speed: [] for speed in wind_speeds}
    for row in result.limit_cycles:
        rows[min(rows, key=lambda speed: abs(speed - row.wind_speed_m_per_s))].append(row)
    onset = _onset(result.critical_wind_speeds)
    winds = tuple(_at_wind(found, onset) for found in rows.values())
    overall = _overall(result, winds)
    failed = any(row.outcome is not Outcome.CONVERGED for row in result.frequencies)
    return SampleOutcome(np.nan if failed or overall.state is State.STATICALLY_UNSTABLE else onset, winds, overall)


def _onset(rows: Sequence[CriticalWindSpeedRow]) -> float:
    onsets = (row.wind_speed_m_per_s for row in rows if row.crossing == "onset" and row.type == "oscillation")
    return min(onsets, default=np.inf)


def _at_wind(rows: Sequence[LimitCycleRow], onset: float) -> AtWind:
    """Judge a wind speed: an answer of one number of loops that it gallops outweighs all others."""
    outcomes = {row.outcome for row in rows}
    moving = [row for row in rows if row.kind != "equilibrium" and row.stability is Stability.STABLE]
    rests = [row for row in rows if row.kind == "equilibrium"]
    shaken = any(
        row.stability is Stability.UNSTABLE and onset <= row.wind_speed_m_per_s for row in rests
    )  # by an oscillation: a divergence alone starts no motion
    unknown = any(row.vertical_m is None for row in rows)
    if moving and not unknown:
        return AtWind(State.GALLOPS, _largest(moving), any(row.outcome in _BEYOND for row in moving))
    if moving or shaken or Outcome.NO_BOUNDED_MOTION in outcomes:
        return AtWind(State.SIZE_UNKNOWN, ANY, beyond_data=True)
    if Outcome.STATICALLY_UNSTABLE in outcomes:
        return AtWind(State.STATICALLY_UNSTABLE, NOTHING)
    if unknown or not rests or any(row.stability is not Stability.STABLE for row in rests):
        return AtWind(State.UNKNOWN, NOTHING)
    return AtWind(State.RESTS, (0.0, 0.0, 0.0))


def _largest(moving: Sequence[LimitCycleRow]) -> tuple[float, float, float]:
    sizes = [[getattr(row, name) or 0.0 for name in DIRECTIONS] for row in moving]
    vertical, horizontal, torsional = np.max(sizes, axis=0).tolist()
    return vertical, horizontal, torsional


def _overall(result: Result, winds: Sequence[AtWind]) -> AtWind:
    """Judge all wind speeds as the verdict does: it also gallops with an onset between two of them."""
    states = {wind.state for wind in winds}
    (verdict,) = result.verdict
    beyond = any(wind.beyond_data for wind in winds)
    every = np.array([wind.amplitudes for wind in winds]).reshape(-1, len(DIRECTIONS))
    largest: FloatArray = np.max(every, axis=0, initial=0.0)
    vertical, horizontal, torsional = largest.tolist()
    if verdict.gallops == "yes" or states & {State.GALLOPS, State.SIZE_UNKNOWN}:
        if np.isfinite(largest).all() and winds:
            return AtWind(State.GALLOPS, (vertical, horizontal, torsional), beyond)
        return AtWind(State.SIZE_UNKNOWN, ANY, beyond)
    if verdict.gallops == "no":
        return AtWind(State.RESTS, (vertical, horizontal, torsional), beyond)
    ended = {row.outcome for row in result.frequencies} | {row.outcome for row in result.limit_cycles}
    return AtWind(State.STATICALLY_UNSTABLE if Outcome.STATICALLY_UNSTABLE in ended else State.UNKNOWN, NOTHING)
