"""The computing time of a line, by what its analysis asks for; the service sizes the messages of a batch with it."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from app.convert import STACK
from benchmarks.engine_speed import analysed
from benchmarks.lines import random_line, under_full_physics
from benchmarks.measure import median_seconds
from engine.spec import (
    AerodynamicLoad,
    AerodynamicModel,
    Analysis,
    Check,
    Line,
    LoopCompetition,
    Model,
    StaticTwist,
)
from tests.engine.synthetic_table import with_table

ANGLE_DEG = 20.0  # at rest in the synthetic table
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
    yield from _beyond_the_source(lines)
    checked, checked_per_wind = _fitted(lines[:4], replace(HYBRID, check=Check.DIRECT), 1)
    yield "direct integration, for each number of loops", (checked - fixed) / loops
    yield "and for each wind speed  ", (checked_per_wind - per_wind) / loops
    all_checked, all_checked_per_wind = _fitted(lines[:1], replace(FINITE_ELEMENT, check=Check.DIRECT), 1)
    yield "direct integration of the finite element model", all_checked - checked - whole
    yield "and for each wind speed   ", all_checked_per_wind - checked_per_wind - whole_per_wind


def _beyond_the_source(lines: Sequence[Line]) -> Iterator[tuple[str, float]]:
    """Yield the times of hybrid and finite element model under full physics, and with the load as it stands."""
    iced, full = under_full_physics(lines, HYBRID)
    unexpanded = replace(full, aerodynamic_load=AerodynamicLoad.UNEXPANDED)
    table = replace(full, aerodynamic_model=AerodynamicModel.TABLE)
    tabulated = [with_table(line, ANGLE_DEG) for line in iced[: STACK // 16]]
    for name, some, asked in (
        ("full physics", iced, full),
        ("unexpanded load", iced[: STACK // 16], unexpanded),
        ("table", tabulated, table),
    ):
        fixed, per_wind = _fitted(some, asked, 1)
        yield f"hybrid model, {name}, for each number of loops", fixed / len(asked.loops)
        yield f"{name}: and for each wind speed", per_wind / len(asked.loops)
    for name, some, asked in (("full physics", iced[:4], full), ("table", tabulated[:1], table)):
        both = replace(asked, models=FINITE_ELEMENT.models, finite_element_loops=FINITE_ELEMENT.finite_element_loops)
        fixed, per_wind = (a - b for a, b in zip(_fitted(some, both, 1), _fitted(some, asked, 1), strict=True))
        yield f"motions of the finite element model, {name}", fixed
        yield f"{name}: and for each wind speed ", per_wind


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
