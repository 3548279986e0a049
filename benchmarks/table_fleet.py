"""The rate of lines whose load is a measured table over the whole angle: two numbers of loops, 11 winds, hybrid."""

import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from benchmarks.engine_speed import STANDARD_JOB, analysed
from benchmarks.lines import random_line, under_full_physics
from engine.spec import AerodynamicModel, Analysis, Line, Model
from tests.engine.synthetic_table import with_table
from worker.memory import settle

STACK = 64  # lines side by side
PARTS = 3  # stacks over which the rate is a median
AT_REST_DEG, GALLOPING_DEG = 20.0, 0.0  # angles of the synthetic table: a third of the lines gallop, and all of them


def table_fleet(stack: int = STACK, parts: int = PARTS) -> Iterator[tuple[str, float]]:
    """Yield lines per second of processor time, of a usual fleet and of one that gallops in both numbers of loops."""
    yield "fleet_table_lines_per_s_core", _rate(AT_REST_DEG, stack, parts)
    yield "fleet_table_galloping_lines_per_s_core", _rate(GALLOPING_DEG, stack, parts)


def table_stack(generator: np.random.Generator, count: int, angle_deg: float) -> tuple[list[Line], Analysis]:
    """Return random lines with the synthetic table, at rest at an angle, and their analysis."""
    lines = [random_line(generator) for _ in range(count)]
    iced, full = under_full_physics(lines, replace(STANDARD_JOB, models=(Model.HYBRID,)))
    table = replace(full, aerodynamic_model=AerodynamicModel.TABLE)
    return [with_table(line, angle_deg) for line in iced], table


def _rate(angle_deg: float, stack: int, parts: int) -> float:
    generator = np.random.default_rng(20260101)
    settle()
    seconds = [_seconds(*table_stack(generator, stack, angle_deg)) for _ in range(parts)]
    return stack / float(np.median(seconds))


def _seconds(lines: Sequence[Line], analysis: Analysis) -> float:
    begin = time.process_time()
    analysed(lines, analysis)
    return time.process_time() - begin


if __name__ == "__main__":
    for name, value in table_fleet(*(int(size) for size in sys.argv[1:3])):  # lines of a stack, and stacks
        print(f"{name:40} {value:8.2f}", flush=True)
