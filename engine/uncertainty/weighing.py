"""Analyse a line together with samples of what is assumed of it."""

from collections.abc import Generator, Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import chain

from engine.analysis import analyse
from engine.known.provenance import Assumption, Origin
from engine.progress import Progress, translated
from engine.report.verdict import verdict
from engine.result import Result
from engine.spec import Analysis, Line, Uncertainty
from engine.uncertainty.inputs import Choice, Interval, Uncertain
from engine.uncertainty.outcomes import SampleOutcome
from engine.uncertainty.risk import risk_over_samples
from engine.uncertainty.runs import LineOf, outcomes
from engine.uncertainty.sampling import sobol_samples
from engine.uncertainty.tables import ends, sensitivity_rows, uncertainty_rows

FREE_ZERO = ("rad", "degC")  # units of quantities whose zero is chosen freely
SAMPLES_SHARE = 0.7  # of the progress; the rest is the line by itself


@dataclass(frozen=True, slots=True)
class Unknowns:
    """What is uncertain of a line, and the line that follows from other values of it.

    line_of: takes values by path, those left out being as assumed, and raises `InvalidSpec` where no line follows.
    """

    inputs: tuple[Uncertain, ...]
    line_of: LineOf


@dataclass(frozen=True, slots=True)
class Weighed:
    """The result of a line, and what became of its samples: chosen values by path, and outcomes."""

    result: Result
    chosen: tuple[Mapping[str, float], ...] = ()
    outcomes: tuple[SampleOutcome, ...] = ()


def intervals(assumptions: Iterable[Assumption]) -> tuple[Uncertain, ...]:
    """Return the assumed values whose range is not a point, and choices among several, all as likely."""
    return tuple(
        Choice(row.path, row.value, (1.0,) * len(row.choices))
        if row.choices
        else Interval(row.path, row.value, row.lowest, row.highest, row.unit not in FREE_ZERO)
        for row in assumptions
        if row.origin is Origin.ASSUMED
        and row.lowest is not None
        and row.highest is not None
        and row.lowest < row.highest
    )


def analyse_with_samples(
    line: Line, analysis: Analysis, unknowns: Unknowns, asked: Uncertainty
) -> Generator[Progress, None, Result]:
    """Analyse a line, then the samples of what is assumed of it.

    Parameters
    ----------
    line : Line
        With all values as assumed.
    analysis : Analysis
    unknowns : Unknowns
    asked : Uncertainty

    Yields
    ------
    Progress
        As `analyse` does, and before every stack of samples.

    Returns
    -------
    Result
        As of `analyse`, with the tables `uncertainty` and `sensitivities`, a verdict that reads them, and the risk over
        the samples, if the line has a climate; without them,
        if nothing is uncertain or no samples are asked for.

    Raises
    ------
    InvalidSpec
        If the line itself cannot answer the analysis.
    """
    return (yield from weighed_with_samples(line, analysis, unknowns, asked)).result


def weighed_with_samples(
    line: Line, analysis: Analysis, unknowns: Unknowns, asked: Uncertainty
) -> Generator[Progress, None, Weighed]:
    """Do as `analyse_with_samples`, and return the samples with their outcomes as well."""
    if not unknowns.inputs or asked.samples == 0:
        return Weighed((yield from analyse(line, analysis)))
    result = yield from translated(analyse(line, analysis), _before)
    return (yield from translated(_sampled(result, line, analysis, unknowns, asked), _after))


def with_samples(
    result: Result, line: Line, analysis: Analysis, unknowns: Unknowns, asked: Uncertainty
) -> Generator[Progress, None, Result]:
    """Analyse the samples of what is assumed of a line whose own result is known, and return it with their tables."""
    return (yield from _sampled(result, line, analysis, unknowns, asked)).result


def _sampled(
    result: Result, line: Line, analysis: Analysis, unknowns: Unknowns, asked: Uncertainty
) -> Generator[Progress, None, Weighed]:
    if not unknowns.inputs or asked.samples == 0:
        return Weighed(result)
    samples = sobol_samples(unknowns.inputs, asked.samples, asked.seed)
    chosen = [*samples.chosen(), *chain.from_iterable(ends(samples.inputs))]
    of_line = replace(analysis, risk=analysis.risk and line.climate is not None)
    found = yield from outcomes(chosen, unknowns.line_of, of_line)
    of_samples, at_ends = found[: asked.samples], found[asked.samples :]
    winds = sorted(set(analysis.wind_speeds))
    weighed = replace(
        result,
        uncertainty=uncertainty_rows(of_samples, winds, asked),
        sensitivities=sensitivity_rows(samples, of_samples, at_ends, analysis, asked),
    )
    if of_line.risk and line.climate is not None:
        weighed = replace(weighed, risk=risk_over_samples(weighed.risk, of_samples, line.climate))
    yield Progress(1.0, "done")
    weighed = replace(weighed, verdict=(verdict(weighed, line, analysis),))
    return Weighed(weighed, tuple(chosen[: asked.samples]), tuple(of_samples))


def _before(step: Progress) -> Progress:
    return Progress((1.0 - SAMPLES_SHARE) * step.fraction, step.step)


def _after(step: Progress) -> Progress:
    return Progress(1.0 - SAMPLES_SHARE + SAMPLES_SHARE * step.fraction, step.step)
