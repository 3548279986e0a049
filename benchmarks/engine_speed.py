"""Speed of the engine against direct integration, AUTO, and the LAPACK calls that its numpy form needs."""

import cProfile
import itertools
import pstats
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np
from scipy.integrate import solve_ivp

from app.convert import STACK
from benchmarks.auto import Branch, continued_branch
from benchmarks.lines import random_line, source_line, under_full_physics
from benchmarks.measure import median_ratio, median_seconds, numpy_forms, recorded_lapack, side_by_side
from benchmarks.models import discretized, hybrid_models, plain_rate
from engine.analysis import analyse_stack
from engine.arrays import FloatArray
from engine.cycles.floquet import Floquet, floquet
from engine.cycles.harmonic_balance import balance, half_peak_to_peak, select, states
from engine.cycles.search import Cycles, find_cycles
from engine.cycles.starts import explicit_starts
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel, take
from engine.progress import finished
from engine.result import Result
from engine.spec import Analysis, Line, Model
from worker.memory import settle

HARMONICS = 5
HIGHEST_WIND = 30.0  # m/s
STANDARD_JOB = Analysis(
    loops=(1, 2),
    models=(Model.HYBRID, Model.FINITE_ELEMENT),
    finite_element_loops=(),
    wind_speeds=tuple(np.linspace(4.0, 12.0, 11).tolist()),
)
SOURCE_WINDS = np.array([4.0, 6.0])
PARTS = 5  # stacks over which the fleet's figures are medians
LONGEST = 6000  # most cycles of direct integration


def found_cycles(model: ReducedModel, published: ReducedModel, winds: FloatArray) -> Cycles:
    """Find all cycles and their stability, as an analysis does."""
    crossings = critical_wind_speeds(model, HIGHEST_WIND)
    return find_cycles(model, crossings, winds, explicit_starts(published, model, winds, HARMONICS), HARMONICS)


def settled_amplitude(model: ReducedModel, wind: float) -> tuple[FloatArray, int]:
    """Integrate until the amplitude moves less than 0.1 % over 50 cycles; return it and the number of cycles."""
    rate = plain_rate(model, wind)
    period = 2.0 * np.pi / np.sqrt(model.stiffness[0, 0] / model.mass[0, 0])
    span = (0.0, 50.0 * period)
    times = np.linspace(*span, 50 * 48 + 1)
    state, before = np.full(6, 1e-2), np.full(3, np.inf)
    block = 0
    while block < LONGEST // 50:
        block += 1
        run = solve_ivp(rate, span, state, method="DOP853", t_eval=times, rtol=1e-8, atol=1e-10)
        state = run.y[:, -1]
        last = run.y[:3, -10 * 48 :]
        amplitude = 0.5 * np.ptp(last, axis=1)
        if (np.abs(amplitude - before) <= 1e-3 * amplitude).all():
            break
        before = amplitude
    return amplitude, 50 * block


def one_cycle() -> Iterator[tuple[str, float]]:
    """Yield the figures of a limit cycle of the source's lines against direct integration."""
    discretization = discretized([source_line(n) for n in (1, 2, 3)])
    model, published = hybrid_models(discretization, (1, 2))
    members, winds = range(model.mass.shape[0]), SOURCE_WINDS
    cycles = found_cycles(model, published, winds)
    count = int((cycles.floquet.stability == "stable").sum())

    def alone() -> None:
        for i, j in itertools.product(members, range(winds.size)):
            found_cycles(take(model, [i]), take(published, [i]), winds[j : j + 1])

    def bare() -> None:
        for i, j in itertools.product(members, range(winds.size)):
            _bare(take(model, [i]), take(published, [i]), winds[j : j + 1])

    settled: dict[tuple[int, int], tuple[FloatArray, int]] = {}
    direct, engine = 0.0, []
    for i, j in itertools.product(members, range(winds.size)):
        begin = time.perf_counter()
        settled[i, j] = settled_amplitude(take(model, i), float(winds[j]))
        direct += (time.perf_counter() - begin) / (len(members) * winds.size)
        # Between the integrations, so that both see the drift of the machine's speed.
        engine.append(side_by_side(lambda: found_cycles(model, published, winds), alone, bare, runs=1))
    stacked, each, plain = (float(np.median(times)) for times in zip(*engine, strict=True))
    yield "cycle_direct_seconds", direct
    yield "cycle_direct_cycles", float(np.mean([n for _, n in settled.values()]))
    yield "cycle_stack_seconds", stacked / count
    yield "cycle_alone_seconds", each / len(settled)
    yield "cycle_bare_seconds", plain / len(settled)
    yield "cycle_ratio", direct * count / stacked
    yield "cycle_ratio_alone", direct * len(settled) / each
    yield "cycle_ratio_bare", direct * len(settled) / plain
    yield "cycle_direct_error", _largest_difference(cycles, settled)
    held = {(i, j): _held_amplitude(model, cycles, i, j) for i, j in settled}
    yield "cycle_error", _largest_difference(cycles, held)


