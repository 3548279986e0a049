"""The tables `uncertainty` and `sensitivities`."""

import math
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from engine.arrays import FloatArray
from engine.report.cells import finite_or_none
from engine.result.uncertainty import Distribution, SensitivityRow, UncertaintyRow
from engine.spec import Analysis, Uncertainty
from engine.uncertainty.estimates import change, probability, probability_interval, quantile, sizes
from engine.uncertainty.indices import Indices, sobol_indices
from engine.uncertainty.inputs import Choice, Uncertain
from engine.uncertainty.outcomes import DIRECTIONS, AtWind, SampleOutcome, State
from engine.uncertainty.sampling import Samples

TOLD = 0.5  # share of the variance that an expansion must explain for its indices to be reported
SHARES = {"p05": 0.05, "p50": 0.5, "p95": 0.95}


def uncertainty_rows(
    outcomes: Sequence[SampleOutcome], wind_speeds: Sequence[float], asked: Uncertainty
) -> tuple[UncertaintyRow, ...]:
    """Return the row about all wind speeds, then one for each of them."""
    onsets = [one.onset for one in outcomes]
    rows = [_row(None, [one.overall for one in outcomes], onsets, asked)]
    for i, speed in enumerate(wind_speeds):
        rows.append(_row(speed, [one.winds[i] for one in outcomes], onsets, asked))
    return tuple(rows)


def _row(speed: float | None, winds: Sequence[AtWind], onsets: Sequence[float], asked: Uncertainty) -> UncertaintyRow:
    states = [wind.state for wind in winds]
    lowest, highest = probability_interval(states)
    quantiles: dict[str, Any] = {}
    for name, share in SHARES.items():
        quantiles[f"onset_{name}_m_per_s"] = quantile(onsets, share)
        for i, direction in enumerate(DIRECTIONS):
            quantiles[direction.replace("_", f"_{name}_")] = quantile(sizes(winds, i), share)
    counts: dict[str, Any] = {state.value: states.count(state) for state in State}
    median = partial(quantile, share=0.5)
    return UncertaintyRow(
        wind_speed_m_per_s=speed,
        probability=probability(states),
        probability_lowest=lowest,
        probability_highest=highest,
        probability_change=change(probability, states),
        onset_p50_change_m_per_s=change(median, onsets),
        vertical_p50_change_m=change(median, sizes(winds, 0)),
        **quantiles,
        **counts,
        beyond_data=sum(wind.beyond_data for wind in winds),
        samples=len(winds),
        seed=asked.seed,
    )


def ends(inputs: Sequence[Uncertain]) -> list[list[dict[str, float]]]:
    """Return what to choose for the ends of each input: its lowest and highest value, or each possibility in turn."""
    return [
        [{one.path: float(i)} for i in range(len(one.weights))]
        if isinstance(one, Choice)
        else [{one.path: one.lowest}, {one.path: one.highest}]
        for one in inputs
    ]


def sensitivity_rows(
    samples: Samples,
    outcomes: Sequence[SampleOutcome],
    at_ends: Sequence[SampleOutcome],
    analysis: Analysis,
    asked: Uncertainty,
) -> tuple[SensitivityRow, ...]:
    """Return a row for each input.

    Parameters
    ----------
    samples : Samples
    outcomes : sequence of SampleOutcome
        One for each sample.
    at_ends : sequence of SampleOutcome
        Those of all `ends`, one input after another.
    analysis : Analysis
    asked : Uncertainty
    """
    limit = analysis.critical_wind_limit
    onsets = np.log([min(one.onset, limit) for one in outcomes])
    amplitudes = np.array([one.overall.amplitudes[0] for one in outcomes])
    on_onset, onset_samples = _indices(samples, onsets, asked)
    on_amplitude, amplitude_samples = _indices(samples, amplitudes, asked)
    counts = [len(one) for one in ends(samples.inputs)]
    stops = np.cumsum([0, *counts])
    rows = []
    for i, (one, (first, last)) in enumerate(zip(samples.inputs, pairwise(stops.tolist()), strict=True)):
        own = at_ends[first:last]
        onset_ends = _ends(one, [end.onset for end in own])
        size_ends = _ends(one, [end.overall.amplitudes[0] for end in own])
        rows.append(
            SensitivityRow(
                path=one.path,
                distribution=_distribution(one),
                lowest=None if isinstance(one, Choice) else one.lowest,
                highest=None if isinstance(one, Choice) else one.highest,
                onset_at_lowest_m_per_s=onset_ends[0],
                onset_at_highest_m_per_s=onset_ends[1],
                vertical_at_lowest_m=size_ends[0],
                vertical_at_highest_m=size_ends[1],
                onset_explained=None if on_onset is None else on_onset.explained,
                amplitude_explained=None if on_amplitude is None else on_amplitude.explained,
                onset_samples=onset_samples,
                amplitude_samples=amplitude_samples,
                **dict(_shares("onset", on_onset, i)),
                **dict(_shares("amplitude", on_amplitude, i)),
            )
        )
    return tuple(rows)


def _indices(samples: Samples, values: FloatArray, asked: Uncertainty) -> tuple[Indices | None, int]:
    """Return the indices over the samples whose value is known and finite, and how many these are."""
    known = np.isfinite(values)
    found = sobol_indices(samples.inputs, samples.unit[known], values[known], asked.seed)
    return found, int(np.count_nonzero(known))


def _shares(quantity: str, found: Indices | None, number: int) -> Iterator[tuple[str, Any]]:
    told = found is not None and found.explained >= TOLD
    for order in ("first_order", "total"):
        shares = getattr(found, order) if told else None
        interval = getattr(found, f"{order}_interval") if told else None
        name = f"{quantity}_{order}"
        yield name, None if shares is None else float(shares[number])
        yield f"{name}_lowest", None if interval is None else float(interval[0, number])
        yield f"{name}_highest", None if interval is None else float(interval[1, number])


def _ends(one: Uncertain, values: Sequence[float]) -> tuple[float | None, float | None]:
    """Return what the two ends of an interval give, or the smallest and the largest value of a choice."""
    known = [value for value in values if not math.isnan(value)]
    if isinstance(one, Choice):
        first, last = min(known, default=math.nan), max(known, default=math.nan)
    else:
        first, last = values
    return finite_or_none(first), finite_or_none(last)


def _distribution(one: Uncertain) -> Distribution:
    if isinstance(one, Choice):
        return "choice"
    return "log_uniform" if one.logarithmic else "uniform"
