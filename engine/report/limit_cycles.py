"""Rows of the motions at each wind speed: the equilibrium and every cycle. Theory section 8."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields
from itertools import chain, repeat
from typing import Any

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, eigenvalues
from engine.cycles.harmonic_balance import half_peak_to_peak, pick, states
from engine.mechanics.static_profile import horizontal_position
from engine.models.critical_wind_speeds import at_wind, state_matrices, unstable_pairs
from engine.models.discretization import Discretization, observation
from engine.models.reduced_model import take
from engine.outcome import Outcome, Stability
from engine.report.internal_resonances import divided, motion_shares
from engine.report.rows import Found, by_line, number
from engine.result import LimitCycleRow
from engine.tori.spectrum import amplitude_range, base_frequencies, largest_angle, mean_square_velocity

ANGLE_SAMPLES = 48
_UNSTABLE, _LOST = Outcome.STATICALLY_UNSTABLE, Outcome.NO_CONVERGENCE
_AMPLITUDES = ("vertical_m", "horizontal_m", "torsional_rad")
_SHARES = ("vertical_share", "horizontal_share", "torsional_share")
_SMALLEST = ("vertical_min_m", "horizontal_min_m", "torsional_min_rad")
_FREQUENCIES = ("frequency_hz", "second_frequency_hz")
_VERDICTS = (Stability.UNKNOWN, Stability.UNSTABLE, Stability.STABLE)
_NAMES = tuple(field.name for field in fields(LimitCycleRow))


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
    for line, motion in chain(
        _equilibria(found, loops, scales), _cycles(made, found, scales), _tori(made, found, scales)
    ):
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


@dataclass(frozen=True, slots=True)
class _Places:
    """What identifies rows: index of the line, loops and wind speed [m/s] of each, all (k,)."""

    line: IntArray
    loops: IntArray
    wind_speed: FloatArray


def _equilibria(found: Found, loops: tuple[int, ...], scales: _Scales) -> Iterator[tuple[int, Motion]]:
    """Yield the rows of the static state, and of wind speeds where it oscillates away but no cycle was found."""
    members, winds = found.line.size, found.winds.size
    values = eigenvalues(at_wind(state_matrices(found.model), np.broadcast_to(found.winds, (members, winds))))
    size = np.abs(values).max(axis=-1, initial=0.0)
    undecided = np.abs(values.real.max(axis=-1, initial=-np.inf)) <= 1e-12 * size
    static = found.model.statically_unstable
    growing = (unstable_pairs(values) > 0) | static[:, None]
    verdict = np.where(undecided & ~static[:, None], 0, np.where(growing, 1, 2))
    known = (found.loops[:, :, None] == np.array(loops, dtype=np.intp)).any(axis=1)
    member, at, wind = np.nonzero(np.broadcast_to(known[:, :, None], (members, len(loops), winds)))
    rests = _Places(found.line[member], np.array(loops, dtype=np.intp)[at], found.winds[wind])
    still = np.where(static[member], np.nan, 0.0)
    told: dict[str, Iterable[Any]] = {
        "kind": repeat("equilibrium"),
        "stability": [_VERDICTS[number] for number in verdict[member, wind].tolist()],
        "outcome": [_UNSTABLE if lost else Outcome.CONVERGED for lost in static[member].tolist()],
    }
    yield from _written(found, scales, rests, dict.fromkeys(_AMPLITUDES, still), told)
    oscillating = ((values.real > 0.0) & (values.imag > 0.0)).any(axis=-1) & ~static[:, None]
    oscillating[found.cycles.member, found.cycles.wind] = False
    # A row of the first co-ordinate's loops stands for all that oscillates there.
    oscillating &= np.isin(found.loops[:, :1], loops)
    yield from _without_motion(found, scales, np.argwhere(oscillating), "periodic")


def _without_motion(found: Found, scales: _Scales, lost: IntArray, kind: str) -> Iterator[tuple[int, Motion]]:
    """Yield a row for each member and wind, (k, 2), where a motion is likely but none was found."""
    member, wind = lost.reshape(-1, 2).T
    places = _Places(found.line[member], found.loops[member, 0], found.winds[wind])
    told: dict[str, Iterable[Any]] = {
        "kind": repeat(kind),
        "stability": repeat(Stability.UNKNOWN),
        "outcome": repeat(_LOST),
    }
    return _written(found, scales, places, dict.fromkeys(_AMPLITUDES, np.full(member.size, np.nan)), told)


def _cycles(made: Discretization, found: Found, scales: _Scales) -> Iterator[tuple[int, Motion]]:
    """Yield the rows of all cycles with their series where they are observed."""
    cycles = found.cycles
    if cycles.member.size == 0:
        return iter(())
    line, loops = found.line[cycles.member], _own_loops(found)
    shapes = found.model.shapes[cycles.member]
    series = np.empty((cycles.member.size, 3, cycles.orbits.coefficients.shape[-1]))
    for k in np.unique(loops):
        here = loops == k
        seen = observation(made, shapes[here], int(k))
        series[here] = seen.swapaxes(-1, -2) @ cycles.orbits.coefficients[here]
    outside = _outside_fit(found, made.sections.fitted_range[line])
    told: dict[str, Iterable[Any]] = {
        "kind": repeat("periodic"),
        "stability": cycles.floquet.stability.tolist(),
        "branch": cycles.branch.tolist(),
        "found_by": cycles.found_by,
        "harmonics": cycles.harmonics.tolist(),
        "outcome": [Outcome.OUTSIDE_FIT if beyond else Outcome.CONVERGED for beyond in outside.tolist()],
    }
    places = _Places(line, loops, cycles.orbits.wind_speed)
    return _written(found, scales, places, _measures(found, series), told, series)


def _measures(found: Found, series: FloatArray) -> dict[str, FloatArray]:
    """Return the columns of numbers that only cycles have, NaN where one is not known."""
    cycles, trust = found.cycles, found.confidence
    mass = np.diagonal(found.model.mass, axis1=-2, axis2=-1)[cycles.member]
    return {
        **dict(zip(_AMPLITUDES, half_peak_to_peak(series).T, strict=True)),
        **dict(zip(_SHARES, motion_shares(mass, cycles.orbits.coefficients, found.model.direction).T, strict=True)),
        "frequency_hz": cycles.orbits.angular_frequency / (2.0 * np.pi),
        "residual": trust.residual,
        "truncation": trust.truncation,
        "detuning_sensitivity": trust.detuning,
        "direct_difference": trust.direct,
    }


def _tori(made: Discretization, found: Found, scales: _Scales) -> Iterator[tuple[int, Motion]]:
    """Yield the rows of all quasi-periodic motions, and of wind speeds where one is likely but none was found."""
    known, model = found.quasi_periodic, found.model
    tori, member, line = known.tori, known.member, found.line[known.member]
    frequency, _ = base_frequencies(model, member, tori)
    energy = np.diagonal(model.mass, axis1=-2, axis2=-1)[member] * mean_square_velocity(tori)
    loops = found.loops[member, energy.argmax(axis=-1)]
    ranges, outcome = np.empty((2, 3, member.size)), []
    for i in range(member.size):
        one = tori.pick(np.array([i]))
        series = observation(made, model.shapes[member[i]], int(loops[i])).T @ one.coefficients[0]
        ranges[..., i] = amplitude_range(series, one, float(frequency[i, 0]))
        beyond = largest_angle(model, int(member[i]), one) > made.sections.fitted_range[line[i]]
        outcome.append(Outcome.OUTSIDE_FIT if beyond else Outcome.CONVERGED)
    measures = {
        **dict(zip((*_AMPLITUDES, *_SMALLEST), ranges.reshape(6, -1), strict=True)),
        **dict(zip(_SHARES, divided(energy, model.direction).T, strict=True)),
        **dict(zip(_FREQUENCIES, frequency.T / (2.0 * np.pi), strict=True)),
        "residual": known.residual,
        "truncation": known.truncation,
        "direct_difference": known.direct,
    }
    told: dict[str, Iterable[Any]] = {
        "kind": repeat("quasi_periodic"),
        "stability": known.stability.tolist(),
        "branch": known.branch.tolist(),
        "found_by": known.found_by,
        "harmonics": repeat(tori.order[0]),
        "outcome": outcome,
    }
    yield from _written(found, scales, _Places(line, loops, tori.wind_speed), measures, told)
    yield from _without_motion(found, scales, known.lost, "quasi_periodic")


def _written(
    found: Found,
    scales: _Scales,
    places: _Places,
    measures: Mapping[str, FloatArray],
    told: Mapping[str, Iterable[Any]],
    series: Iterable[FloatArray | None] = repeat(None),
) -> Iterator[tuple[int, Motion]]:
    """Write rows from columns, with the line of each; a column that is not given, and what is not finite, is None.

    measures: columns of numbers, those of the amplitudes among them; told: all others.
    """
    sag, speed = scales.sag[places.line], scales.speed[places.line]
    observed = {k: at.tolist() for k, at in scales.observed.items()}
    lines, loops = places.line.tolist(), places.loops.tolist()
    with np.errstate(invalid="ignore"):  # the speed of a line without a vertical frequency is infinite
        reduced = np.where(np.isfinite(speed), places.wind_speed / speed, np.nan)
    numbers = dict(measures) | {
        "wind_speed_m_per_s": places.wind_speed,
        "vertical_ratio": measures["vertical_m"] / sag,
        "horizontal_ratio": measures["horizontal_m"] / sag,
        "reduced_wind_speed": reduced,
    }
    columns: dict[str, Iterable[Any]] = dict.fromkeys(_NAMES, repeat(None))
    columns |= {name: _numbers(column) for name, column in numbers.items()} | dict(told)
    columns |= {"model": repeat(found.name), "loops": loops}
    columns["observed_at_m"] = [observed[k][line] for k, line in zip(loops, lines, strict=True)]
    return zip(lines, map(Motion, map(LimitCycleRow, *columns.values()), series), strict=False)


def _numbers(column: FloatArray) -> list[Any]:
    """Return numbers, None where one is not finite."""
    values: list[Any] = column.tolist()
    return values if np.isfinite(column).all() else [number(value) for value in values]


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
