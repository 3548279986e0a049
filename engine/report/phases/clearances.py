"""Clearances between phases that no spacer ties, from the motions of the line, and by ellipses of design practice.

Such phases gallop as the line does, at whatever phase angle, where they are copies of it. A phase with ice or a line of
its own has other motions, which are not known here: it rests.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from engine.arrays import FloatArray
from engine.clearance import (
    Ellipse,
    EllipseMethod,
    clearance,
    ellipse_support,
    galloping_ellipse,
    path_support,
    subconductor_paths,
)
from engine.mechanics.static_profile import StaticProfile, arc_position, coordinates, static_profile
from engine.report.phases.required_clearances import judged, required_between
from engine.result import LimitCycleRow, Orbit, PhaseClearanceRow, Result
from engine.spec import THIS, Line, own_line

LOOPS = {EllipseMethod.TOYE: 2}  # of each method's ellipse; the others have one


@dataclass(frozen=True, slots=True)
class _Wire:
    """A phase as it hangs: name, attachment (y, z) [m], line, static state, and whether it gallops as the line does."""

    name: str
    place: tuple[float, float]
    line: Line
    profile: StaticProfile
    alike: bool

    def at_rest(self, position: float) -> FloatArray:
        """Return y and z of its reference curve at a horizontal position [m]: (2,)."""
        x = min(position, self.line.span.length)
        height = coordinates(self.profile, arc_position(self.profile, np.array([[x]])))[0, 0, 1:]
        return np.array(self.place) + height


def with_clearances(result: Result, line: Line) -> Result:
    """Return a result with the clearances to phases that no spacer ties, and those by ellipses."""
    if not line.phases:
        return result
    wires = list(_wires(line))
    tied = {name for spacer in line.interphase_spacers for name in spacer.between}
    rows = list(result.clearances)
    for pair in combinations(wires, 2):
        if not {wire.name for wire in pair} <= tied:
            rows += _computed(line, pair, result.limit_cycles, result.orbits)
    for pair in combinations(wires, 2):
        rows += [_by_ellipses(line, pair, method) for method in EllipseMethod]
    return replace(result, clearances=tuple(rows))


def _wires(line: Line) -> Iterator[_Wire]:
    calm = replace(line, wind=replace(line.wind, blow_out=None))
    yield _Wire(THIS, (0.0, 0.0), line, static_profile([calm]), True)
    for phase in line.phases:
        own = own_line(calm, phase)
        alike = phase.line is None and phase.ice is None
        yield _Wire(phase.name, (phase.y, phase.z), own, static_profile([own]), alike)


def _computed(
    line: Line, pair: tuple[_Wire, _Wire], cycles: Sequence[LimitCycleRow], orbits: Sequence[Orbit]
) -> Iterator[PhaseClearanceRow]:
    """Yield a row for every motion of the line, at the place where it is observed."""
    one, other = pair
    if not (one.alike or other.alike):
        return  # neither moves here
    for orbit in orbits:
        cycle = cycles[orbit.cycle]
        elsewhere = line.section is not None and cycle.span not in (None, line.section.span_of_interest)
        if elsewhere or cycle.phase not in (None, THIS):
            continue
        series = np.array([orbit.vertical, orbit.horizontal, orbit.torsional])
        moving = _support(line, series)
        region, beside = (moving if wire.alike else _support(wire.line, np.zeros((3, 1))) for wire in pair)
        away = other.at_rest(cycle.observed_at_m) - one.at_rest(cycle.observed_at_m)
        distance = float(clearance(region, beside, away))
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
            position_m=cycle.observed_at_m,
            **judged(distance, required_between(line, one.name, other.name)),
        )


def _support(line: Line, series: FloatArray) -> FloatArray:
    """Return the support function of the region that a motion with Fourier series (3, terms) covers."""
    return path_support(subconductor_paths(series, np.array(line.bundle.positions)).reshape(-1, 2))


def _by_ellipses(line: Line, pair: tuple[_Wire, _Wire], method: EllipseMethod) -> PhaseClearanceRow:
    one, other = pair
    loops = LOOPS.get(method, 1)
    regions = [_ellipse_support(wire, method) for wire in pair]
    middle = 0.5 * line.span.length / loops
    away = other.at_rest(middle) - one.at_rest(middle)
    known = [region for region in regions if region is not None]
    distance = float(clearance(known[0], known[1], away)) if len(known) == 2 else None
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
    )


def _ellipse_support(wire: _Wire, method: EllipseMethod) -> FloatArray | None:
    """Return the support function of a phase's ellipse [m], None where the method gives none."""
    ellipse: Ellipse | None = galloping_ellipse(
        method,
        float(wire.profile.sag[0]),
        wire.line.span.length,
        wire.line.conductor.diameter,
        len(wire.line.bundle.positions),
    )
    return None if ellipse is None else ellipse_support(ellipse)
