"""The table of limit cycles: equilibrium, cycles and quasi-periodic motions at each wind speed. Theory section 8."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain, pairwise, repeat
from typing import Any

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.checks.data_limits import motion_outcomes
from engine.cycles.harmonic_balance import half_peak_to_peak, states
from engine.kernels import compiled
from engine.models.critical_wind_speeds import unstable_pairs
from engine.models.relative_wind import FASTEST, NodalMotion, largest_reach
from engine.outcome import Outcome, Stability
from engine.report.cells import filled_rows, numbers
from engine.report.findings import (
    MissingMotions,
    ModelFindings,
    cycle_coordinates,
    cycle_loops,
    missing_motions,
    torus_coordinates,
    torus_loops,
)
from engine.report.internal_resonances import divide_by_direction, motion_shares
from engine.report.observers.observer import Observed, Observer
from engine.report.tensions import MotionTensions
from engine.result import LimitCycleRow
from engine.spec import AerodynamicModel, Analysis
from engine.tori.spectrum import amplitude_range, base_frequencies, mean_square_velocity, sampled_states

REACH_SAMPLES = 48
_AT_REST = np.array([Outcome.CONVERGED, Outcome.STATICALLY_UNSTABLE], dtype=np.object_)
_AMPLITUDES = ("vertical_m", "horizontal_m", "torsional_rad")
_SHARES = ("vertical_share", "horizontal_share", "torsional_share")
_SMALLEST = ("vertical_min_m", "horizontal_min_m", "torsional_min_rad")
_REACH = ("largest_angle_of_attack_rad", "largest_velocity_ratio")
_MIDDLES = ("vertical_middle_m", "horizontal_middle_m", "torsional_middle_rad")
_FREQUENCIES = ("frequency_hz", "second_frequency_hz")
_VERDICTS = np.array([Stability.UNKNOWN, Stability.UNSTABLE, Stability.STABLE], dtype=np.object_)


# A row and, for a cycle, the Fourier coefficients of V, W [m] and Theta [rad] where it is observed.
Motion = tuple[LimitCycleRow, tuple[tuple[float, ...], ...] | None]


def limit_cycle_rows(
    observer: Observer, findings: ModelFindings, tensions: MotionTensions, analysis: Analysis, lowest: FloatArray
) -> list[list[Motion]]:
    """Return a row for the equilibrium, every cycle and every torus at each wind speed, one list per line.

    They are sorted by loops and wind speed; equilibria come first.

    Parameters
    ----------
    observer : Observer
    findings : ModelFindings
    tensions : MotionTensions
        Of these findings.
    analysis : Analysis
        Its loops, for each of which the equilibrium has a row, and its aerodynamic model.
    lowest : (lines,)
        Lowest vertical frequency of each line [Hz].
    """
    local = observer.local_motion(findings, analysis.aerodynamic_model)
    seen = _Seen(observer, findings, tensions, lowest * observer.span_length, local)
    kinds = [*_equilibria(seen, analysis.loops), _cycles(seen), _quasi_periodic_motions(seen)]
    line, loops, wind = (
        np.concatenate([getattr(kind.keys, name) for kind in kinds]) for name in ("line", "loops", "wind_speed")
    )
    motions = list(chain(*(kind.motions for kind in kinds)))
    order = np.lexsort((wind, loops, line))
    first = np.searchsorted(line[order], np.arange(findings.line.max(initial=-1) + 2)).tolist()
    return [[motions[i] for i in order[begin:end].tolist()] for begin, end in pairwise(first)]


@dataclass(frozen=True, slots=True)
class _Seen:
    """Findings with who observes them, their tensions, f L_x [m/s] of each line (lines,), and motion at the nodes."""

    observer: Observer
    findings: ModelFindings
    tensions: MotionTensions
    speed: FloatArray
    local: NodalMotion

    @property
    def is_expanded(self) -> bool:
        """Whether the load is expanded in velocities, and so holds for small ones only."""
        return self.local.model is not AerodynamicModel.PUBLISHED and self.findings.model.unexpanded is None


@dataclass(frozen=True, slots=True)
class _RowKeys:
    """Index of the line, number of loops and wind speed [m/s] of each row, (k,) each, and where it is observed."""

    line: IntArray
    loops: IntArray
    wind_speed: FloatArray
    observed: Observed


@dataclass(frozen=True, slots=True)
class _Motions:
    """Motions of one kind with their keys."""

    keys: _RowKeys
    motions: Iterator[Motion]


def _equilibria(seen: _Seen, loops: tuple[int, ...]) -> Iterator[_Motions]:
    """Yield rows of the static state, and of wind speeds where it is unstable and no stable motion is known."""
    findings = seen.findings
    members, winds = findings.winds.shape
    values = findings.cycles.at_rest
    size = np.abs(values).max(axis=-1, initial=0.0)
    undecided = np.abs(values.real.max(axis=-1, initial=-np.inf)) <= 1e-12 * size
    static = findings.model.statically_unstable
    growing = (unstable_pairs(values) > 0) | static[:, None]
    verdict = np.where(undecided & ~static[:, None], 0, np.where(growing, 1, 2))
    known = (findings.loops[:, :, None] == np.array(loops, dtype=np.intp)).any(axis=1)
    member, at, wind = np.nonzero(np.broadcast_to(known[:, :, None], (members, len(loops), winds)))
    number = np.array(loops, dtype=np.intp)[at]
    keys = _RowKeys(
        findings.line[member], number, findings.winds[member, wind], seen.observer.resting(findings, member, number)
    )
    amplitude = np.where(static[member], np.nan, 0.0)
    labels: dict[str, Iterable[Any]] = {
        "stability": _VERDICTS[verdict[member, wind]].tolist(),
        "outcome": _AT_REST[static[member].astype(np.intp)].tolist(),
    }
    yield _rows(seen, keys, dict.fromkeys(_AMPLITUDES, amplitude), labels, {"kind": "equilibrium"})
    yield _without_motion(seen, missing_motions(findings, growing & ~static[:, None]), loops)


def _without_motion(seen: _Seen, missing: MissingMotions, asked: tuple[int, ...]) -> _Motions:
    """Return a row for each wind speed where a stable motion must exist but none is known.

    One row, with the first of the member's loops that was asked for, stands for all of its unstable modes.
    """
    findings, member = seen.findings, missing.member
    first = np.isin(findings.loops, asked).argmax(axis=-1)
    loops = findings.loops[member, first[member]]
    observed = seen.observer.resting(findings, member, loops)
    keys = _RowKeys(findings.line[member], loops, findings.winds[member, missing.wind], observed)
    labels: dict[str, Iterable[Any]] = {"kind": missing.kind, "outcome": missing.outcome}
    unknown = dict.fromkeys(_AMPLITUDES, np.full(member.size, np.nan))
    return _rows(seen, keys, unknown, labels, {"stability": Stability.UNKNOWN})


def _cycles(seen: _Seen) -> _Motions:
    """Return the rows of all cycles with their Fourier series at the point of observation."""
    observer, findings, cycles = seen.observer, seen.findings, seen.findings.cycles
    state = states(cycles.orbits, 2.0 * np.pi * np.arange(REACH_SAMPLES) / REACH_SAMPLES)
    observed = observer.moving(findings, cycles.member, cycle_coordinates(findings), state)
    series = observed.shapes.swapaxes(-1, -2) @ cycles.orbits.coefficients
    reach = _reach(seen.local, cycles.member, state)
    measures = _measures(findings, series) | dict(zip(_REACH, reach, strict=True))
    slack = seen.tensions.cycles[..., 0].min(axis=-1) <= 0.0
    keys = _RowKeys(findings.line[cycles.member], cycle_loops(findings), cycles.orbits.wind_speed, observed)
    labels: dict[str, Iterable[Any]] = {
        "stability": cycles.floquet.stability.tolist(),
        "branch": cycles.branch.tolist(),
        "found_by": cycles.found_by,
        "harmonics": cycles.harmonics.tolist(),
        "outcome": _slack_first(slack, _outcomes(seen, keys, measures)),
    }
    return _rows(seen, keys, measures, labels, {"kind": "periodic"}, _as_tuples(series, cycles.harmonics))


def _reach(motion: NodalMotion, member: IntArray, state: FloatArray) -> FloatArray:
    """Return what `largest_reach` does, by the compiled kernel where it is available."""
    if compiled.AVAILABLE:
        return compiled.largest_reaches(motion, member, state)
    return largest_reach(motion, member, state)


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


def _quasi_periodic_motions(seen: _Seen) -> _Motions:
    """Return the rows of all quasi-periodic motions."""
    observer, findings = seen.observer, seen.findings
    known, model = findings.quasi_periodic, findings.model
    tori, member = known.tori, known.member
    frequency, _ = base_frequencies(model, member, tori)
    energy = model.modal_masses[member] * mean_square_velocity(tori)
    state = sampled_states(tori)
    observed = observer.moving(findings, member, torus_coordinates(findings), state)
    slack = seen.tensions.tori[..., 0].min(axis=-1) <= 0.0
    ranges, reach, middle = np.empty((2, 3, member.size)), np.empty((2, member.size)), np.empty((3, member.size))
    for i in range(member.size):
        one = tori.select(np.array([i]))
        series = observed.shapes[i].T @ one.coefficients[0]
        ranges[..., i] = amplitude_range(series, one, float(frequency[i, 0]))
        path = state[i, :, : model.mass.shape[-1]] @ observed.shapes[i]
        middle[:, i] = 0.5 * (path.max(axis=0) + path.min(axis=0))
        reach[:, [i]] = _reach(seen.local, member[[i]], state[[i]])
    measures = {
        **dict(zip((*_AMPLITUDES, *_SMALLEST), ranges.reshape(6, -1), strict=True)),
        **dict(zip(_MIDDLES, middle, strict=True)),
        **dict(zip(_SHARES, divide_by_direction(energy, model.direction).T, strict=True)),
        **dict(zip(_FREQUENCIES, frequency.T / (2.0 * np.pi), strict=True)),
        **dict(zip(_REACH, reach, strict=True)),
        "residual": known.residual,
        "truncation": known.truncation,
        "direct_difference": known.direct,
    }
    keys = _RowKeys(findings.line[member], torus_loops(findings), tori.wind_speed, observed)
    labels: dict[str, Iterable[Any]] = {
        "stability": known.stability.tolist(),
        "branch": known.branch.tolist(),
        "found_by": known.found_by,
        "outcome": _slack_first(slack, _outcomes(seen, keys, measures)),
    }
    return _rows(seen, keys, measures, labels, {"kind": "quasi_periodic", "harmonics": tori.order[0]})


def _outcomes(seen: _Seen, keys: _RowKeys, measures: Mapping[str, FloatArray]) -> list[Outcome]:
    """Return the outcomes of computed motions."""
    angle, velocity = (measures[name] for name in _REACH)
    amplitudes = np.stack([measures[name] for name in _AMPLITUDES[:2]])
    too_fast = (velocity > FASTEST) & seen.is_expanded
    return motion_outcomes(angle, seen.observer.fitted_range[keys.line], too_fast, amplitudes, keys.observed.sag)


def _slack_first(slack: BoolArray, outcomes: list[Outcome]) -> list[Outcome]:
    """Replace the outcomes of motions with slack conductors: no coefficients would help them."""
    return [Outcome.SLACK if loose else outcome for loose, outcome in zip(slack.tolist(), outcomes, strict=True)]


def _rows(
    seen: _Seen,
    keys: _RowKeys,
    measures: Mapping[str, FloatArray],
    labels: Mapping[str, Iterable[Any]],
    alike: Mapping[str, Any],
    series: Iterable[tuple[tuple[float, ...], ...] | None] = repeat(None),
) -> _Motions:
    """Return rows written from columns. Missing columns and numbers that are not finite are None.

    measures: columns of numbers, which include the amplitudes; labels: all others; alike: cells that all rows share.
    """
    sag, speed = keys.observed.sag, seen.speed[keys.line]
    with np.errstate(invalid="ignore"):  # the speed of a line without a vertical frequency is infinite
        reduced = np.where(np.isfinite(speed), keys.wind_speed / speed, np.nan)
    measures = dict(measures) | {
        "wind_speed_m_per_s": keys.wind_speed,
        "observed_at_m": keys.observed.position,
        "vertical_ratio": measures["vertical_m"] / sag,
        "horizontal_ratio": measures["horizontal_m"] / sag,
        "reduced_wind_speed": reduced,
    }
    columns: dict[str, Iterable[Any]] = {name: numbers(column) for name, column in measures.items()}
    columns |= {"loops": keys.loops.tolist(), "span": keys.observed.span, "span_shares": keys.observed.shares, **labels}
    rows = filled_rows(LimitCycleRow, columns, {"model": seen.findings.name, **alike})
    return _Motions(keys, zip(rows, series, strict=False))  # other motions than cycles repeat None without end


def _as_tuples(series: FloatArray, harmonics: IntArray) -> list[tuple[tuple[float, ...], ...]]:
    """Return Fourier series (cycles, 3, 2 H + 1) as three tuples a cycle, without what pads fewer harmonics."""
    found: list[tuple[tuple[float, ...], ...]] = [()] * harmonics.size
    for count in np.unique(harmonics).tolist():
        here = np.flatnonzero(harmonics == count)
        coefficients = iter(series[here, :, : 2 * count + 1].ravel().tolist())
        coordinates = zip(*[coefficients] * (2 * count + 1), strict=True)
        for cycle, own in zip(here.tolist(), zip(*[coordinates] * 3, strict=True), strict=True):
            found[cycle] = own
    return found
