"""The table of limit cycles: equilibrium, cycles and quasi-periodic motions at each wind speed. Theory section 8."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields
from itertools import chain, repeat
from typing import Any

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, eigenvalues
from engine.checks.data_limits import motion_outcomes
from engine.cycles.harmonic_balance import half_peak_to_peak, states
from engine.mechanics.static_profile import horizontal_position
from engine.models.critical_wind_speeds import at_wind, state_matrices, unstable_pairs
from engine.models.discretization import Discretization, nodal_motion, observation
from engine.models.relative_wind import FASTEST, largest_reach
from engine.outcome import Outcome, Stability
from engine.report.cells import finite_or_none, lists_by_line
from engine.report.findings import MissingMotions, ModelFindings, cycle_loops, missing_motions, torus_loops
from engine.report.internal_resonances import divide_by_direction, motion_shares
from engine.report.tensions import cycle_tensions, torus_tensions
from engine.result import LimitCycleRow
from engine.spec import AerodynamicModel, Analysis
from engine.tori.spectrum import amplitude_range, base_frequencies, mean_square_velocity, sampled_states

REACH_SAMPLES = 48
_UNSTABLE = Outcome.STATICALLY_UNSTABLE
_AMPLITUDES = ("vertical_m", "horizontal_m", "torsional_rad")
_SHARES = ("vertical_share", "horizontal_share", "torsional_share")
_SMALLEST = ("vertical_min_m", "horizontal_min_m", "torsional_min_rad")
_REACH = ("largest_angle_of_attack_rad", "largest_velocity_ratio")
_FREQUENCIES = ("frequency_hz", "second_frequency_hz")
_VERDICTS = (Stability.UNKNOWN, Stability.UNSTABLE, Stability.STABLE)
_NAMES = tuple(field.name for field in fields(LimitCycleRow))


@dataclass(frozen=True, slots=True)
class Motion:
    """A row and, for a cycle, its Fourier series where it is observed: (3, 2 H + 1) of V, W [m] and Theta [rad]."""

    row: LimitCycleRow
    series: FloatArray | None = None


def limit_cycle_rows(
    discretization: Discretization, findings: ModelFindings, analysis: Analysis, lowest: FloatArray
) -> list[list[Motion]]:
    """Return a row for the equilibrium, every cycle and every torus at each wind speed, one list per line.

    Parameters
    ----------
    discretization : Discretization
    findings : ModelFindings
    analysis : Analysis
        Its loops, for each of which the equilibrium has a row, and its aerodynamic model.
    lowest : (lines,)
        Lowest vertical frequency of each line [Hz].
    """
    table: list[list[Motion]] = lists_by_line(findings.line)
    scales = _Scales(
        sag=discretization.profile.sag,
        speed=lowest * discretization.profile.span_length,
        observed={k: _observed_at(discretization, k) for k in {*analysis.loops, *np.unique(findings.loops).tolist()}},
    )
    for line, motion in chain(
        _equilibria(findings, analysis.loops, scales),
        _cycles(discretization, findings, analysis.aerodynamic_model, scales),
        _quasi_periodic_motions(discretization, findings, analysis.aerodynamic_model, scales),
    ):
        table[line].append(motion)
    for motions in table:
        motions.sort(key=lambda m: (m.row.loops, m.row.wind_speed_m_per_s, m.row.kind != "equilibrium"))
    return table


@dataclass(frozen=True, slots=True)
class _Scales:
    """Static sag [m] and f L_x [m/s] of each line, and its position of observation [m] by number of loops."""

    sag: FloatArray
    speed: FloatArray
    observed: dict[int, FloatArray]


@dataclass(frozen=True, slots=True)
class _RowKeys:
    """Index of the line, number of loops and wind speed [m/s] of each row: (k,) each."""

    line: IntArray
    loops: IntArray
    wind_speed: FloatArray


def _equilibria(findings: ModelFindings, loops: tuple[int, ...], scales: _Scales) -> Iterator[tuple[int, Motion]]:
    """Yield rows of the static state, and of wind speeds where it is unstable and no stable motion is known."""
    members, winds = findings.line.size, findings.winds.size
    values = eigenvalues(at_wind(state_matrices(findings.model), np.broadcast_to(findings.winds, (members, winds))))
    size = np.abs(values).max(axis=-1, initial=0.0)
    undecided = np.abs(values.real.max(axis=-1, initial=-np.inf)) <= 1e-12 * size
    static = findings.model.statically_unstable
    growing = (unstable_pairs(values) > 0) | static[:, None]
    verdict = np.where(undecided & ~static[:, None], 0, np.where(growing, 1, 2))
    known = (findings.loops[:, :, None] == np.array(loops, dtype=np.intp)).any(axis=1)
    member, at, wind = np.nonzero(np.broadcast_to(known[:, :, None], (members, len(loops), winds)))
    keys = _RowKeys(findings.line[member], np.array(loops, dtype=np.intp)[at], findings.winds[wind])
    amplitude = np.where(static[member], np.nan, 0.0)
    labels: dict[str, Iterable[Any]] = {
        "kind": repeat("equilibrium"),
        "stability": [_VERDICTS[finite_or_none] for finite_or_none in verdict[member, wind].tolist()],
        "outcome": [_UNSTABLE if missing else Outcome.CONVERGED for missing in static[member].tolist()],
    }
    yield from _rows(findings, scales, keys, dict.fromkeys(_AMPLITUDES, amplitude), labels)
    # One row, with the loops of the first coordinate, stands for all unstable modes of a member.
    shown = np.isin(findings.loops[:, :1], loops) & ~static[:, None]
    yield from _without_motion(findings, scales, missing_motions(findings, growing & shown))


def _without_motion(findings: ModelFindings, scales: _Scales, missing: MissingMotions) -> Iterator[tuple[int, Motion]]:
    """Yield a row for each wind speed where a stable motion must exist but none is known."""
    member = missing.member
    keys = _RowKeys(findings.line[member], findings.loops[member, 0], findings.winds[missing.wind])
    labels: dict[str, Iterable[Any]] = {
        "kind": missing.kind,
        "stability": repeat(Stability.UNKNOWN),
        "outcome": missing.outcome,
    }
    return _rows(findings, scales, keys, dict.fromkeys(_AMPLITUDES, np.full(member.size, np.nan)), labels)


def _cycles(
    discretization: Discretization, findings: ModelFindings, model: AerodynamicModel, scales: _Scales
) -> Iterator[tuple[int, Motion]]:
    """Yield the rows of all cycles with their Fourier series at the point of observation."""
    cycles = findings.cycles
    if cycles.member.size == 0:
        return iter(())
    line, loops = findings.line[cycles.member], cycle_loops(findings)
    shapes = findings.model.shapes[cycles.member]
    series = np.empty((cycles.member.size, 3, cycles.orbits.coefficients.shape[-1]))
    for k in np.unique(loops):
        here = loops == k
        observed_shapes = observation(discretization, shapes[here], int(k))
        series[here] = observed_shapes.swapaxes(-1, -2) @ cycles.orbits.coefficients[here]
    state = states(cycles.orbits, 2.0 * np.pi * np.arange(REACH_SAMPLES) / REACH_SAMPLES)
    motion = nodal_motion(discretization, findings.line, findings.model.shapes, model)
    reach = largest_reach(motion, cycles.member, state)
    measures = _measures(findings, series) | dict(zip(_REACH, reach, strict=True))
    slack = cycle_tensions(discretization, findings)[:, 0] <= 0.0
    labels: dict[str, Iterable[Any]] = {
        "kind": repeat("periodic"),
        "stability": cycles.floquet.stability.tolist(),
        "branch": cycles.branch.tolist(),
        "found_by": cycles.found_by,
        "harmonics": cycles.harmonics.tolist(),
        "outcome": _slack_first(slack, _outcomes(discretization, line, measures, _is_expanded(findings, model))),
    }
    keys = _RowKeys(line, loops, cycles.orbits.wind_speed)
    return _rows(findings, scales, keys, measures, labels, series)


def _measures(findings: ModelFindings, series: FloatArray) -> dict[str, FloatArray]:
    """Return the columns of numbers that only cycles have, NaN where a number is not known."""
    cycles, confidence = findings.cycles, findings.confidence
    mass = findings.model.modal_masses[cycles.member]
    return {
        **dict(zip(_AMPLITUDES, half_peak_to_peak(series).T, strict=True)),
        **dict(zip(_SHARES, motion_shares(mass, cycles.orbits.coefficients, findings.model.direction).T, strict=True)),
        "frequency_hz": cycles.orbits.angular_frequency / (2.0 * np.pi),
        "residual": confidence.residual,
        "truncation": confidence.truncation,
        "detuning_sensitivity": confidence.detuning,
        "direct_difference": confidence.direct,
    }


def _quasi_periodic_motions(
    discretization: Discretization, findings: ModelFindings, model_of_wind: AerodynamicModel, scales: _Scales
) -> Iterator[tuple[int, Motion]]:
    """Yield the rows of all quasi-periodic motions."""
    known, model, expanded = findings.quasi_periodic, findings.model, _is_expanded(findings, model_of_wind)
    tori, member, line = known.tori, known.member, findings.line[known.member]
    frequency, _ = base_frequencies(model, member, tori)
    energy = model.modal_masses[member] * mean_square_velocity(tori)
    loops = torus_loops(findings)
    slack = torus_tensions(discretization, findings)[:, 0] <= 0.0
    motion = nodal_motion(discretization, findings.line, model.shapes, model_of_wind)
    ranges, reach = np.empty((2, 3, member.size)), np.empty((2, member.size))
    for i in range(member.size):
        one = tori.select(np.array([i]))
        series = observation(discretization, model.shapes[member[i]], int(loops[i])).T @ one.coefficients[0]
        ranges[..., i] = amplitude_range(series, one, float(frequency[i, 0]))
        reach[:, [i]] = largest_reach(motion, member[[i]], sampled_states(one))
    measures = {
        **dict(zip((*_AMPLITUDES, *_SMALLEST), ranges.reshape(6, -1), strict=True)),
        **dict(zip(_SHARES, divide_by_direction(energy, model.direction).T, strict=True)),
        **dict(zip(_FREQUENCIES, frequency.T / (2.0 * np.pi), strict=True)),
        **dict(zip(_REACH, reach, strict=True)),
        "residual": known.residual,
        "truncation": known.truncation,
        "direct_difference": known.direct,
    }
    labels: dict[str, Iterable[Any]] = {
        "kind": repeat("quasi_periodic"),
        "stability": known.stability.tolist(),
        "branch": known.branch.tolist(),
        "found_by": known.found_by,
        "harmonics": repeat(tori.order[0]),
        "outcome": _slack_first(slack, _outcomes(discretization, line, measures, expanded)),
    }
    return _rows(findings, scales, _RowKeys(line, loops, tori.wind_speed), measures, labels)


def _is_expanded(findings: ModelFindings, model: AerodynamicModel) -> bool:
    """Return whether the load is expanded in velocities, and so holds for small ones only."""
    return model is not AerodynamicModel.PUBLISHED and findings.model.unexpanded is None


def _outcomes(
    discretization: Discretization, line: IntArray, measures: Mapping[str, FloatArray], expanded: bool
) -> list[Outcome]:
    """Return the outcomes of computed motions of lines (motions,)."""
    angle, velocity = (measures[name] for name in _REACH)
    amplitudes = np.stack([measures[name] for name in _AMPLITUDES[:2]])
    sag, fitted_range = discretization.profile.sag[line], discretization.sections.fitted_range[line]
    too_fast = (velocity > FASTEST) & expanded
    return motion_outcomes(angle, fitted_range, too_fast, amplitudes, sag)


def _slack_first(slack: BoolArray, outcomes: list[Outcome]) -> list[Outcome]:
    """Replace the outcomes of motions with slack conductors: no coefficients would help them."""
    return [Outcome.SLACK if loose else outcome for loose, outcome in zip(slack.tolist(), outcomes, strict=True)]


def _rows(
    findings: ModelFindings,
    scales: _Scales,
    keys: _RowKeys,
    measures: Mapping[str, FloatArray],
    labels: Mapping[str, Iterable[Any]],
    series: Iterable[FloatArray | None] = repeat(None),
) -> Iterator[tuple[int, Motion]]:
    """Yield rows written from columns, with the line of each. Missing columns and numbers that are not finite are None.

    measures: columns of numbers, which include the amplitudes; labels: all others.
    """
    sag, speed = scales.sag[keys.line], scales.speed[keys.line]
    observed = {k: at.tolist() for k, at in scales.observed.items()}
    lines, loops = keys.line.tolist(), keys.loops.tolist()
    with np.errstate(invalid="ignore"):  # the speed of a line without a vertical frequency is infinite
        reduced = np.where(np.isfinite(speed), keys.wind_speed / speed, np.nan)
    numbers = dict(measures) | {
        "wind_speed_m_per_s": keys.wind_speed,
        "vertical_ratio": measures["vertical_m"] / sag,
        "horizontal_ratio": measures["horizontal_m"] / sag,
        "reduced_wind_speed": reduced,
    }
    columns: dict[str, Iterable[Any]] = dict.fromkeys(_NAMES, repeat(None))
    columns |= {name: _numbers(column) for name, column in numbers.items()} | dict(labels)
    columns |= {"model": repeat(findings.name), "loops": loops}
    columns["observed_at_m"] = [observed[k][line] for k, line in zip(loops, lines, strict=True)]
    return zip(lines, map(Motion, map(LimitCycleRow, *columns.values()), series), strict=False)


def _numbers(column: FloatArray) -> list[Any]:
    """Return the numbers of a column, None in place of those that are not finite."""
    values: list[Any] = column.tolist()
    return values if np.isfinite(column).all() else [finite_or_none(value) for value in values]


def _observed_at(discretization: Discretization, loops: int) -> FloatArray:
    """Return the horizontal position of s = L/(2 loops) on each line [m]."""
    return horizontal_position(discretization.profile, discretization.profile.arc_length / (2.0 * loops))
