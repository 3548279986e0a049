"""The result of each line, assembled from the tables of all its lines and models."""

from collections.abc import Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from engine import ENGINE_VERSION
from engine.arrays import BoolArray, FloatArray
from engine.mechanics.modes import DirectionalShapes, longitudinal_share
from engine.models.discretization import Discretization
from engine.models.stretching import relieved_share
from engine.outcome import Outcome
from engine.report.amplitude_curves import amplitude_curve_rows
from engine.report.bifurcations import bifurcation_rows
from engine.report.comparisons.model_comparisons import model_comparisons
from engine.report.critical_wind_speeds import critical_wind_speed_rows
from engine.report.findings import ModelFindings
from engine.report.frequencies import NaturalFrequencies, frequency_rows
from engine.report.internal_resonances import internal_resonance_rows
from engine.report.limit_cycles import Motion, limit_cycle_rows
from engine.report.observers.observer import SpanObserver
from engine.report.static_equilibria import static_equilibrium_rows
from engine.report.tensions import motion_tensions, tension_rows
from engine.report.warnings import (
    dropped_warnings,
    fit_warnings,
    line_warnings,
    longitudinal_warnings,
    motion_warnings,
    neglected_twist_warnings,
    physics_warnings,
    relief_warnings,
    twist_warnings,
    wind_twist_warnings,
)
from engine.result import (
    DenHartog,
    LimitCycleRow,
    LoopCompetitionRow,
    Neighbours,
    Orbit,
    PhysicsRow,
    Result,
    StaticState,
)
from engine.spec import AmplitudeCurves, Analysis, CrossSection, Line


def line_results(
    discretization: Discretization,
    shapes: DirectionalShapes,
    natural_frequencies: tuple[NaturalFrequencies, ...],
    findings: tuple[ModelFindings, ...],
    analysis: Analysis,
    competitions: list[list[LoopCompetitionRow]],
) -> list[Result]:
    """Return the result of each line.

    Parameters
    ----------
    discretization : Discretization
    shapes : DirectionalShapes
    natural_frequencies : tuple of NaturalFrequencies
        One for each model asked for.
    findings : tuple of ModelFindings
        One for each model whose motions are asked for.
    analysis : Analysis
    competitions : list of lists of LoopCompetitionRow
        One list per line.

    Returns
    -------
    list of Result
        In the order of the lines.
    """
    lowest = np.nanmin(shapes.angular_frequency[:, :, 0], axis=1, initial=np.inf) / (2.0 * np.pi)
    frequencies = [frequency_rows(table, analysis.loops) for table in natural_frequencies]
    longitudinal = longitudinal_share(discretization.matrices, shapes)
    observer = SpanObserver(discretization)
    tensions = [motion_tensions(observer, one) for one in findings]
    found = list(zip(findings, tensions, strict=True))
    motions = [limit_cycle_rows(observer, one, own, analysis, lowest) for one, own in found]
    tables: dict[str, list[Any]] = {
        "critical_wind_speeds": [critical_wind_speed_rows(one, shapes.loops, longitudinal) for one in findings],
        "tensions": [tension_rows(observer, one, own) for one, own in found],
        "bifurcations": [bifurcation_rows(one) for one in findings],
        "amplitude_curves": [amplitude_curve_rows(observer, one) for one in _with_curves(findings, analysis)],
    }
    about_lines = _warnings_about_lines(discretization, shapes.loops, longitudinal, findings, analysis)
    dropped = [dropped_warnings(one, len(discretization.lines)) for one in findings]
    equilibria = static_equilibrium_rows(discretization, np.unique(analysis.wind_speeds))
    results = []
    for i in range(len(discretization.lines)):
        cycles, orbits = cycles_and_orbits(_of_line(motions, i))
        own_frequencies = tuple(_of_line(frequencies, i))
        about_motions = fit_warnings(cycles, analysis) + motion_warnings(cycles)
        of_line: dict[str, Any] = {name: tuple(_of_line(parts, i)) for name, parts in tables.items()}
        results.append(
            Result(
                static=static_state(discretization, i),
                den_hartog=den_hartog(discretization, i),
                physics=(physics_row(discretization.lines[i], analysis),),
                frequencies=own_frequencies,
                internal_resonances=internal_resonance_rows(own_frequencies),
                static_equilibria=tuple(equilibria[i]),
                limit_cycles=cycles,
                model_comparisons=model_comparisons(cycles),
                loop_competitions=tuple(competitions[i]),
                orbits=orbits,
                warnings=(*about_lines[i], *about_motions, *_of_line(dropped, i)),
                engine_version=ENGINE_VERSION,
                **of_line,
            )
        )
    return results


