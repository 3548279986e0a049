"""Analyse a line as an engineer knows it together with samples of what is assumed of it."""

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace

from app.convert.known.to_document import document_number, document_path, result_rows
from engine import spec
from engine.analysis import analyse
from engine.known.description import KnownLine
from engine.known.provenance import Assumption
from engine.known.resolve import resolve
from engine.progress import Progress
from engine.result import Result, SensitivityRow
from engine.uncertainty.weighing import Unknowns, analyse_with_samples, intervals, with_samples

TIED = (
    "What is assumed was not sampled: phases that interphase spacers tie need the finite element model, "
    "and samples have the hybrid one."
)


def analyse_known(
    known: KnownLine, line: spec.Line, analysis: spec.Analysis, asked: spec.Uncertainty
) -> Generator[Progress, None, Result]:
    """Analyse a line with samples, all of which are resolved from what is known of it.

    Parameters
    ----------
    known : KnownLine
    line : Line
        What `known` resolves to, with the section of the analysis.
    analysis : Analysis
    asked : Uncertainty

    Returns
    -------
    Result
        With the document's names and units of the assumed values.
    """
    if line.interphase_spacers and asked.samples:
        return _unsampled((yield from analyse(line, analysis)))
    assumptions = resolve(known).assumptions
    steps = analyse_with_samples(line, analysis, _unknowns(known, assumptions, analysis), asked)
    return in_document_names((yield from steps), assumptions)


@dataclass(frozen=True, slots=True)
class Analysed:
    """A line with its analysis, and the rows of its `end_stiffnesses`, which are computed for many lines together."""

    line: spec.Line
    analysis: spec.Analysis
    ends: Sequence[Assumption]


def with_what_is_known(
    result: Result, analysed: Analysed, known: KnownLine, asked: spec.Uncertainty | None
) -> Generator[Progress, None, Result]:
    """Return the finished result of a line with its assumptions and, where samples are asked for, their tables."""
    assumptions = resolve(known).assumptions
    listed = replace(result, assumptions=result_rows((*assumptions, *analysed.ends)))
    if asked is None or asked.samples == 0:
        return listed
    line, analysis = analysed.line, analysed.analysis
    if line.interphase_spacers:
        return _unsampled(listed)
    steps = with_samples(listed, line, analysis, _unknowns(known, assumptions, analysis), asked)
    return in_document_names((yield from steps), assumptions)


def _unsampled(result: Result) -> Result:
    return replace(result, warnings=(*result.warnings, TIED))


def _unknowns(known: KnownLine, assumptions: Sequence[Assumption], analysis: spec.Analysis) -> Unknowns:
    def line_of(chosen: Mapping[str, float]) -> spec.Line:
        return spec.with_section(resolve(known, chosen).line, analysis.physics)

    return Unknowns(intervals(assumptions), line_of)


def in_document_names(result: Result, assumptions: Sequence[Assumption]) -> Result:
    """Return a result with the document's names and units of the assumed values."""
    units = {row.path: row.unit for row in assumptions}
    verdicts = tuple(
        row if row.what_decides is None else replace(row, what_decides=document_path(row.what_decides))
        for row in result.verdict
    )
    rows = tuple(_in_document_units(row, units[row.path]) for row in result.sensitivities)
    return replace(result, verdict=verdicts, sensitivities=rows)


def _in_document_units(row: SensitivityRow, unit: str) -> SensitivityRow:
    lowest, highest = (None if end is None else document_number(end, unit) for end in (row.lowest, row.highest))
    return replace(row, path=document_path(row.path), lowest=lowest, highest=highest)
