"""Attractors that direct integration reaches from a spread of starts, compared with the stable motions reported."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from enum import StrEnum

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.engine_speed import analysed
from benchmarks.lines import random_line, under_full_physics
from benchmarks.models import discretized, hybrid_models, plain_rate
from benchmarks.starts import LEVELS, LONGEST, LOOPS, MIXES, SOURCE, WINDS, Case, Ends, ends
from benchmarks.validation.common import table
from engine.arrays import FloatArray
from engine.checks.direct_starts import spread_starts
from engine.checks.settled_motion import STEPS, SettledMotions, lawson_equations, lawson_step
from engine.models.hybrid import loop_groups
from engine.models.reduced_model import take
from engine.outcome import Outcome
from engine.result import LimitCycleRow, Orbit, Result
from engine.spec import Analysis, Line

SEED, LINES = 20261122, 96
COMPARED, COMPARED_LINES = 40, 8  # shortest periods, and lines, compared with DOP853
SAME = 0.01  # relative distance of two motions that count as one
STRAIGHT = 0.9  # least share of a motion's last change that brings it nearer to the motion that it approaches


class Verdict(StrEnum):
    """What the engine reports about an attractor."""

    REPORTED = "reported as stable"
    MISJUDGED = "reported, but not as stable"
    MISSED = "not reported"


@dataclass(frozen=True, slots=True)
class Attractor:
    """A motion on which starts of one case settled.

    size: (6,), root mean square of V, W [m], Theta [rad] and their rates where they are observed; starts: their number;
    verdict; nearest: distance of the nearest stable motion that the engine reports, relative to the larger of both.
    """

    case: Case
    size: FloatArray
    starts: int
    verdict: Verdict
    nearest: float

    @property
    def amplitude(self) -> FloatArray:
        """Amplitudes V, W [m] and Theta [rad] of a harmonic motion of this size: (3,)."""
        return np.asarray(np.sqrt(2.0) * self.size[:3])

    @property
    def frequency(self) -> float:
        """Frequency of the largest coordinate, as if it were harmonic [Hz]."""
        largest = int((self.case.weight * self.size[:3]).argmax())
        return float(self.size[3 + largest] / self.size[largest] / (2.0 * np.pi)) if self.size.any() else 0.0


@dataclass(frozen=True, slots=True)
class Explored:
    """Outcome of all starts of some lines.

    approaching, unsettled, diverged: the case of each start that was still approaching a reported stable motion, that
    still changed otherwise, and that diverged; starts: number of all starts; stable: number of motions reported as
    stable; unreached: number of these on which no start settled.
    """

    cases: list[Case]
    attractors: list[Attractor]
    approaching: list[Case]
    unsettled: list[Case]
    diverged: list[Case]
    starts: int
    stable: int
    unreached: int


def reported(lines: Sequence[Line], winds: Sequence[float] = WINDS, analysis: Analysis = SOURCE) -> list[Result]:
    """Analyse lines with the hybrid model."""
    return analysed(lines, replace(analysis, wind_speeds=tuple(winds)))


def explored(lines: Sequence[Line], analysis: Analysis) -> Explored:
    """Compare the ends of starts with the stable motions reported, under the physics of an analysis."""
    results = reported(lines, WINDS, analysis)
    groups = [replace(analysis, loops=group) for group in loop_groups(analysis.loops, analysis)]
    parts = [compared(ends(lines, SEED, analysis=asked), results) for asked in groups]
    return Explored(
        *(sum((getattr(part, f.name) for part in parts[1:]), getattr(parts[0], f.name)) for f in fields(Explored))
    )


def compared(ended: Ends, results: Sequence[Result]) -> Explored:
    """Compare the ends of starts with the results of `reported` for the same lines and wind speeds."""
    runs, each = ended.runs, ended.runs.outcome.size // len(ended.cases)
    found = Explored(ended.cases, [], [], [], [], runs.outcome.size, 0, 0)
    for i, case in enumerate(ended.cases):
        rows = np.arange(i * each, (i + 1) * each)
        stable, others = _reported(results[case.line - 1], case)
        reached: set[int] = set()
        for row in rows[runs.outcome[rows] == Outcome.LIMIT_REACHED]:
            towards = any(_comes_nearer(case, runs, row, motion) for motion in stable)
            (found.approaching if towards else found.unsettled).append(case)
        found.diverged.extend([case] * int((runs.outcome[rows] == Outcome.NO_CONVERGENCE).sum()))
        for end, count in _distinct(case, runs.size[rows[runs.outcome[rows] == Outcome.CONVERGED]]):
            found.attractors.append(_judged(case, end, count, stable, others))
            reached |= {k for k, motion in enumerate(stable) if _distance(case, motion, end) <= SAME}
        found = replace(
            found, stable=found.stable + len(stable), unreached=found.unreached + len(stable) - len(reached)
        )
    return found


def _comes_nearer(case: Case, runs: SettledMotions, row: int, motion: FloatArray) -> bool:
    """Return whether a start approaches a motion of size (6,) in a straight line."""
    before, now = runs.before[row], runs.size[row]
    was, is_now, step = (np.linalg.norm(case.weight * x[:3]) for x in (before - motion, now - motion, now - before))
    return bool(was - is_now > STRAIGHT * step)


def _distinct(case: Case, ends: FloatArray) -> list[tuple[FloatArray, int]]:
    """Return the distinct motions (6,) among ends (k, 6), each with the number of starts that led there."""
    found: list[tuple[FloatArray, int]] = []
    for end in ends:
        same = next((j for j, (other, _) in enumerate(found) if _distance(case, end, other) <= SAME), None)
        if same is None:
            found.append((end, 1))
        else:
            found[same] = (found[same][0], found[same][1] + 1)
    return found


def _judged(case: Case, size: FloatArray, count: int, stable: list[FloatArray], others: list[FloatArray]) -> Attractor:
    near, elsewhere = (min((_distance(case, size, m) for m in motions), default=np.inf) for motions in (stable, others))
    verdict = Verdict.MISJUDGED if elsewhere <= SAME else Verdict.MISSED
    return Attractor(case, size, count, Verdict.REPORTED if near <= SAME else verdict, near)


def _distance(case: Case, one: FloatArray, other: FloatArray) -> float:
    """Return the distance of two motions (6,) in the kinetic energy, relative to the larger of both."""
    a, b = (case.weight * motion[:3] for motion in (one, other))
    rate_a, rate_b = (case.weight * motion[3:] for motion in (one, other))
    larger = max(np.linalg.norm(a), np.linalg.norm(b))
    if larger == 0.0:
        return 0.0
    quicker = max(np.linalg.norm(rate_a), np.linalg.norm(rate_b))
    return float(max(np.linalg.norm(a - b) / larger, np.linalg.norm(rate_a - rate_b) / quicker))


def _reported(result: Result, case: Case) -> tuple[list[FloatArray], list[FloatArray]]:
    """Return the sizes (6,) of the motions that a result holds for a case: the stable ones, and the others."""
    orbits = {orbit.cycle: orbit for orbit in result.orbits}
    stable: list[FloatArray] = []
    others: list[FloatArray] = []
    for i, row in enumerate(result.limit_cycles):
        if (row.loops, row.wind_speed_m_per_s) == (case.loops, case.wind_speed) and row.vertical_m is not None:
            size = _size(row, orbits[i]) if i in orbits else np.zeros(6)
            (stable if row.stability == "stable" else others).append(size)
    return stable, others


def _size(row: LimitCycleRow, orbit: Orbit) -> FloatArray:
    """Return the root mean square of V, W, Theta and their rates: (6,)."""
    series = np.array([orbit.vertical, orbit.horizontal, orbit.torsional])
    order = np.repeat(np.arange(1, series.shape[1] // 2 + 1), 2) * 2.0 * np.pi * (row.frequency_hz or 0.0)
    waves = 0.5 * series[:, 1:] ** 2
    return np.asarray(np.sqrt(np.concatenate([series[:, 0] ** 2 + waves.sum(axis=1), (waves * order**2).sum(axis=1)])))


def integration_error(lines: Sequence[Line], seed: int) -> float:
    """Return the largest relative difference from DOP853 (tolerance 1e-11) after some periods.

    The starts are the mixed ones of the second largest size for each line and number of loops at the highest wind
    speed; some of the largest diverge.
    """
    model, _ = hybrid_models(discretized(lines), LOOPS)
    member = np.flatnonzero(~model.statically_unstable)
    wind = np.full(member.size, WINDS[-1])
    start = spread_starts(model, member, wind, LEVELS, np.random.default_rng(seed))[:, -1 - MIXES]
    equations = lawson_equations(model, member, wind)
    state = start.T
    for _ in range(COMPARED * STEPS):
        state = lawson_step(equations, state)
    errors = []
    for i in range(member.size):
        rate, end = plain_rate(take(model, int(member[i])), WINDS[-1]), COMPARED * STEPS * float(equations.step[i])
        run = solve_ivp(rate, (0.0, end), start[i], method="DOP853", rtol=1e-11, atol=1e-13)
        errors.append(float(np.abs(run.y[:, -1] - state[:, i]).max() / np.abs(run.y[:, -1]).max()))
    return max(errors)


def section() -> Iterator[str]:
    """Yield the section's text."""
    generator = np.random.default_rng(SEED)
    lines = [random_line(generator) for _ in range(LINES)]
    found = explored(lines, SOURCE)
    yield "## Completeness: where direct integration ends\n"
    yield (
        f"{LINES} random lines (seed {SEED}), loops {_listed(LOOPS)}, wind speeds {_listed(WINDS)} m/s: "
        f"{len(found.cases)} cases of the hybrid model. Each case is integrated from "
        f"{found.starts // len(found.cases)} starts: vertical, horizontal, torsional and mixed, with random phases and "
        f"four sizes up to {LEVELS[-1]:g} rad of torsion or of the angle by which the motion turns the wind. An "
        f"integration lasts at most {LONGEST} blocks of fifty of the shortest periods. The method "
        f"(engine/checks/settled_motion.py) is within {integration_error(lines[:COMPARED_LINES], SEED):.0e} of DOP853 "
        f"after {COMPARED} periods from starts of {LEVELS[-2]:g} rad. Two motions count as one if their sizes by "
        f"direction and those of their velocities differ by less than {SAME:.0%}. The largest difference between an "
        f"attractor and the motion reported for it is {_worst(found):.2%}.\n"
    )
    yield from _listing(found)


