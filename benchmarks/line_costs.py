"""The computing time of a line, by what its analysis asks for; the service sizes the messages of a batch with it."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from app.convert import STACK
from benchmarks.engine_speed import analysed
from benchmarks.lines import random_line
from benchmarks.measure import median_seconds
from engine.spec import Analysis, Check, Line, LoopCompetition, Model, StaticTwist

FEW, MANY = 3, 23  # wind speeds; direct integration starts at three of them
HYBRID = Analysis(loops=(1, 2), models=(Model.HYBRID,))
FREQUENCIES = replace(HYBRID, models=(Model.HYBRID, Model.FINITE_ELEMENT), finite_element_loops=())
FINITE_ELEMENT = replace(FREQUENCIES, finite_element_loops=(1, 2, 3))


def costs() -> Iterator[tuple[str, float]]:
    """Yield each part of the computing time per line, by name [s on one core]."""
    generator = np.random.default_rng(20260101)
    lines = [random_line(generator) for _ in range(STACK)]
    fixed, per_wind = _fitted(lines, HYBRID)
    loops = len(HYBRID.loops)
    yield "hybrid model, for each number of loops", fixed / loops
    yield "and for each wind speed", per_wind / loops
    both, _ = _fitted(lines, FREQUENCIES)
    yield "frequencies of the finite element model", both - fixed
    whole, whole_per_wind = _fitted(lines[: STACK // 8], FINITE_ELEMENT)
    yield "motions of the finite element model", whole - both
    yield "and for each wind speed ", whole_per_wind - per_wind
    yield "static twist", _fitted(lines, replace(HYBRID, static_twist=StaticTwist.SOLVED))[0] - fixed
    competing = replace(HYBRID, loop_competition=LoopCompetition.CHECKED)
    yield (
        "loop competition, for each number of loops and wind speed",
        ((_fitted(lines[: STACK // 8], competing)[1] - per_wind) / loops),
    )
    checked, checked_per_wind = _fitted(lines[:4], replace(HYBRID, check=Check.DIRECT), 1)
    yield "direct integration, for each number of loops", (checked - fixed) / loops
    yield "and for each wind speed  ", (checked_per_wind - per_wind) / loops
    all_checked, all_checked_per_wind = _fitted(lines[:1], replace(FINITE_ELEMENT, check=Check.DIRECT), 1)
    yield "direct integration of the finite element model", all_checked - checked - whole
    yield "and for each wind speed   ", all_checked_per_wind - checked_per_wind - whole_per_wind


def _fitted(lines: Sequence[Line], analysis: Analysis, runs: int = 3) -> tuple[float, float]:
    """Return the time per line without wind speeds, and the additional time for each wind speed [s]."""
    seconds = []
    for count in (FEW, MANY):
        winds = tuple(np.linspace(4.0, 12.0, count).tolist())
        asked = replace(analysis, wind_speeds=winds)
        seconds.append(median_seconds(lambda asked=asked: analysed(lines, asked), runs) / len(lines))  # type: ignore[misc]
    per_wind = (seconds[1] - seconds[0]) / (MANY - FEW)
    return seconds[0] - FEW * per_wind, per_wind


if __name__ == "__main__":
    for what, seconds in costs():
        print(f"{what:60} {1e3 * seconds:9.3f} ms", flush=True)
