"""A search for lines with quasi-periodic motion, and a check of each motion by direct integration."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.lines import random_line, source_line
from benchmarks.models import discretized, hybrid_models
from benchmarks.validation.common import table
from engine.arrays import FloatArray
from engine.cycles.bifurcations import bifurcations
from engine.cycles.search import find_cycles
from engine.cycles.starts import explicit_starts
from engine.cycles.transitions import Kind
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel, take
from engine.numerics import polynomial
from engine.outcome import Stability
from engine.spec import Line, Span, TorusSearch
from engine.tori.quasi_periodic import QuasiPeriodicMotions, quasi_periodic_motions
from engine.tori.spectrum import base_frequencies
from engine.tori.two_frequency_balance import Tori, states

SEED = 19
LINES = 200
LOOPS = (1, 2, 3)
WINDS = np.linspace(3.0, 15.0, 7)
HIGHEST_WIND = 30.0
HARMONICS = 5
INTEGRATED = 3  # tori
CYCLES = 10_000
WINDOW = 2_500  # cycles whose spectra are compared
SAMPLES = 16  # a cycle


@dataclass(frozen=True, slots=True)
class Found:
    """A quasi-periodic motion with its line, the line's number in the drawn sequence, number of loops and model."""

    number: int
    line: Line
    loops: int
    model: ReducedModel
    torus: Tori
    stability: Stability


def section() -> Iterator[str]:
    """Yield the section's text."""
    counts, found = _searched()
    yield "## Quasi-periodic motions\n"
    yield (
        f"The search covers {LINES} lines of a seeded generator (half the source's, half random bundles) with spans of "
        "60 to 350 m, tensions of 15 to 45 kN, torsional damping ratios of 0.001 to 0.3 and vertical and horizontal "
        "ratios of 0.0002 to 0.01, evenly distributed in the logarithm. It takes the hybrid model with "
        f"{', '.join(map(str, LOOPS))} loops alone, winds of {', '.join(f'{wind:g}' for wind in WINDS)} m/s, and the "
        "tori that may be stable (`quasi_periodic: lasting`).\n"
    )
    yield table(["", "count"], list(counts.items()))
    stable = [one for one in found if one.stability is Stability.STABLE]
    if not stable:
        yield "\nThe search found no stable quasi-periodic motion."
        return
    first = list({one.number: one for one in reversed(stable)}.values())[::-1][:INTEGRATED]
    yield (
        f"\nFor the first {len(first)} lines with a stable torus, direct integration (DOP853, relative tolerance 1e-7) "
        f"starts on the torus with all rates raised by 1 % and runs for {CYCLES} cycles. The table sets both "
        f"frequencies in the spectrum of the last {WINDOW} cycles beside those of the two-frequency balance. The last "
        "two columns are the strength of both spectral lines, relative to the balance: 1 if the line persists.\n"
    )
    head = ["line", "n", "span m", "loops", "wind m/s", "f1 Hz", "f1 integrated", "f2 Hz", "f2 integrated"]
    yield table([*head, "line 1", "line 2"], list(_rows(first)))


@cache
def _searched() -> tuple[dict[str, int], list[Found]]:
    """Analyse the drawn lines; return counts and the quasi-periodic motions."""
    generator = np.random.default_rng(SEED)
    counts = dict.fromkeys(("models that are statically stable", "with torus points", "wind speeds of those models"), 0)
    motions: list[Found] = []
    missing = 0
    for number in range(LINES):
        line = drawn(generator)
        for loops, model, known, points in _analysed(line):
            counts["models that are statically stable"] += 1
            counts["with torus points"] += points
            counts["wind speeds of those models"] += points * WINDS.size
            missing += len(known.missing)
            motions += _listed((number, line), loops, model, known)
    by_verdict = {f"{verdict} tori": sum(m.stability is verdict for m in motions) for verdict in Stability}
    return counts | by_verdict | {"wind speeds at which no stable motion was found": missing}, motions


def drawn(generator: np.random.Generator) -> Line:
    """Draw one of the source's lines or a random bundle, with span, tension and damping over wide ranges."""
    own = generator.random() < 0.5
    line = source_line(int(generator.integers(1, 5))) if own else random_line(generator)
    ratios = 10.0 ** generator.uniform((-3.7, -3.7, -3.0), (-2.0, -2.0, -0.5))
    vertical, horizontal, torsional = ratios.tolist()
    damping = replace(line.damping, vertical_ratio=vertical, horizontal_ratio=horizontal, torsional_ratio=torsional)
    span = Span(float(generator.uniform(60.0, 350.0)), horizontal_tension=float(generator.uniform(15e3, 45e3)))
    return replace(line, damping=damping, span=span)