def _with_curves(findings: tuple[ModelFindings, ...], analysis: Analysis) -> tuple[ModelFindings, ...]:
    """Return the findings whose amplitude curves are asked for."""
    return findings if analysis.amplitude_curves is AmplitudeCurves.REPORTED else ()


def _of_line(parts: Sequence[Sequence[Sequence[Any]]], line: int) -> list[Any]:
    """Join what each part holds for a line."""
    return [item for part in parts for item in part[line]]


def physics_row(line: Line, analysis: Analysis) -> PhysicsRow:
    """Return the physics that a line was analysed with."""
    single = len(line.bundle.positions) == 1
    names = [field.name for field in fields(PhysicsRow) if field.name not in ("section", "neighbours")]
    return PhysicsRow(
        **{name: getattr(analysis, name) for name in names},
        section=None if single else line.bundle.section or CrossSection.RIGID,
        neighbours=_neighbours(line),
    )


def _neighbours(line: Line) -> Neighbours:
    ends = line.supports.left, line.supports.right
    if line.section is not None:
        return "moving"
    if line.supports.longitudinal_stiffness is not None:
        return "given_springs"
    return "dead_ends" if all(end.dead_end for end in ends) else "static_springs"


def _warnings_about_lines(
    discretization: Discretization,
    loops: tuple[int, ...],
    longitudinal: FloatArray,
    findings: tuple[ModelFindings, ...],
    analysis: Analysis,
) -> list[list[str]]:
    """Return the warnings about each line, whatever its motions; longitudinal: as `longitudinal_share` returns it."""
    relieved = relieved_share(*discretization.parts[:3])
    neglected = neglected_twist_warnings(discretization, _statically_unstable(findings, len(discretization.lines)))
    return [
        line_warnings(line)
        + physics_warnings(line, analysis)
        + twist_warnings(discretization, i)
        + longitudinal_warnings(loops, longitudinal[i], analysis)
        + relief_warnings(analysis, float(relieved[i]))
        + neglected[i]
        + wind_twist_warnings(discretization, i)
        for i, line in enumerate(discretization.lines)
    ]


def _statically_unstable(findings: tuple[ModelFindings, ...], lines: int) -> BoolArray:
    """Return whether a model of each line is statically unstable: (lines,)."""
    unstable = np.zeros(lines, dtype=np.bool_)
    for model_findings in findings:
        unstable[model_findings.line[model_findings.model.statically_unstable]] = True
    return unstable


def cycles_and_orbits(motions: list[Motion]) -> tuple[tuple[LimitCycleRow, ...], tuple[Orbit, ...]]:
    """Return the rows of motions, and the Fourier series of those that are cycles."""
    orbits = [Orbit(i, *series) for i, (_, series) in enumerate(motions) if series is not None]
    return tuple([row for row, _ in motions]), tuple(orbits)


def den_hartog(discretization: Discretization, line: int) -> DenHartog:
    """Return the smallest a_y1 on the span: under partial ice a single piece below zero can feed the motion."""
    here = discretization.sections.local_weight[line] > 0.0
    coefficient = float(discretization.sections.aerodynamics[line, here, 0, 1].min())
    return DenHartog(coefficient, coefficient < 0.0)


def static_state(discretization: Discretization, line: int) -> StaticState:
    """Return the row of the static state of a line, by its index."""
    profile = discretization.profile
    stiffness = float(profile.end_stiffness[line].min())
    return StaticState(
        horizontal_tension_n=float(profile.horizontal_tension[line]),
        catenary_parameter_m=float(profile.catenary_parameter[line]),
        sag_m=float(profile.sag[line]),
        longitudinal_stiffness_n_per_m=stiffness if np.isfinite(stiffness) else None,
        twist_rad=_largest_twist(discretization, line),
    )


def _largest_twist(discretization: Discretization, line: int) -> float | None:
    """Return the static twist of largest size [rad], None where it is neglected or could not be computed."""
    if discretization.twist is None or discretization.twist.outcome[line] is not Outcome.CONVERGED:
        return None
    angle = discretization.twist.angle[line]
    return float(angle[np.abs(angle).argmax()])
