"""Clearances between phases that no spacer ties, from the motions of the line, and by ellipses of design practice.

Such phases gallop as the line does, at whatever phase angle, where they are copies of it. A phase with ice or a line of
its own has other motions, which are not known here: it rests. Copies hang alike, so that they come nearest where the
motion is largest. Beside a phase that hangs otherwise the motion is followed along the span, as a sine of its loops.
All phases are swung by the blow-out, each by its own drag and weight.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import combinations, product

import numpy as np

from engine.arrays import FloatArray
from engine.clearance import (
    PATH_SAMPLES,
    Ellipse,
    EllipseMethod,
    clearance,
    ellipse_support,
    galloping_ellipse,
    path_support,
)
from engine.cycles.harmonic_balance import fourier
from engine.mechanics.static_profile import StaticProfile, arc_position, coordinates, static_profile
from engine.report.phases.required_clearances import judged, required_between
from engine.result import LimitCycleRow, PhaseClearanceRow, Result
from engine.spec import THIS, Line, own_line

LOOPS = {EllipseMethod.TOYE: 2}  # of each method's ellipse; the others have one
PHASES = 2.0 * np.pi * np.arange(PATH_SAMPLES) / PATH_SAMPLES
CORNERS = np.array(list(product((-1.0, 1.0), repeat=3))).T
PLACES = 16  # parts of a span along which a motion is followed beside a phase that hangs otherwise


@dataclass(frozen=True, slots=True)
class _Wire:
    """A phase as it hangs: name, attachment (y, z) [m], line, static state, and whether it gallops as the line does."""

    name: str
    place: tuple[float, float]
    line: Line
    profile: StaticProfile
    alike: bool

    @property
    def hung(self) -> dict[str, float]:
        """The columns of a row that say how it hangs."""
        sag, tilt = float(self.profile.sag[0]), math.degrees(float(self.profile.tilt[0]))
        return {"ahead_span_length_m": self.line.span.length, "mid_span_sag_m": sag, "span_swing_angle_deg": tilt}

    def at_rest(self, position: float) -> FloatArray:
        """Return y and z of its reference curve at a horizontal position [m]: (2,)."""
        x = min(position, self.line.span.length)
        height = coordinates(self.profile, arc_position(self.profile, np.array([[x]])))[0, 0, 1:]
        return np.array(self.place) + height


def with_clearances(result: Result, line: Line) -> Result:
    """Return a result with the clearances to phases that no spacer ties, and those by ellipses."""
    if not line.phases:
        return result
    calm = replace(line, wind=replace(line.wind, blow_out=None))
    winds = {row.wind_speed_m_per_s for row in result.limit_cycles} if line.follows_wind else ()
    still = list(_wires(calm if line.follows_wind else line))
    blown = {speed: list(_wires(line, speed)) for speed in winds}
    tied = {name for spacer in line.interphase_spacers for name in spacer.between}
    rows = list(result.clearances)
    for first, second in combinations(range(len(still)), 2):
        hung = {speed: (wires[first], wires[second]) for speed, wires in blown.items()}
        pair = still[first], still[second]
        if not {wire.name for wire in pair} <= tied:
            rows += _computed(line, pair, hung, result)
    for pair in combinations(still, 2):
        rows += [_by_ellipses(line, pair, method) for method in EllipseMethod]
    return replace(result, clearances=tuple(rows))


def _wires(line: Line, wind_speed: float | None = None) -> Iterator[_Wire]:
    """Yield the line and its phases as they hang, at a wind speed [m/s] where their blow-out follows it."""
    this = line if wind_speed is None else line.blown_out_at(wind_speed)
    yield _Wire(THIS, (0.0, 0.0), line, static_profile([this]), True)
    for phase in line.phases:
        own = own_line(line, phase)
        own = own if wind_speed is None else own.blown_out_at(wind_speed)
        if own.follows_wind:  # the line itself stands in still air
            own = replace(own, wind=replace(own.wind, blow_out=None))
        alike = phase.line is None and phase.ice is None
        yield _Wire(phase.name, (phase.y, phase.z), own, static_profile([own]), alike)


def _computed(
    line: Line, pair: tuple[_Wire, _Wire], blown: Mapping[float, tuple[_Wire, _Wire]], result: Result
) -> Iterator[PhaseClearanceRow]:
    """Yield a row for every motion of the line, at the place where the pair is nearest."""
    if not (pair[0].alike or pair[1].alike):
        return  # neither moves here
    for cycle, path in _paths(line, result):
        elsewhere = line.section is not None and cycle.span not in (None, line.section.span_of_interest)
        if elsewhere or cycle.phase not in (None, THIS):
            continue
        one, other = blown.get(cycle.wind_speed_m_per_s, pair)
        distance, position = min(
            (_nearest((one, other), _region(line, share * path), place), place)
            for place, share in _places(line, cycle, alike=one.alike and other.alike)
        )
        yield PhaseClearanceRow(
            phase=one.name,
            other_phase=other.name,
            method="computed",
            together="any phase angle" if one.alike and other.alike else "at rest",
            model=cycle.model,
            loops=cycle.loops,
            wind_speed_m_per_s=cycle.wind_speed_m_per_s,
            branch=cycle.branch,
            stability=cycle.stability,
            position_m=position,
            **judged(distance, required_between(line, one.name, other.name)),
            **one.hung,
        )


def _places(line: Line, cycle: LimitCycleRow, *, alike: bool) -> list[tuple[float, float]]:
    """Return places along the span [m], and how large a motion is there over its size where it is observed."""
    if alike or line.section is not None:
        return [(cycle.observed_at_m, 1.0)]
    length = line.span.length
    found = [(length * i / PLACES, abs(math.sin(math.pi * cycle.loops * i / PLACES))) for i in range(PLACES + 1)]
    return [*found, (cycle.observed_at_m, 1.0)]


def _paths(line: Line, result: Result) -> Iterator[tuple[LimitCycleRow, FloatArray]]:
    """Yield every motion with V, W and Theta where it is observed: (3, points).

    A quasi-periodic motion has the corners of the box that its ranges span, which holds all of it.
    """
    for orbit in result.orbits:
        series = np.array([orbit.vertical, orbit.horizontal, orbit.torsional])
        yield result.limit_cycles[orbit.cycle], series @ fourier(PHASES, series.shape[-1] // 2).T
    for row in result.limit_cycles:
        sizes = row.vertical_m, row.horizontal_m, row.torsional_rad
        middles = row.vertical_middle_m, row.horizontal_middle_m, row.torsional_middle_rad
        if None not in {*sizes, *middles}:
            yield row, np.array(middles)[:, None] + np.array(sizes)[:, None] * CORNERS


def _nearest(pair: tuple[_Wire, _Wire], moving: FloatArray, place: float) -> float:
    """Return the distance of two phases at a place, of which those alike cover a region [m]."""
    region, beside = (moving if wire.alike else _region(wire.line, np.zeros((3, 1))) for wire in pair)
    return float(clearance(region, beside, pair[1].at_rest(place) - pair[0].at_rest(place)))


def _region(line: Line, path: FloatArray) -> FloatArray:
    """Return the support function of the region that all sub-conductors cover at points of a path (3, points)."""
    y, z = np.array(line.bundle.positions).T[..., None]
    v, w, theta = path
    return path_support(np.stack([y + v - z * theta, z + w + y * theta], axis=-1).reshape(-1, 2))


def _by_ellipses(line: Line, pair: tuple[_Wire, _Wire], method: EllipseMethod) -> PhaseClearanceRow:
    one, other = pair
    loops = LOOPS.get(method, 1)
    ellipses = [_ellipse(wire, method) for wire in pair]
    middle = 0.5 * line.span.length / loops
    away = other.at_rest(middle) - one.at_rest(middle)
    known = [ellipse_support(ellipse) for ellipse in ellipses if ellipse is not None]
    distance = float(clearance(known[0], known[1], away)) if len(known) == 2 else None
    own = ellipses[0]
    return PhaseClearanceRow(
        phase=one.name,
        other_phase=other.name,
        method=method.value,
        together="any phase angle",
        model=None,
        loops=loops,
        wind_speed_m_per_s=None,
        branch=None,
        stability=None,
        position_m=None,
        **judged(distance, required_between(line, one.name, other.name)),
        **one.hung,
        major_axis_m=None if own is None else own.major_axis,
        minor_axis_m=None if own is None else own.minor_axis,
        b_distance_m=None if own is None else own.b_distance,
    )


def _ellipse(wire: _Wire, method: EllipseMethod) -> Ellipse | None:
    """Return the ellipse of a phase, None where the method gives none."""
    return galloping_ellipse(
        method,
        float(wire.profile.sag[0]),
        wire.line.span.length,
        wire.line.conductor.diameter,
        len(wire.line.bundle.positions),
        float(wire.profile.tilt[0]),
    )
