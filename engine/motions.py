"""Rows of the motions at each wind speed: the equilibrium and every cycle. Theory section 8."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.eigenvalues import eigenvalues
from engine.harmonic import half_peak_to_peak, pick, states
from engine.hybrid import Discretization, observation, take
from engine.outcome import Outcome, Stability
from engine.profile import horizontal_position
from engine.resonance import divided, motion_shares
from engine.result import LimitCycleRow
from engine.rows import Found, by_line, number
from engine.spec import Model
from engine.stability import at_wind, state_matrices, unstable_pairs
from engine.torus_lines import amplitude_range, base_frequencies, largest_angle, mean_square_velocity

ANGLE_SAMPLES = 48
_UNSTABLE, _LOST = Outcome.STATICALLY_UNSTABLE, Outcome.NO_CONVERGENCE
_AMPLITUDES = ("vertical_m", "horizontal_m", "torsional_rad")
_SHARES = ("vertical_share", "horizontal_share", "torsional_share")
_TRUST = ("found_by", "harmonics", "residual", "truncation", "detuning_sensitivity", "direct_difference")
_SMALLEST = ("vertical_min_m", "horizontal_min_m", "torsional_min_rad")
_FREQUENCIES = ("frequency_hz", "second_frequency_hz")
_MEASURES = (*_AMPLITUDES, *_SMALLEST, *_SHARES, *_TRUST, *_FREQUENCIES, "branch")
_UNMEASURED: dict[str, Any] = dict.fromkeys(_MEASURES)
_AT_REST = _UNMEASURED | dict.fromkeys(_AMPLITUDES, 0.0)


@dataclass(frozen=True, slots=True)
class Motion:
    """A row and, for a cycle, its Fourier series where it is observed: (3, 2 H + 1) of V, W [m] and Theta [rad]."""

    row: LimitCycleRow
    series: FloatArray | None = None


def motion_rows(made: Discretization, found: Found, loops: tuple[int, ...], lowest: FloatArray) -> list[list[Motion]]:
    """Write the equilibrium and every cycle at each wind speed; a list a line.

    Parameters
    ----------
    made : Discretization
    found : Found
    loops : tuple of int
        Numbers of loops for which the equilibrium has a row.
    lowest : (lines,)
        Lowest vertical frequency of each line [Hz].
    """
    table: list[list[Motion]] = by_line(found.line)
    scales = _Scales(
        sag=made.profile.sag,
        speed=lowest * made.profile.span_length,
        observed={k: _observed_at(made, k) for k in {*loops, *np.unique(found.loops).tolist()}},
    )
    for line, motion in _equilibria(found, loops, scales):
        table[line].append(motion)
    for line, motion in _cycles(made, found, scales):
        table[line].append(motion)
    for line, motion in _tori(made, found, scales):
        table[line].append(motion)
    for motions in table:
        motions.sort(key=lambda m: (m.row.loops, m.row.wind_speed_m_per_s, m.row.kind != "equilibrium"))
    return table


@dataclass(frozen=True, slots=True)
class _Scales:
    """Static sag [m] and f L_x [m/s] of each line, and the observed positions [m] by number of loops."""

    sag: FloatArray
    speed: FloatArray
    observed: dict[int, FloatArray]


def _equilibria(found: Found, loops: tuple[int, ...], scales: _Scales) -> Iterator[tuple[int, Motion]]:
    """Yield the rows of the static state, and of wind speeds where it oscillates away but no cycle was found."""
    members = found.line.size
    speeds = np.broadcast_to(found.winds, (members, found.winds.size))
    values = eigenvalues(at_wind(state_matrices(found.model), speeds))
    pairs = unstable_pairs(values)
    size = np.abs(values).max(axis=-1, initial=0.0)
    undecided = np.asarray(np.abs(values.real.max(axis=-1, initial=-np.inf)) <= 1e-12 * size)
    oscillating = np.asarray(((values.real > 0.0) & (values.imag > 0.0)).any(axis=-1))
    reached = set(zip(found.cycles.member.tolist(), found.cycles.wind.tolist(), strict=True))
    for member, line in enumerate(found.line.tolist()):
        static = bool(found.model.statically_unstable[member])
        for wind, k in ((w, k) for k in loops if k in found.loops[member] for w in range(found.winds.size)):
            place = _Place(found.name, k, float(found.winds[wind]), line)
            if static:
                yield line, Motion(_row(place, scales, "equilibrium", Stability.UNSTABLE, _UNSTABLE))
                continue
            stability = Stability.UNSTABLE if pairs[member, wind] else Stability.STABLE
            stability = Stability.UNKNOWN if undecided[member, wind] else stability
            yield line, Motion(_row(place, scales, "equilibrium", stability, Outcome.CONVERGED, _AT_REST))
            if oscillating[member, wind] and (member, wind) not in reached and k == found.loops[member, 0]:
                yield line, Motion(_row(place, scales, "periodic", Stability.UNKNOWN, _LOST))


def _cycles(made: Discretization, found: Found, scales: _Scales) -> Iterator[tuple[int, Motion]]:
    """Yield the rows of all cycles with their series where they are observed."""
    cycles = found.cycles
    if cycles.member.size == 0:
        return
    line, loops = found.line[cycles.member], _own_loops(found)
    shapes = found.model.shapes[cycles.member]
    series = np.empty((cycles.member.size, 3, cycles.orbits.coefficients.shape[-1]))
    for k in np.unique(loops):
        here = loops == k
        seen = observation(made, shapes[here], int(k))
        series[here] = seen.swapaxes(-1, -2) @ cycles.orbits.coefficients[here]
    outside = _outside_fit(found, made.sections.fitted_range[line])
    outcome = [Outcome.OUTSIDE_FIT if beyond else Outcome.CONVERGED for beyond in outside.tolist()]
    places = zip(loops.tolist(), cycles.orbits.wind_speed.tolist(), line.tolist(), strict=True)
    told = zip(cycles.floquet.stability.tolist(), outcome, _measures(found, series), strict=True)
    for i, (place, (stability, judged, measures)) in enumerate(zip(places, told, strict=True)):
        row = _row(_Place(found.name, *place), scales, "periodic", stability, judged, measures)
        yield place[-1], Motion(row, series[i])


def _measures(found: Found, series: FloatArray) -> Iterator[dict[str, Any]]:
    """Yield the fields of a row that only a cycle has, None where a number is not known."""
    cycles, trust = found.cycles, found.confidence
    mass = np.diagonal(found.model.mass, axis1=-2, axis2=-1)[cycles.member]
    columns = {
        **dict(zip(_AMPLITUDES, half_peak_to_peak(series).T, strict=True)),
        **dict(zip(_SHARES, motion_shares(mass, cycles.orbits.coefficients, found.model.direction).T, strict=True)),
        "frequency_hz": cycles.orbits.angular_frequency / (2.0 * np.pi),
        "residual": trust.residual,
        "truncation": trust.truncation,
        "detuning_sensitivity": trust.detuning,
        "direct_difference": trust.direct,
    }
    known: dict[str, Sequence[Any]] = {
        name: [number(value) for value in column.tolist()] for name, column in columns.items()
    }
    unknown = dict.fromkeys((*_SMALLEST, "second_frequency_hz"))
    known |= {"branch": cycles.branch.tolist(), "harmonics": cycles.harmonics.tolist(), "found_by": cycles.found_by}
    for values in zip(*known.values(), strict=True):
        yield unknown | dict(zip(known, values, strict=True))


def _tori(made: Discretization, found: Found, scales: _Scales) -> Iterator[tuple[int, Motion]]:
    """Yield the rows of all quasi-periodic motions, and of wind speeds where one is likely but none was found."""
    known, model = found.quasi_periodic, found.model
    tori, member = known.tori, known.member
    frequency, _ = base_frequencies(model, member, tori)
    energy = np.diagonal(model.mass, axis1=-2, axis2=-1)[member] * mean_square_velocity(tori)
    shares = divided(energy, model.direction)
    for i, line in enumerate(found.line[member].tolist()):
        one = tori.pick(np.array([i]))
        loops = int(found.loops[member[i], energy[i].argmax()])
        series = observation(made, model.shapes[member[i]], loops).T @ one.coefficients[0]
        largest, smallest = amplitude_range(series, one, float(frequency[i, 0]))
        beyond = largest_angle(model, int(member[i]), one) > made.sections.fitted_range[line]
        measures = _UNMEASURED | {
            **dict(zip(_AMPLITUDES, largest.tolist(), strict=True)),
            **dict(zip(_SMALLEST, smallest.tolist(), strict=True)),
            **dict(zip(_SHARES, shares[i].tolist(), strict=True)),
            **dict(zip(_FREQUENCIES, (frequency[i] / (2.0 * np.pi)).tolist(), strict=True)),
            "branch": int(known.branch[i]),
            "found_by": known.found_by[i],
            "harmonics": tori.order[0],
            "residual": float(known.residual[i]),
            "truncation": number(float(known.truncation[i])),
            "direct_difference": number(float(known.direct[i])),
        }
        place = _Place(found.name, loops, float(one.wind_speed[0]), line)
        outcome = Outcome.OUTSIDE_FIT if beyond else Outcome.CONVERGED
        yield line, Motion(_row(place, scales, "quasi_periodic", known.stability[i], outcome, measures))
    for at, wind in known.lost.tolist():
        place = _Place(found.name, int(found.loops[at, 0]), float(found.winds[wind]), int(found.line[at]))
        yield place.line, Motion(_row(place, scales, "quasi_periodic", Stability.UNKNOWN, _LOST))


@dataclass(frozen=True, slots=True)
class _Place:
    """What identifies a row: model, loops, wind speed [m/s] and the index of the line."""

    model: Model
    loops: int
    wind_speed: float
    line: int


def _row(
    place: _Place,
    scales: _Scales,
    kind: Literal["equilibrium", "periodic", "quasi_periodic"],
    stability: Stability,
    outcome: Outcome,
    measures: Mapping[str, Any] = _UNMEASURED,
) -> LimitCycleRow:
    """Write a row; amplitudes V, W [m] and Theta [rad] and all that goes with them stand in its measures."""
    sag, speed = float(scales.sag[place.line]), float(scales.speed[place.line])
    vertical, horizontal = measures["vertical_m"], measures["horizontal_m"]
    return LimitCycleRow(
        model=place.model,
        loops=place.loops,
        wind_speed_m_per_s=place.wind_speed,
        kind=kind,
        stability=stability,
        observed_at_m=float(scales.observed[place.loops][place.line]),
        vertical_ratio=None if vertical is None else vertical / sag,
        horizontal_ratio=None if horizontal is None else horizontal / sag,
        reduced_wind_speed=place.wind_speed / speed if np.isfinite(speed) else None,
        outcome=outcome,
        **measures,
    )


def _observed_at(made: Discretization, loops: int) -> FloatArray:
    """Return the horizontal position of s = L/(2 loops) on each line [m]."""
    return horizontal_position(made.profile, made.profile.arc_length / (2.0 * loops))


def _own_loops(found: Found) -> IntArray:
    """Return the number of loops of the co-ordinate of largest M_ii |q_i|^2 in each cycle."""
    mass = np.diagonal(found.model.mass, axis1=-2, axis2=-1)[found.cycles.member]
    energy = mass * (found.cycles.orbits.coefficients[..., 1:] ** 2).sum(axis=-1)
    return np.asarray(found.loops[found.cycles.member, energy.argmax(axis=-1)])


def _outside_fit(found: Found, fitted_range: FloatArray) -> BoolArray:
    """Tell where the largest |alpha| along the span and over the period exceeds the fitted range (cycles,) [rad]."""
    cycles = found.cycles
    result = np.zeros(cycles.member.size, dtype=np.bool_)
    known = np.flatnonzero(np.isfinite(fitted_range))
    if known.size:
        orbits = pick(cycles.orbits, known)
        state = states(orbits, 2.0 * np.pi * np.arange(ANGLE_SAMPLES) / ANGLE_SAMPLES)
        angle = take(found.model, cycles.member[known]).load.angle
        result[known] = np.abs(state @ angle.swapaxes(-1, -2)).max(axis=(-1, -2)) > fitted_range[known]
    return result
