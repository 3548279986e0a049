"""The result of one line with the phases that are tied to it."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from engine.assemblies.phases import tied_places
from engine.report.observers.phase_observer import PhaseObserver
from engine.report.phases.phase_mode_rows import lowest_frequencies
from engine.report.phases.tied_clearances import tied_clearance_rows
from engine.report.sections.section_results import SectionFindings, section_result
from engine.result import PhaseModeRow, Result
from engine.spec import Analysis, Model

ONLY_FINITE_ELEMENT = (
    "Phases that spacers tie are analysed by the finite element model only: the hybrid model, which moves one vertical "
    "mode at a time, is left out."
)
_NAMED = ("critical_wind_speeds", "limit_cycles", "tensions", "amplitude_curves")


def phase_result(found: SectionFindings, modes: Sequence[PhaseModeRow], analysis: Analysis) -> Result:
    """Return the result of tied phases: that of an assembly, with the names of phases in the place of spans.

    found: without rows of modes and frequencies.
    """
    only = replace(analysis, models=(Model.FINITE_ELEMENT,))
    result = section_result(found, only, PhaseObserver(found.whole))
    names = list(tied_places(found.whole.line))
    tables: dict[str, Any] = {name: tuple(_named(row, names) for row in getattr(result, name)) for name in _NAMED}
    warnings = (ONLY_FINITE_ELEMENT, *result.warnings) if Model.HYBRID in analysis.models else result.warnings
    return replace(
        result,
        frequencies=lowest_frequencies(list(modes), analysis),
        phase_modes=tuple(modes),
        clearances=tuple(row for one in found.findings for row in tied_clearance_rows(found.whole, one)),
        warnings=warnings,
        **tables,
    )


def _named(row: Any, names: Sequence[str]) -> Any:
    """Return a row that says the name of a phase instead of the number of a span."""
    changes = {"phase": None if row.span is None else names[row.span - 1], "span": None}
    if hasattr(row, "span_shares"):
        changes |= {"phase_shares": row.span_shares, "span_shares": None}
    return replace(row, **changes)
