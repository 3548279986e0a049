"""Flat rows from what was found with one kind of model. Theory section 8."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.cycles import Cycles
from engine.harmonic import half_peak_to_peak, pick, states
from engine.hybrid import Discretization, ReducedModel, observation, take
from engine.modes import assign, solve_symmetric
from engine.outcome import Outcome, Stability
from engine.profile import horizontal_position
from engine.resonance import motion_shares
from engine.result import CriticalWindSpeedRow, Direction, FrequencyRow, LimitCycleRow
from engine.spec import Model
from engine.stability import Crossings, at_wind, state_matrices, unstable_pairs

DIRECTION_NAMES: tuple[Direction, ...] = ("vertical", "horizontal", "torsional")
ANGLE_SAMPLES = 48
_UNSTABLE, _LOST = Outcome.STATICALLY_UNSTABLE, Outcome.NO_CONVERGENCE


@dataclass(frozen=True, slots=True)
class Found:
    """Everything found with one kind of model.

    model: leading axis (members,); line: (members,), index of the line; loops: (members, m), loops of each
    co-ordinate; winds: (winds,) in rising order [m/s].
    """

    name: Model
    model: ReducedModel
    line: IntArray
    loops: IntArray
    crossings: Crossings
    cycles: Cycles
    winds: FloatArray


@dataclass(frozen=True, slots=True)
class Motion:
    """A row and, for a cycle, its Fourier series where it is observed: (3, 2 H + 1) of V, W [m] and Theta [rad]."""

    row: LimitCycleRow
    series: FloatArray | None = None


@dataclass(frozen=True, slots=True)
class FrequencyTable:
    """Squared frequencies of each co-ordinate of a stack of models.

    line: (members,), index of the line; loops: (members, m); square: (members, m) [rad^2/s^2], the co-ordinates in the
    order vertical, horizontal, torsional for each number of loops.
    """

    name: Model
    line: IntArray
    loops: IntArray
    square: FloatArray


def coupled_squares(model: ReducedModel) -> FloatArray:
    """Return the squared frequencies of (M, K), each given to the co-ordinate of largest M_ii |x_i|^2: (members, m)."""
    values, vectors = solve_symmetric(model.stiffness, model.mass)
    share = np.diagonal(model.mass, axis1=-2, axis2=-1)[..., None] * vectors**2
    return np.take_along_axis(values, assign(share), axis=-1)


def frequency_rows(table: FrequencyTable, loops: tuple[int, ...]) -> list[list[FrequencyRow]]:
    """Write the frequencies of the loops asked for; a list a line."""
    frequency = np.sqrt(np.where(table.square > 0.0, table.square, np.nan)) / (2.0 * np.pi)
    rows: list[list[FrequencyRow]] = _by_line(table.line)
    for member, line in enumerate(table.line.tolist()):
        for k in loops:
            picked = [_number(f) for f in frequency[member, table.loops[member] == k].tolist()]
            if picked:
                outcome = Outcome.STATICALLY_UNSTABLE if None in picked else Outcome.CONVERGED
                rows[line].append(FrequencyRow(table.name, k, picked[0], picked[1], picked[2], outcome))
    return rows


def critical_rows(found: Found) -> list[list[CriticalWindSpeedRow]]:
    """Write every crossing of the static state; a list a line."""
    table: list[list[CriticalWindSpeedRow]] = _by_line(found.line)
    c = found.crossings
    for i, member in enumerate(c.member):
        row = CriticalWindSpeedRow(
            model=found.name,
            loops=int(found.loops[member, c.co_ordinate[i]]),
            wind_speed_m_per_s=float(c.wind_speed[i]),
            crossing="onset" if c.onset[i] else "restabilization",
            type="oscillation" if c.oscillation[i] else "divergence",
            direction=DIRECTION_NAMES[found.model.direction[c.co_ordinate[i]]],
            frequency_hz=float(c.angular_frequency[i] / (2.0 * np.pi)),
            unstable_pairs_after=int(c.unstable_after[i]),
        )
        table[found.line[member]].append(row)
    return table


def dropped_warnings(found: Found, lines: int) -> list[list[str]]:
    """Say how many solutions were left out; a list a line."""
    count = np.bincount(found.line, weights=found.cycles.dropped, minlength=lines).astype(int)
    text = "{} solutions of the {} model at large angles of attack are left out: more harmonics do not resolve them."
    return [[text.format(n, found.name.value.replace("_", " "))] if n else [] for n in count]


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
    table: list[list[Motion]] = _by_line(found.line)
    scales = _Scales(
        sag=made.profile.sag,
        speed=lowest * made.profile.span_length,
        observed={k: _observed_at(made, k) for k in {*loops, *np.unique(found.loops).tolist()}},
    )
    for line, motion in _equilibria(found, loops, scales):
        table[line].append(motion)
    for line, motion in _cycles(made, found, scales):
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
    values = np.linalg.eigvals(at_wind(state_matrices(found.model), speeds)).astype(np.complex128)
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
                yield line, Motion(_row(place, scales, _State("equilibrium", Stability.UNSTABLE, _UNSTABLE)))
                continue
            stability = Stability.UNSTABLE if pairs[member, wind] else Stability.STABLE
            stability = Stability.UNKNOWN if undecided[member, wind] else stability
            yield line, Motion(_row(place, scales, _State("equilibrium", stability, amplitude=(0.0, 0.0, 0.0))))
            if oscillating[member, wind] and (member, wind) not in reached and k == found.loops[member, 0]:
                yield line, Motion(_row(place, scales, _State("periodic", Stability.UNKNOWN, _LOST)))


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
    amplitude = half_peak_to_peak(series)
    mass = np.diagonal(found.model.mass, axis1=-2, axis2=-1)[cycles.member]
    shares = motion_shares(mass, cycles.orbits.coefficients, found.model.direction)
    outside = _outside_fit(found, made.sections.fitted_range[line])
    for i in range(cycles.member.size):
        place = _Place(found.name, int(loops[i]), float(cycles.orbits.wind_speed[i]), int(line[i]))
        state = _State(
            "periodic",
            cycles.floquet.stability[i],
            Outcome.OUTSIDE_FIT if outside[i] else Outcome.CONVERGED,
            amplitude=tuple(amplitude[i].tolist()),
            shares=tuple(shares[i].tolist()),
            frequency=float(cycles.orbits.angular_frequency[i] / (2.0 * np.pi)),
            branch=int(cycles.branch[i]),
        )
        yield int(line[i]), Motion(_row(place, scales, state), series[i])


@dataclass(frozen=True, slots=True)
class _Place:
    """What identifies a row: model, loops, wind speed [m/s] and the index of the line."""

    model: Model
    loops: int
    wind_speed: float
    line: int


@dataclass(frozen=True, slots=True)
class _State:
    """What was found there; amplitude holds V, W [m] and Theta [rad], shares their part in the kinetic energy.

    frequency is in Hz.
    """

    kind: Literal["equilibrium", "periodic"]
    stability: Stability
    outcome: Outcome = Outcome.CONVERGED
    amplitude: tuple[float | None, ...] = (None, None, None)
    shares: tuple[float | None, ...] = (None, None, None)
    frequency: float | None = None
    branch: int | None = None


def _row(place: _Place, scales: _Scales, state: _State) -> LimitCycleRow:
    vertical, horizontal, torsional = state.amplitude
    vertical_share, horizontal_share, torsional_share = state.shares
    sag, speed = float(scales.sag[place.line]), float(scales.speed[place.line])
    return LimitCycleRow(
        model=place.model,
        loops=place.loops,
        wind_speed_m_per_s=place.wind_speed,
        branch=state.branch,
        kind=state.kind,
        stability=state.stability,
        frequency_hz=state.frequency,
        second_frequency_hz=None,
        observed_at_m=float(scales.observed[place.loops][place.line]),
        vertical_m=vertical,
        horizontal_m=horizontal,
        torsional_rad=torsional,
        vertical_min_m=None,
        horizontal_min_m=None,
        torsional_min_rad=None,
        vertical_ratio=None if vertical is None else vertical / sag,
        horizontal_ratio=None if horizontal is None else horizontal / sag,
        reduced_wind_speed=place.wind_speed / speed if np.isfinite(speed) else None,
        vertical_share=vertical_share,
        horizontal_share=horizontal_share,
        torsional_share=torsional_share,
        outcome=state.outcome,
    )


def _by_line(line: IntArray) -> list[list[Any]]:
    return [[] for _ in range(int(line.max(initial=-1)) + 1)]


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


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
