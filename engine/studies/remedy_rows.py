"""The table `remedies`: the line as it is and with each remedy, in figures and in words."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from engine.outcome import Stability
from engine.report.cells import finite_or_none
from engine.result import Change, RemedyRow, Result
from engine.spec import Analysis, Line, Model, Remedy
from engine.studies.arrangements import Places
from engine.studies.judgement import Figures, common_models, compared, figures
from engine.studies.remedy_words import what_is_done, what_it_does
from engine.uncertainty.estimates import probability, quantile, sizes, wilson
from engine.uncertainty.outcomes import SampleOutcome, State


@dataclass(frozen=True, slots=True)
class Tried:
    """A remedy with its line, places [m], result and samples; without a line a search found no improvement.

    arrangements: how many a search computed, None where places were given.
    """

    remedy: Remedy
    change: Change = "undecided"
    line: Line | None = None
    places: Places | None = None
    arrangements: int | None = None
    result: Result | None = None
    outcomes: tuple[SampleOutcome, ...] = ()


def remedy_rows(
    without: Result, outcomes: Sequence[SampleOutcome], tried: Sequence[Tried], analysis: Analysis
) -> tuple[RemedyRow, ...]:
    """Return the row of the line as it is, then one for each remedy in the order of the request.

    Parameters
    ----------
    without : Result
        The line as it is.
    outcomes : sequence of SampleOutcome
        Of its samples.
    tried : sequence of Tried
    analysis : Analysis
    """
    first = RemedyRow(
        remedy=None,
        kind="none",
        what="The line as it is",
        places=None,
        change=None,
        rank=None,
        onset_change_m_per_s=None,
        motion_change=None,
        arrangements=None,
        **_figures(without, common_models(without), analysis),
        **_samples(outcomes),
        **_compared(outcomes, ()),
        sentence=without.verdict[0].sentence,
    )
    rows = [_row(number, one, without, outcomes, analysis) for number, one in enumerate(tried)]
    return (first, *_ranked(rows))


def _row(
    number: int, tried: Tried, without: Result, outcomes: Sequence[SampleOutcome], analysis: Analysis
) -> RemedyRow:
    seen = tried.result or without
    models = common_models(without, seen)
    own, before = _figures(seen, models, analysis), _figures(without, models, analysis)
    shares = _compared(outcomes, tried.outcomes)
    return RemedyRow(
        remedy=number,
        kind=tried.remedy.kind,
        what=what_is_done(tried.remedy, tried.places, without, seen),
        places=None if tried.places is None else " ".join(f"{place:g}" for place in tried.places),
        change=tried.change,
        rank=None,
        onset_change_m_per_s=_difference(own["onset_m_per_s"], before["onset_m_per_s"]),
        motion_change=_relative(own["motion_peak_to_peak_m"], before["motion_peak_to_peak_m"]),
        arrangements=tried.arrangements,
        **own,
        **_samples(tried.outcomes),
        **shares,
        sentence=what_it_does(tried.change, before, own, shares, tried.arrangements if tried.line is None else None),
    )


def _ranked(rows: Sequence[RemedyRow]) -> Iterator[RemedyRow]:
    """Number the remedies that are better, those with equal figures alike, whatever their order."""
    keys = {row.remedy: _key(row) for row in rows if row.change == "better"}
    rising = sorted(keys.values())
    for row in rows:
        yield replace(row, rank=1 + rising.index(keys[row.remedy])) if row.remedy in keys else row


def _key(row: RemedyRow) -> tuple[float, float]:
    size = math.inf if row.motion_peak_to_peak_m is None else row.motion_peak_to_peak_m
    onset = math.inf if row.onset_m_per_s is None else row.onset_m_per_s
    return float(f"{size:.6g}"), -float(f"{onset:.6g}")


def _figures(seen: Result, models: Sequence[Model], analysis: Analysis) -> dict[str, Any]:
    """Return what a row says of a line by the models that both lines have."""
    found = [figures(seen, model, analysis) for model in models]
    onset = _worst([-one.onset for one in found])
    size = _worst([one.size for one in found if one.size is not None])
    verdict = seen.verdict[0]
    largest = [None if size is None else 2.0 * _largest(seen, models, name) for name in ("vertical_m", "horizontal_m")]
    return {
        "gallops": verdict.gallops,
        "onset_m_per_s": None if onset is None else finite_or_none(-onset),
        "vertical_peak_to_peak_m": largest[0],
        "horizontal_peak_to_peak_m": largest[1],
        "motion_peak_to_peak_m": None if size is None else finite_or_none(2.0 * size),
        "clearance_m": verdict.clearance_m,
        "clearance_margin_m": _margin(seen),
        "static_tension_n": finite_or_none(seen.static.horizontal_tension_n),
        "tension_range_n": verdict.tension_range_n,
        "trust": verdict.trust,
    }


def _worst(values: Sequence[float]) -> float | None:
    """Return the largest of the models' values; None where one of them is not known, or there is none."""
    return None if not values or any(math.isnan(value) for value in values) else max(values)


def _largest(seen: Result, models: Sequence[Model], name: str) -> float:
    rows = (row for row in seen.limit_cycles if row.model in models and row.stability is Stability.STABLE)
    return max((getattr(row, name) or 0.0 for row in rows), default=0.0)


def _margin(result: Result) -> float | None:
    if result.verdict[0].clearance_m is None:
        return None
    rows = (row for row in result.clearances if row.method == "computed" and row.stability is Stability.STABLE)
    return min((row.margin_m for row in rows if row.margin_m is not None), default=None)


def _samples(outcomes: Sequence[SampleOutcome]) -> dict[str, Any]:
    """Return what a row says of the samples of one line."""
    overall = [one.overall for one in outcomes]
    possible = [one for one in overall if one.state is not State.IMPOSSIBLE]
    vertical = [2.0 * size for size in sizes(overall, 0)]
    return {
        "probability_gallops": probability([one.state for one in overall]) if overall else None,
        "onset_p50_m_per_s": quantile([one.onset for one in outcomes], 0.5),
        "vertical_p50_m": quantile(vertical, 0.5),
        "vertical_p95_m": quantile(vertical, 0.95),
        "samples": len(possible),
    }


def _compared(without: Sequence[SampleOutcome], changed: Sequence[SampleOutcome]) -> dict[str, Any]:
    """Return the shares of the samples in which a remedy is better or worse; nothing without samples of both lines."""
    pairs = [
        (one, other) for one, other in zip(without, changed, strict=False) if one.overall.state is not State.IMPOSSIBLE
    ]
    names = ("improves", "improves_lowest", "improves_highest", "worsens", "undecided_samples")
    if not pairs:
        return dict.fromkeys(names)
    changes = [compared(_of_sample(one), _of_sample(other)) for one, other in pairs]
    better, count = changes.count("better"), len(changes)
    lowest, highest = wilson(better, count)
    shares = (better / count, lowest, highest, changes.count("worse") / count, changes.count("undecided") / count)
    return dict(zip(names, shares, strict=True))


def _of_sample(outcome: SampleOutcome) -> Figures:
    vertical, horizontal, _ = outcome.overall.amplitudes
    return Figures(outcome.onset, math.hypot(vertical, horizontal) if outcome.winds else None)


def _difference(own: float | None, before: float | None) -> float | None:
    return None if own is None or before is None else own - before


def _relative(own: float | None, before: float | None) -> float | None:
    return None if own is None or not before else own / before - 1.0
