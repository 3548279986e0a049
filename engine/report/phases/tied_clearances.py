"""Clearances between phases that gallop together: their distance at every instant of a motion, all along the span."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from engine.arrays import FloatArray, IntArray, ObjectArray
from engine.assemblies.assembled_line import AssembledLine
from engine.assemblies.phases import tied_places
from engine.cycles.harmonic_balance import states
from engine.mechanics.finite_elements import interpolation_at
from engine.mechanics.static_profile import arc_position, coordinates
from engine.report.findings import ModelFindings, cycle_loops, torus_loops
from engine.report.phases.required_clearances import judged, required_between
from engine.result import PhaseClearanceRow
from engine.tori.spectrum import sampled_states

SAMPLES = 240  # instants of a period; the smallest distance is exact to 1e-4 of the amplitude
SAME = 1e-9  # relative difference of distances that is none


@dataclass(frozen=True, slots=True)
class HungPhase:
    """A tied phase: its name and, at places along the span, how it hangs and moves.

    rest: (places, 2), y and z of its reference curve at rest [m]; shapes: (m, 3, places), V, W and Theta of each
    coordinate; bundle: (n, 2), y and z of its sub-conductors [m].
    """

    name: str
    rest: FloatArray
    shapes: FloatArray
    bundle: FloatArray

    def paths(self, q: FloatArray) -> FloatArray:
        """Return y and z [m] of all sub-conductors at all places for coordinates (k, m): (k, places, n, 2)."""
        v, w, theta = np.einsum("km,mfp->fkp", q, self.shapes)[..., None]
        y, z = self.bundle.T
        above, beside = self.rest[:, :1], self.rest[:, 1:]
        return np.stack([above + y + v - z * theta, beside + z + w + y * theta], axis=-1)


@dataclass(frozen=True, slots=True)
class _Motions:
    """Motions of one kind: wind speed index, family, loops and stability of each, and q (motions, samples, m)."""

    wind: IntArray
    branch: IntArray
    loops: IntArray
    stability: ObjectArray
    q: FloatArray


def tied_clearance_rows(whole: AssembledLine, findings: ModelFindings) -> list[PhaseClearanceRow]:
    """Return a row for every motion and pair of tied phases.

    Phases are compared in planes across the line, at evenly spaced places.
    """
    place = np.linspace(0.0, whole.line.span.length, 2 * whole.line.span.elements + 1)
    hung = hung_phases(whole, findings.model.shapes[0], place)
    return [
        _row(whole, pair, place, findings.winds[0], motions, i)
        for motions in _motions(findings)
        for i in range(motions.wind.size)
        for pair in combinations(hung, 2)
    ]


def hung_phases(whole: AssembledLine, shapes: FloatArray, place: FloatArray) -> list[HungPhase]:
    """Return all tied phases at horizontal places [m], for a model with shapes (m, 3, all nodes)."""
    profile, members = whole.members.profile, whole.assembly.members
    arc = arc_position(profile, np.broadcast_to(place, (members, place.size)))
    height = coordinates(profile, arc)[..., 1]
    fields = shapes.reshape(*shapes.shape[:-1], members, -1)
    found = []
    for i, (name, (y, z)) in enumerate(tied_places(whole.line).items()):
        at = np.zeros((fields.shape[-1], place.size))
        for j, x in enumerate(place.tolist()):
            first, values = interpolation_at(profile, i, whole.line.span.elements, x)
            at[first : first + 3, j] = values
        rest = np.stack([y + height[i], np.full(place.size, z)], axis=-1)
        bundle = np.array(whole.members.lines[i].bundle.positions)
        found.append(HungPhase(name, rest, fields[..., i, :] @ at, bundle))
    return found


def smallest_distance(one: HungPhase, other: HungPhase, q: FloatArray) -> tuple[float, int]:
    """Return the smallest distance of sub-conductors of two phases over instants q (k, m) [m], and the place's index.

    Of equal distances it is that of the first place.
    """
    apart = one.paths(q)[:, :, :, None] - other.paths(q)[:, :, None]
    distance = np.hypot(apart[..., 0], apart[..., 1]).min(axis=(0, 2, 3))
    place = int(np.flatnonzero(distance <= distance.min() * (1.0 + SAME))[0])
    return float(distance[place]), place


def _motions(findings: ModelFindings) -> Iterator[_Motions]:
    cycles, tori = findings.cycles, findings.quasi_periodic
    m = findings.model.mass.shape[-1]
    if cycles.member.size:
        q = states(cycles.orbits, 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES)[..., :m]
        yield _Motions(cycles.wind, cycles.branch, cycle_loops(findings), cycles.floquet.stability, q)
    if tori.member.size:
        q = sampled_states(tori.tori)[..., :m]
        yield _Motions(tori.wind, tori.branch, torus_loops(findings), tori.stability, q)


def _row(
    whole: AssembledLine,
    pair: tuple[HungPhase, HungPhase],
    place: FloatArray,
    winds: FloatArray,
    motions: _Motions,
    i: int,
) -> PhaseClearanceRow:
    distance, where = smallest_distance(*pair, motions.q[i])
    one, other = pair
    return PhaseClearanceRow(
        phase=one.name,
        other_phase=other.name,
        method="computed",
        together="in time",
        model="finite_element",
        loops=int(motions.loops[i]),
        wind_speed_m_per_s=float(winds[motions.wind[i]]),
        branch=int(motions.branch[i]),
        stability=motions.stability[i],
        position_m=float(place[where]),
        **judged(distance, required_between(whole.line, one.name, other.name)),
    )