def _analysed(line: Line) -> Iterator[tuple[int, ReducedModel, QuasiPeriodicMotions, bool]]:
    """Yield number of loops, model, motions and whether there is a torus point, where the static state is stable."""
    discretization = discretized((line,))
    models, published = hybrid_models(discretization, LOOPS)
    for i, loops in enumerate(LOOPS):
        model, other = take(models, [i]), take(published, [i])
        if not model.statically_unstable[0]:
            crossings = critical_wind_speeds(model, HIGHEST_WIND)
            cycles = find_cycles(model, crossings, WINDS, explicit_starts(other, model, WINDS, HARMONICS), HARMONICS)
            found = bifurcations(cycles.branch_sets, cycles.followed, model, crossings)
            known = quasi_periodic_motions(model, cycles, found, WINDS, TorusSearch.LASTING)
            yield loops, model, known, any(kind is Kind.TORUS for kind in found.kind)


def _listed(line: tuple[int, Line], loops: int, model: ReducedModel, known: QuasiPeriodicMotions) -> Iterator[Found]:
    for i in range(known.member.size):
        yield Found(*line, loops, model, known.tori.select(np.array([i])), known.stability[i])


def _rows(found: list[Found]) -> Iterator[list[object]]:
    """Yield a row of the table for each torus; all are integrated side by side, each in its own phase w t."""
    tau = 2.0 * math.pi * (CYCLES - WINDOW + np.arange(WINDOW * SAMPLES) / SAMPLES)
    for one, reached in zip(found, _integrated(found, tau), strict=True):
        fast = float(one.torus.angular_frequency[0, 0])
        times = tau / fast
        balanced = states(one.torus, times[:, None] * one.torus.angular_frequency[0])[0, :, _largest(one)]
        frequencies = base_frequencies(one.model, np.zeros(1, dtype=np.intp), one.torus)[0][0] / (2.0 * math.pi)
        cells: list[object] = [one.number, len(one.line.bundle.positions), f"{one.line.span.length:.1f}", one.loops]
        cells.append(f"{one.torus.wind_speed[0]:g}")
        shares = []
        for frequency in frequencies.tolist():
            (_, own), (there, strength) = (spectral_line(times, values, frequency) for values in (balanced, reached))
            cells += [f"{frequency:.6f}", f"{there:.6f}"]
            shares.append(f"{strength / own:.4f}")
        yield [*cells, *shares]


def _largest(one: Found) -> int:
    strength = one.model.modal_masses[0] * (one.torus.coefficients[0, :, 1:] ** 2).sum(axis=-1)
    return int(strength.argmax())


def _integrated(found: list[Found], tau: FloatArray) -> list[FloatArray]:
    """Integrate from a state near each torus; return its largest coordinate at w t = tau."""
    fast = np.array([float(one.torus.angular_frequency[0, 0]) for one in found])
    wind = np.array([float(one.torus.wind_speed[0]) for one in found])
    inverse = np.linalg.inv(np.concatenate([one.model.mass for one in found]))
    stiffness, damping = (
        inverse @ np.concatenate([getattr(one.model, name) for one in found]) for name in ("stiffness", "damping")
    )
    m = inverse.shape[-1]
    by_state = np.concatenate([np.zeros_like(inverse), np.broadcast_to(np.eye(m), inverse.shape)], axis=-1)
    linear = np.concatenate([by_state, np.concatenate([-stiffness, -damping], axis=-1)], axis=1) / fast[:, None, None]
    forms = np.concatenate([one.model.load.forms[:, 0] for one in found])
    forms[..., m:] /= wind[:, None, None]
    monomials = np.concatenate([one.model.load.table[:, 0] for one in found])
    cubic = (wind**2 / fast)[:, None, None] * (inverse @ monomials)

    def rate(_: float, flat: FloatArray) -> FloatArray:
        y = flat.reshape(len(found), 2 * m, 1)
        result = linear @ y
        result[:, m:] += cubic @ polynomial.powers((forms @ y)[..., 0])[..., None]
        return np.asarray(result.ravel())

    start = np.stack([states(one.torus, np.zeros((1, 2)))[0, 0] for one in found])
    start[:, m:] *= 1.01 * wind[:, None]
    span = (0.0, float(tau[-1]))
    run = solve_ivp(rate, span, start.ravel(), method="DOP853", t_eval=tau, rtol=1e-7, atol=1e-9)
    return [run.y[2 * m * i + _largest(one)] for i, one in enumerate(found)]


def spectral_line(times: FloatArray, values: FloatArray, near: float) -> tuple[float, float]:
    """Return frequency [Hz] and amplitude of the spectral line nearest to a frequency, through Hann's window."""
    weight = np.hanning(times.size)
    weight /= weight.sum()
    length = float(times[-1] - times[0])
    trials = near + np.linspace(-2.0, 2.0, 81) / length
    strength = np.abs(np.exp(-2j * math.pi * trials[:, None] * (times - times[0])) @ (weight * values))
    best = int(strength.argmax())
    return float(trials[best]), 2.0 * float(strength[best])