def full_section() -> Iterator[str]:
    """Yield the text of the same under full physics."""
    generator = np.random.default_rng(SEED)
    lines, analysis = under_full_physics([random_line(generator) for _ in range(LINES)], SOURCE)
    found = explored(lines, analysis)
    yield "## Completeness under full physics\n"
    yield (
        "The same lines, winds and starts with coefficients at rest C_y0 = 0, C_z0 = 1, C_theta0 = 0, relative wind at "
        "every sub-conductor, condensed longitudinal inertia, stretching and free sections, without static twist; the "
        f"relief coordinate has starts of its own. {len(found.cases)} cases with {found.starts} starts. The largest "
        f"difference between an attractor and the motion reported for it is {_worst(found):.2%}.\n"
    )
    yield from _listing(found)


def _listing(found: Explored) -> Iterator[str]:
    """Yield the counts, and the attractors and starts that no motion explains."""
    yield table(["", "number"], list(_counts(found)))
    missed = [a for a in found.attractors if a.verdict is not Verdict.REPORTED]
    if missed:
        yield "\nAttractors that are not reported as stable:\n"
        head = ["line", "loops", "wind m/s", "starts", "vertical m", "horizontal m", "torsional rad", "Hz", ""]
        yield table(head, [_missed_row(a) for a in missed])
    unsettled = "unsettled at the end, approaching no reported motion"
    for text, cases in ((unsettled, found.unsettled), ("that diverged", found.diverged)):
        if cases:
            yield f"\nStarts {text}, by line, loops and wind speed: {_placed(cases)}."


