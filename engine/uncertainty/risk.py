"""The risk of a line over samples of what is assumed of it."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

from engine.result import RiskRow
from engine.risk.expectation import Motion, rows_over_samples
from engine.risk.winds import WindRanges
from engine.spec import Climate
from engine.uncertainty.outcomes import SampleOutcome, State

_OF_CLEARANCES = ("violation_hours_a_year", "violation_hours_highest", "violation_probability_a_year")
_NOTHING_KNOWN = WindRanges((), ((0.0, math.inf),))


def risk_over_samples(
    alone: Sequence[RiskRow], samples: Sequence[SampleOutcome], climate: Climate
) -> tuple[RiskRow, ...]:
    """Return the risk with its expectation over samples in the place of the rows of the same model of the line alone.

    A sample without an answer gallops at unknown wind speeds, and one that cannot exist does not count.

    Parameters
    ----------
    alone : sequence of RiskRow
        Of the line with its values as assumed.
    samples : sequence of SampleOutcome
    climate : Climate
    """
    possible = [sample.ranges for sample in samples if sample.overall.state is not State.IMPOSSIBLE]
    motions = dict.fromkeys(motion for ranges in possible for motion in ranges or ())
    if not motions:
        return tuple(alone)
    rows = rows_over_samples([_all_of(motions, ranges or {}) for ranges in possible], climate)
    sampled = {row.model for row in rows}
    own = {(row.model, row.loops, row.ice, row.thickness_m): row for row in alone}
    kept = [_with_violations(row, own.get((row.model, row.loops, row.ice, row.thickness_m))) for row in rows]
    return (*kept, *(row for row in alone if row.model not in sampled))


def _with_violations(row: RiskRow, alone: RiskRow | None) -> RiskRow:
    """Return a row with the violations of the line alone, because samples have no clearances."""
    return row if alone is None else replace(row, **{name: getattr(alone, name) for name in _OF_CLEARANCES})


def _all_of(motions: Mapping[Motion, None], ranges: Mapping[Motion, WindRanges]) -> dict[Motion, WindRanges]:
    return {motion: ranges.get(motion, _NOTHING_KNOWN) for motion in motions}