def _bare(model: ReducedModel, published: ReducedModel, winds: FloatArray) -> Floquet:
    """Balance the explicit starts and compute their multipliers, without any other search."""
    starts = explicit_starts(published, model, winds, HARMONICS)
    orbits, _ = balance(model, starts.member, starts.orbits)
    return floquet(model, starts.member, orbits)


def _held_amplitude(model: ReducedModel, cycles: Cycles, i: int, j: int) -> tuple[FloatArray, int]:
    """Integrate 100 periods from a stable cycle of the engine; return the amplitude over the last ten, and 100."""
    index = np.flatnonzero((cycles.member == i) & (cycles.wind == j) & (cycles.floquet.stability == "stable"))[:1]
    orbit = select(cycles.orbits, index)
    wind, period = float(orbit.wind_speed[0]), 2.0 * np.pi / float(orbit.angular_frequency[0])
    start = states(orbit, np.zeros(1))[0, 0] * np.array([1.0, 1.0, 1.0, wind, wind, wind])
    times = np.linspace(90.0 * period, 100.0 * period, 10 * 96 + 1)
    rate = plain_rate(take(model, i), wind)
    run = solve_ivp(rate, (0.0, times[-1]), start, method="DOP853", t_eval=times, rtol=1e-10, atol=1e-12)
    return 0.5 * np.ptp(run.y[:3], axis=1), 100


def _largest_difference(cycles: Cycles, settled: dict[tuple[int, int], tuple[FloatArray, int]]) -> float:
    """Return the largest relative difference of the dominant amplitude from direct integration."""
    errors = []
    for (i, j), (amplitude, _) in settled.items():
        here = (cycles.member == i) & (cycles.wind == j) & (cycles.floquet.stability == "stable")
        own = half_peak_to_peak(cycles.orbits.coefficients[here])
        main = int(amplitude[:2].argmax())
        errors.append(np.abs(own[:, main] / amplitude[main] - 1.0).min(initial=np.inf))
    return float(max(errors))


def branch() -> Iterator[tuple[str, float]]:
    """Yield the figures of whole branches with Floquet stability at 41 wind speeds, against AUTO."""
    discretization = discretized([source_line(n) for n in (2, 3)])
    model, published = hybrid_models(discretization, (1, 2))
    winds, members = np.linspace(2.6, 6.0, 41), range(model.mass.shape[0])
    lone = [(take(model, [i]), take(published, [i])) for i in members]
    runs: list[Branch] = []

    def every_alone() -> None:
        for own, its_published in lone:
            found_cycles(own, its_published, winds)

    _, alone, together = side_by_side(
        lambda: runs.extend(continued_branch(take(model, i), 2.0, 6.0) for i in members),
        every_alone,
        lambda: found_cycles(model, published, winds),
    )
    yield "branch_auto_seconds", float(np.median([run.seconds for run in runs]))
    yield "branch_auto_points", float(np.median([run.wind_speed.size for run in runs]))
    solved = [sum(run.seconds for run in runs[i : i + len(lone)]) for i in range(0, len(runs), len(lone))]
    yield "branch_ratio", median_ratio(solved, together)
    yield "branch_ratio_alone", median_ratio(solved, alone)
    with numpy_forms():
        plain = median_seconds(every_alone, 3)
    yield "branch_compiled_gain", plain / float(np.median(alone))
    yield "branch_difference", max(_difference(a, b, runs[i]) for i, (a, b) in enumerate(lone))


def _difference(model: ReducedModel, published: ReducedModel, auto: Branch) -> float:
    """Return the largest relative difference of the dominant amplitude at the wind speeds where AUTO has points."""
    inside = auto.wind_speed > 2.6
    winds = np.sort(auto.wind_speed[inside])
    amplitude = auto.amplitude[inside][np.argsort(auto.wind_speed[inside])]
    cycles = found_cycles(model, published, winds)
    own = half_peak_to_peak(cycles.orbits.coefficients)
    main = int(amplitude[-1, :2].argmax())
    gaps = [
        np.abs(own[cycles.wind == j, main] / amplitude[j, main] - 1.0).min(initial=np.inf) for j in range(winds.size)
    ]
    return float(max(gaps))


