"""From arrays of a stack of models to the result of each line."""

import numpy as np

from engine import ENGINE_VERSION
from engine.mechanics.modes import DirectionalShapes
from engine.mechanics.static_profile import mean_mass
from engine.models.discretization import Discretization
from engine.outcome import Outcome
from engine.report.internal_resonances import internal_resonance_rows
from engine.report.limit_cycles import Motion, limit_cycle_rows
from engine.report.model_comparisons import model_comparisons
from engine.report.rows import (
    ModelFindings,
    NaturalFrequencies,
    bifurcation_rows,
    critical_wind_speed_rows,
    dropped_warnings,
    frequency_rows,
)
from engine.result import DenHartog, LimitCycleRow, LoopCompetitionRow, Orbit, Result, StaticState
from engine.spec import AirflowSpoiler, Analysis, Ice, IceSegment, Line, ice_properties

HEAVY_DEVICES = 0.1  # of the span's weight
LEAST_INERTIA = 1e-6  # about the mass centre, of that about the reference curve: below it M is nearly singular


def line_results(
    discretization: Discretization,
    shapes: DirectionalShapes,
    natural_frequencies: tuple[NaturalFrequencies, ...],
    findings: tuple[ModelFindings, ...],
    analysis: Analysis,
    competitions: list[list[LoopCompetitionRow]],
) -> list[Result]:
    """Write the result of each line.

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
        A list a line.

    Returns
    -------
    list of Result
        In the order of the lines.
    """
    lowest = np.nanmin(shapes.angular_frequency[:, :, 0], axis=1, initial=np.inf) / (2.0 * np.pi)
    frequencies = [frequency_rows(table, analysis.loops) for table in natural_frequencies]
    critical = [critical_wind_speed_rows(model_findings) for model_findings in findings]
    bifurcations = [bifurcation_rows(model_findings) for model_findings in findings]
    motions = [limit_cycle_rows(discretization, model_findings, analysis.loops, lowest) for model_findings in findings]
    dropped = [dropped_warnings(model_findings, len(discretization.lines)) for model_findings in findings]
    results = []
    for i, line in enumerate(discretization.lines):
        cycles, orbits = _cycles_and_orbits([motion for table in motions for motion in table[i]])
        outside = sum(cycle.outcome is Outcome.OUTSIDE_FIT for cycle in cycles)
        fit = [f"{outside} cycles leave the range of angles to which the coefficients were fitted."] if outside else []
        about_line = line_warnings(line) + _twist_warnings(discretization, i)
        own_frequencies = tuple(row for table in frequencies for row in table[i])
        results.append(
            Result(
                static=_static_state(discretization, i),
                den_hartog=_den_hartog(discretization, i),
                frequencies=own_frequencies,
                internal_resonances=internal_resonance_rows(own_frequencies),
                critical_wind_speeds=tuple(row for table in critical for row in table[i]),
                limit_cycles=cycles,
                bifurcations=tuple(row for table in bifurcations for row in table[i]),
                model_comparisons=model_comparisons(cycles),
                loop_competitions=tuple(competitions[i]),
                orbits=orbits,
                warnings=(*about_line, *fit, *(text for table in dropped for text in table[i])),
                engine_version=ENGINE_VERSION,
            )
        )
    return results


def line_warnings(line: Line) -> list[str]:
    """Say what of a line lies outside the assumptions of the static profile."""
    result = []
    weight = mean_mass(line) * line.span.length * len(line.bundle.positions)
    spoilers = [d for d in line.devices if isinstance(d, AirflowSpoiler)]
    point_mass = sum(d.mass for d in line.devices if not isinstance(d, AirflowSpoiler))
    spread_mass = sum(d.mass * (d.stop - d.start) for d in spoilers) * len(line.bundle.positions)
    share = (point_mass + spread_mass) / weight
    if share > HEAVY_DEVICES:
        result.append(
            f"The devices weigh {share:.0%} of the span; the static profile leaves their weight out, which holds "
            f"below {HEAVY_DEVICES:.0%}."
        )
    masses = [line.conductor.mass, *(s.mass for s in line.ice.segments if s.mass is not None)]
    if max(masses) > (1.0 + HEAVY_DEVICES) * min(masses):
        result.append("The ice mass varies along the span; the static profile takes its mean.")
    pieces: list[Ice | IceSegment] = [line.ice, *line.ice.segments]
    share = min(_inertia_share(line, piece) for piece in pieces)
    if share < LEAST_INERTIA:
        result.append(
            f"The inertia about the mass centre is {share:.1e} of that about the reference curve: the mass matrix is "
            "ill-conditioned, and torsional frequencies and motions lose as many digits."
        )
    return result


def _inertia_share(line: Line, piece: Ice | IceSegment) -> float:
    """Return the section's polar inertia about its mass centre over that about the reference curve."""
    e_y, e_z, mass = ice_properties(line, piece)
    centres = np.add(line.bundle.positions, (e_y, e_z))
    own = line.conductor.polar_inertia - mass * (e_y**2 + e_z**2)
    about_mass_centre = own + mass * centres.var(axis=0).sum()
    return float(about_mass_centre / (own + mass * (centres**2).sum(axis=-1).mean()))


def _cycles_and_orbits(motions: list[Motion]) -> tuple[tuple[LimitCycleRow, ...], tuple[Orbit, ...]]:
    orbits = []
    for i, motion in enumerate(motions):
        if motion.series is not None:
            vertical, horizontal, torsional = (tuple(row) for row in motion.series.tolist())
            orbits.append(Orbit(i, vertical, horizontal, torsional))
    return tuple(motion.row for motion in motions), tuple(orbits)


def _den_hartog(discretization: Discretization, line: int) -> DenHartog:
    """Return the smallest a_y1 on the span: with partial ice, one piece below zero is what feeds the motion."""
    here = discretization.sections.local_weight[line] > 0.0
    coefficient = float(discretization.sections.aerodynamics[line, here, 0, 1].min())
    return DenHartog(coefficient, coefficient < 0.0)


def _static_state(discretization: Discretization, line: int) -> StaticState:
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
    """Return the static twist of largest size [rad], None where it is neglected or was not found."""
    if discretization.twist is None or discretization.twist.outcome[line] is not Outcome.CONVERGED:
        return None
    angle = discretization.twist.angle[line]
    return float(angle[np.abs(angle).argmax()])


def _twist_warnings(discretization: Discretization, line: int) -> list[str]:
    if discretization.twist is None or discretization.twist.outcome[line] is Outcome.CONVERGED:
        return []
    return ["The static twist was not found; everything is computed about the untwisted state."]
