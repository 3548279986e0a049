"""The order of the steps of the analysis of one line with the phases that interphase spacers tie to it."""

from collections.abc import Generator

import numpy as np

from engine.assemblies.assembled_finite_element import assembled_finite_element
from engine.assemblies.numbered_modes import all_modes
from engine.assemblies.phase_modes import loops_of_modes, modes_of_phases
from engine.assemblies.phases import assembled_phases
from engine.cycles.harmonic_balance import Orbits
from engine.cycles.known_cycles import Starts
from engine.model_findings import ModelStack, findings_of
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel
from engine.progress import Progress
from engine.report.phases.phase_mode_rows import phase_mode_rows
from engine.report.phases.phase_results import phase_result
from engine.report.sections.section_results import SectionFindings
from engine.result import Result
from engine.spec import Analysis, Line, Model


def analyse_phases(line: Line, analysis: Analysis) -> Generator[Progress, None, Result]:
    """Analyse a line together with the phases that are tied to it, by the finite element model.

    Raises
    ------
    InvalidSpec
        As `assembled_phases`.
    """
    yield Progress(0.0, "static state and modes of the phases")
    whole = assembled_phases(line, analysis.static_twist)
    modes = all_modes(whole.assembly)
    loops = tuple(sorted({1, *analysis.loops, *analysis.finite_element_loops}))
    chosen = modes_of_phases(whole, modes, loops)
    model = assembled_finite_element(whole, modes, chosen, analysis)
    yield Progress(0.1, "critical wind speeds of the phases")
    crossings = critical_wind_speeds(model, analysis.critical_wind_limit)
    yield Progress(0.3, "limit cycles of the phases")
    winds = np.array(sorted(set(analysis.wind_speeds)), dtype=np.float64)
    own_loops = loops_of_modes(whole, modes, chosen)[None]
    stack = ModelStack(Model.FINITE_ELEMENT, model, np.zeros(1, dtype=np.intp), own_loops, crossings)
    findings = findings_of(stack, winds, _no_starts(model, analysis), analysis)
    yield Progress(0.95, "result rows")
    lowest = float(np.sqrt(max(modes.squares[chosen[0]], 0.0)) / (2.0 * np.pi)) or float("inf")
    found = SectionFindings(whole, (), (), (findings,), lowest)
    result = phase_result(found, phase_mode_rows(whole, modes, chosen), analysis)
    yield Progress(1.0, "done")
    return result


def _no_starts(model: ReducedModel, analysis: Analysis) -> Starts:
    none = np.zeros(0, dtype=np.intp)
    m, terms = model.mass.shape[-1], 2 * analysis.harmonics + 1
    return Starts(none, none, Orbits(np.zeros((0, m, terms)), np.zeros(0), np.zeros(0)))