def analysed(lines: Sequence[Line], analysis: Analysis) -> list[Result]:
    """Analyse lines, one stack after another."""
    results: list[Result] = []
    for first in range(0, len(lines), STACK):
        results += finished(analyse_stack(lines[first : first + STACK], analysis))
    return results


def fleet(largest: int) -> Iterator[tuple[str, float]]:
    """Yield lines per second and core, the ratios to LAPACK alone and to the numpy forms, and the exponent of cost."""
    generator = np.random.default_rng(20260101)
    lines = [random_line(generator) for _ in range(min(largest, 2000))]
    analysed(lines[:STACK], STANDARD_JOB)
    settle()
    rates, floors, gains = [], [], []
    for first in range(0, PARTS * STACK, STACK):
        part = lines[first : first + STACK]
        with numpy_forms(), recorded_lapack() as calls:
            analysed(part, STANDARD_JOB)
        with numpy_forms():
            plain = median_seconds(lambda part=part: analysed(part, STANDARD_JOB), 1)  # type: ignore[misc]
        begin = time.perf_counter()
        analysed(part, STANDARD_JOB)
        whole = time.perf_counter() - begin
        gains.append(plain / whole)
        begin = time.perf_counter()
        calls.replay()
        floors.append(whole / (time.perf_counter() - begin))
        rates.append(STACK / whole)
    yield "fleet_lines_per_s_core", float(np.median(rates))
    yield "fleet_floor_ratio", float(np.median(floors))
    yield "fleet_compiled_gain", float(np.median(gains))
    yield "fleet_exponent", _exponent(lines, largest)


def full_fleet() -> Iterator[tuple[str, float]]:
    """Yield lines per second and core under full physics, and their rate over that of the source's, taken in turn."""
    generator = np.random.default_rng(20260101)
    full, source = [], []
    settle()
    for _ in range(PARTS):
        lines = [random_line(generator) for _ in range(STACK)]
        iced, analysis = under_full_physics(lines, STANDARD_JOB)
        times = side_by_side(partial(analysed, iced, analysis), partial(analysed, lines, STANDARD_JOB), runs=3)
        full += times[0]
        source += times[1]
    yield "fleet_full_lines_per_s_core", STACK / float(np.median(full))
    yield "fleet_full_ratio", median_ratio(source, full)


def profile() -> list[tuple[str, float]]:
    """Return the share of a fleet's time spent in each module of the engine and in numpy's LAPACK calls."""
    generator = np.random.default_rng(20260101)
    lines = [random_line(generator) for _ in range(2 * STACK)]
    profiler = cProfile.Profile()
    profiler.runcall(analysed, lines, STANDARD_JOB)
    times: Counter[str] = Counter()
    for (path, _, function), (_, _, own, _, _) in pstats.Stats(profiler).stats.items():  # type: ignore[attr-defined]
        times[_place(path, function)] += own
    whole = sum(times.values())
    return [(place, own / whole) for place, own in times.most_common()]


def _place(path: str, function: str) -> str:
    if "/engine/" in path:
        return "engine/" + path.rsplit("/engine/", 1)[1]
    if "engine.kernels._kernels" in function:
        return f"compiled: {function.rsplit('.', 1)[1].rstrip('>')}"
    return f"numpy.linalg.{function}" if path.endswith("_linalg.py") else "Python and numpy besides"


def _exponent(lines: list[Line], largest: int) -> float:
    """Fit the time as a power of the number of lines; sizes above the number of drawn lines repeat them."""
    sizes = [n for n in (100, 1000, 10_000, 100_000) if n <= largest]
    times = []
    for size in sizes:
        whole, rest = divmod(size, len(lines))
        begin = time.perf_counter()
        for _ in range(whole):
            analysed(lines, STANDARD_JOB)
        analysed(lines[:rest], STANDARD_JOB)
        times.append(time.perf_counter() - begin)
    return float(np.polyfit(np.log(sizes), np.log(times), 1)[0])


def hybrid_against_finite_element() -> Iterator[tuple[str, float]]:
    """Yield the time of the finite element model over that of the hybrid model on the source's lines."""
    lines = [source_line(n) for n in (1, 2, 3, 4)]
    winds = tuple(np.linspace(4.0, 6.0, 5).tolist())
    hybrid = Analysis(models=(Model.HYBRID,), wind_speeds=winds)
    both = Analysis(wind_speeds=winds)
    lean = median_seconds(lambda: analysed(lines, hybrid))
    full = median_seconds(lambda: analysed(lines, both))
    yield "finite_element_over_hybrid", (full - lean) / lean