def _listed(values: Sequence[float]) -> str:
    return ", ".join(f"{value:g}" for value in values[:-1]) + f" and {values[-1]:g}"


def _worst(found: Explored) -> float:
    return max((a.nearest for a in found.attractors if a.verdict is Verdict.REPORTED), default=0.0)


def _counts(found: Explored) -> Iterator[list[object]]:
    settled_starts = sum(a.starts for a in found.attractors)
    yield ["starts", found.starts]
    yield ["settled", settled_starts]
    yield ["unsettled at the end, but approaching a motion reported as stable", len(found.approaching)]
    yield ["unsettled at the end, approaching no such motion", len(found.unsettled)]
    yield ["diverged (angle of attack beyond 180 degrees)", len(found.diverged)]
    yield ["attractors that starts settled on, the state at rest included", len(found.attractors)]
    for verdict in Verdict:
        yield [f"of these {verdict.value}", sum(a.verdict is verdict for a in found.attractors)]
    yield ["motions reported as stable, the state at rest included", found.stable]
    yield ["of these, not reached by any start", found.unreached]


def _missed_row(a: Attractor) -> list[object]:
    amplitudes = [f"{value:.4f}" for value in a.amplitude.tolist()]
    case = a.case
    return [case.line, case.loops, f"{case.wind_speed:g}", a.starts, *amplitudes, f"{a.frequency:.4f}", a.verdict.value]


def _placed(cases: Sequence[Case]) -> str:
    counted = Counter(f"{case.line}/{case.loops}/{case.wind_speed:g}" for case in cases)
    return ", ".join(f"{place} ({count})" for place, count in counted.items())
