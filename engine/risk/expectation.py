"""Expected hours and probability of galloping a year: wind ranges of a line, weighted by its climate."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine.result import Result, RiskRow
from engine.risk.recorded import Range, recorded_hours, recorded_probability
from engine.risk.violations import asks_for_clearance, violation_ranges
from engine.risk.wind_speeds import share_of_time
from engine.risk.winds import Interval, WindRanges, united, wind_ranges
from engine.spec import Analysis, Climate, IcedRecord, Icing, Line, Model, Ranged

PERSISTENCE_HOURS = Ranged(6.0, 1.0)  # assumed: the wind keeps its speed from one hour to the whole event
QUANTILES = (0.025, 0.975)

Motion = tuple[Model, int | None]
"""A model and a number of loops, None for any."""

_Label = tuple[str | None, float | None]
"""Kind and thickness of the ice."""


@dataclass(frozen=True, slots=True)
class _Exposure:
    """What one kind of icing makes of a line: hours of galloping a year, unknown hours, and probability of a year."""

    hours: Range
    unknown: float
    probability: Range | None


def risk_rows(result: Result, line: Line, analysis: Analysis) -> tuple[RiskRow, ...]:
    """Return the risk of a line as its result shows it; empty without a climate, or if it is not asked for.

    Parameters
    ----------
    result : Result
        With critical wind speeds, motions and bifurcations.
    line : Line
    analysis : Analysis
    """
    if line.climate is None or not analysis.risk:
        return ()
    rows = rows_over_samples([ranges_across(result, line, analysis)], line.climate)
    if not asks_for_clearance(result):
        return rows
    violating = rows_over_samples([ranges_across(result, line, analysis, violating=True)], line.climate)
    return tuple(
        replace(
            row,
            violation_hours_a_year=other.hours_a_year,
            violation_hours_highest=other.hours_highest,
            violation_probability_a_year=other.probability_a_year,
        )
        for row, other in zip(rows, violating, strict=True)
    )


def ranges_across(
    result: Result, line: Line, analysis: Analysis, *, violating: bool = False
) -> dict[Motion, WindRanges]:
    """Return the ranges of the wind across the line in which it gallops, for each model and number of loops, and any.

    Or, violating, those in which it breaks a required clearance.

    The component across the line alone drives the motion (conventions, yaw), so speeds of a yawed wind shrink to it.
    """
    across = math.cos(line.wind.yaw)
    found: dict[Motion, WindRanges] = {}
    for model in analysis.models:
        own = [row.loops for row in result.limit_cycles if row.model == model]
        own += [row.loops for row in result.critical_wind_speeds if row.model == model]
        of_loops: dict[int, WindRanges] = {}
        for loops in sorted({*own, *analysis.loops}):
            ranges = wind_ranges(result, analysis, model, loops)
            kept = violation_ranges(result, analysis, model, loops, ranges) if violating else ranges
            of_loops[loops] = kept.scaled(across)
        if model is Model.FINITE_ELEMENT and not own:
            continue  # only its frequencies were asked for
        found |= {(model, n): ranges for n, ranges in of_loops.items()}
        found[model, None] = united(of_loops.values())
    return found


def rows_over_samples(samples: Sequence[Mapping[Motion, WindRanges]], climate: Climate) -> tuple[RiskRow, ...]:
    """Return the expectation over samples of a line.

    Parameters
    ----------
    samples : sequence of mappings
        Of each sample, as `ranges_across` returns it, all with the same keys.
    climate : Climate
    """
    rows: list[RiskRow] = []
    for motion in samples[0]:
        if climate.record is not None:
            recorded = _over_samples([_recorded(sample[motion], climate.record) for sample in samples])
            rows.append(_row(motion, (None, None), recorded, len(samples)))
            continue
        of_ice = [
            _over_samples([_exposure(sample[motion], climate, ice) for sample in samples]) for ice in climate.icing
        ]
        labels: list[_Label] = [(ice.kind, ice.thickness) for ice in climate.icing]
        if len(of_ice) > 1:
            of_ice, labels = [*of_ice, _together(of_ice)], [*labels, (None, None)]
        rows += (_row(motion, label, one, len(samples)) for label, one in zip(labels, of_ice, strict=True))
    return tuple(rows)


def _exposure(ranges: WindRanges, climate: Climate, icing: Icing) -> _Exposure:
    known = share_of_time(climate, ranges.moving)
    possible = share_of_time(climate, _sorted(ranges.moving, ranges.unknown))
    hours, (fewest, most) = icing.hours_a_year.value, icing.hours_a_year.ends
    return _Exposure(
        hours=(hours * known[0], fewest * known[1], most * possible[2]),
        unknown=hours * max(0.0, possible[0] - known[0]),
        probability=_probability(icing, (known[0], known[1], possible[2])),
    )


def _recorded(ranges: WindRanges, record: IcedRecord) -> _Exposure:
    possible = _sorted(ranges.moving, ranges.unknown)
    hours, most = recorded_hours(record, ranges.moving), recorded_hours(record, possible)
    probability, likeliest = recorded_probability(record, ranges.moving), recorded_probability(record, possible)
    return _Exposure(
        hours=(hours[0], hours[1], most[2]),
        unknown=most[0] - hours[0],
        probability=(probability[0], probability[1], likeliest[2]),
    )


def _sorted(*parts: Sequence[Interval]) -> tuple[Interval, ...]:
    return tuple(sorted(interval for part in parts for interval in part))


def _probability(icing: Icing, share: Range) -> Range | None:
    """Return the probability of a year with galloping; events come as a Poisson process.

    In an event the wind is drawn anew each time that it has kept its speed for the persistence.
    """
    if icing.events is None or icing.event_hours is None:
        return None
    kept = icing.persistence or PERSISTENCE_HOURS
    longest_kept = math.inf if icing.persistence is None else kept.ends[1]
    value = _of_year(icing.events.value, icing.event_hours.value / kept.value, share[0])
    lowest = _of_year(icing.events.ends[0], icing.event_hours.ends[0] / longest_kept, share[1])
    return value, lowest, _of_year(icing.events.ends[1], icing.event_hours.ends[1] / kept.ends[0], share[2])


def _of_year(events: float, draws: float, share: float) -> float:
    """Return the probability of a year with `events` events to expect, each of so many draws (at least one)."""
    return -math.expm1(-events * (1.0 - (1.0 - min(share, 1.0)) ** max(draws, 1.0)))


def _over_samples(exposures: Sequence[_Exposure]) -> _Exposure:
    probabilities = [one.probability for one in exposures if one.probability is not None]
    return _Exposure(
        hours=_mean([one.hours for one in exposures]),
        unknown=float(np.mean([one.unknown for one in exposures])),
        probability=_mean(probabilities) if probabilities else None,
    )


def _mean(ranges: Sequence[Range]) -> Range:
    value, lowest, highest = np.array(ranges).T
    low, high = QUANTILES
    return float(value.mean()), float(np.quantile(lowest, low)), float(np.quantile(highest, high))


def _together(exposures: Sequence[_Exposure]) -> _Exposure:
    """Return all kinds of icing together: they exclude one another in time, and their events are independent."""
    value, lowest, highest = np.sum([one.hours for one in exposures], axis=0).tolist()
    known = [one.probability for one in exposures if one.probability is not None]
    whole = None
    if len(known) == len(exposures):
        never = np.prod(1.0 - np.array(known), axis=0)
        whole = (float(1.0 - never[0]), float(1.0 - never[1]), float(1.0 - never[2]))
    return _Exposure((value, lowest, highest), math.fsum(one.unknown for one in exposures), whole)


def _row(motion: Motion, label: _Label, exposure: _Exposure, samples: int) -> RiskRow:
    probability, lowest, highest = exposure.probability or (None, None, None)
    return RiskRow(
        model=motion[0],
        loops=motion[1],
        ice=label[0],
        thickness_m=label[1],
        hours_a_year=exposure.hours[0],
        hours_lowest=exposure.hours[1],
        hours_highest=exposure.hours[2],
        unknown_hours_a_year=exposure.unknown,
        probability_a_year=probability,
        probability_lowest=lowest,
        probability_highest=highest,
        violation_hours_a_year=None,
        violation_hours_highest=None,
        violation_probability_a_year=None,
        samples=samples,
    )
