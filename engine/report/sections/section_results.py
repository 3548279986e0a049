"""The result of one section, assembled from its tables."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any

import numpy as np

from engine import ENGINE_VERSION
from engine.assemblies.assembled_line import AssembledLine
from engine.report.amplitude_curves import amplitude_curve_rows
from engine.report.bifurcations import bifurcation_rows
from engine.report.comparisons.model_comparisons import model_comparisons
from engine.report.critical_wind_speeds import critical_wind_speed_rows
from engine.report.findings import ModelFindings
from engine.report.frequencies import NaturalFrequencies, frequency_rows
from engine.report.limit_cycles import limit_cycle_rows
from engine.report.line_results import cycles_and_orbits, den_hartog, physics_row, static_state
from engine.report.observers.section_observer import SectionObserver
from engine.report.tensions import motion_tensions, tension_rows
from engine.report.warnings import (
    dropped_warnings,
    fit_warnings,
    line_warnings,
    motion_warnings,
    neglected_twist_warnings,
    physics_warnings,
    section_warnings,
    twist_warnings,
)
from engine.result import CriticalWindSpeedRow, DenHartog, Result, SectionModeRow
from engine.spec import AmplitudeCurves, Analysis


@dataclass(frozen=True, slots=True)
class SectionFindings:
    """Everything that was found for one section.

    modes: rows of the models asked for; frequencies: one for each part of each model; findings: one for each model
    whose motions are asked for; lowest: lowest vertical frequency [Hz].
    """

    whole: AssembledLine
    modes: Sequence[SectionModeRow]
    frequencies: Sequence[NaturalFrequencies]
    findings: Sequence[ModelFindings]
    lowest: float


def section_result(found: SectionFindings, analysis: Analysis, observer: SectionObserver | None = None) -> Result:
    """Return the result of one section, or of another assembly that is observed in its own way."""
    whole, observer = found.whole, observer or SectionObserver(found.whole)
    lowest = np.array([found.lowest])
    findings = [(one, motion_tensions(observer, one)) for one in found.findings]
    motions = list(chain(*(limit_cycle_rows(observer, one, own, analysis, lowest)[0] for one, own in findings)))
    motions.sort(key=lambda motion: motion[0].model != "hybrid")
    cycles, orbits = cycles_and_orbits(motions)
    reported = found.findings if analysis.amplitude_curves is AmplitudeCurves.REPORTED else ()
    tables: dict[str, tuple[Any, ...]] = {
        "frequencies": _joined(frequency_rows(table, analysis.loops)[0] for table in found.frequencies),
        "section_modes": tuple(found.modes),
        "critical_wind_speeds": _joined(_critical_wind_speeds(observer, one) for one in found.findings),
        "limit_cycles": cycles,
        "tensions": _joined(tension_rows(observer, one, own)[0] for one, own in findings),
        "bifurcations": _joined(bifurcation_rows(one)[0] for one in found.findings),
        "amplitude_curves": _joined(amplitude_curve_rows(observer, one)[0] for one in reported),
        "model_comparisons": model_comparisons(cycles),
    }
    about_line = _warnings(found, analysis)
    return Result(
        static=_static_state(whole),
        den_hartog=_smallest([den_hartog(whole.members, i) for i in range(whole.assembly.members)]),
        physics=(physics_row(whole.line, analysis),),
        orbits=orbits,
        warnings=tuple(dict.fromkeys([*about_line, *fit_warnings(cycles, analysis), *motion_warnings(cycles)])),
        engine_version=ENGINE_VERSION,
        **tables,
    )


def _joined(parts: Any) -> tuple[Any, ...]:
    return tuple(chain(*parts))


def _static_state(whole: AssembledLine) -> Any:
    """Return the static state of the span of interest, with the twist of largest size of any span."""
    twists = [static_state(whole.members, i).twist_rad for i in range(whole.assembly.members)]
    known = [twist for twist in twists if twist is not None]
    largest = max(known, key=abs) if len(known) == len(twists) and known else None
    return replace(static_state(whole.members, whole.interest), twist_rad=largest)


def _smallest(found: Sequence[DenHartog]) -> DenHartog:
    return min(found, key=lambda one: one.coefficient)


def _critical_wind_speeds(observer: SectionObserver, findings: ModelFindings) -> list[CriticalWindSpeedRow]:
    """Return the rows of crossings with the span that moves most, from the coordinate that moves most."""
    crossings = findings.crossings
    loops = tuple(np.unique(findings.loops).tolist())
    rows = critical_wind_speed_rows(findings, loops, np.zeros((1, len(loops))))[0]
    m = findings.model.mass.shape[-1]
    none = np.zeros((crossings.member.size, 1, 2 * m))
    observed = observer.moving(findings, crossings.member, crossings.coordinate, none)
    return [
        replace(row, span=span, span_shares=shares)
        for row, span, shares in zip(rows, observed.span, observed.shares, strict=True)
    ]


def _warnings(found: SectionFindings, analysis: Analysis) -> list[str]:
    whole, members = found.whole, found.whole.members
    unstable = any(bool(one.model.statically_unstable.any()) for one in found.findings)
    every = np.full(whole.assembly.members, unstable)
    dropped = [dropped_warnings(one, 1)[0] for one in found.findings]
    return [
        *chain(*(line_warnings(line) for line in members.lines)),
        *physics_warnings(whole.line, analysis),
        *chain(*(twist_warnings(members, i) for i in range(whole.assembly.members))),
        *chain(*neglected_twist_warnings(members, every)),
        *section_warnings(whole.line, analysis),
        *chain(*dropped),
    ]
