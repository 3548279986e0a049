"""Lines a second of processor time of the fleet's job under either physics, beside the speed of the machine.

To compare two states of the source, run `python -m benchmarks.fleet_rate` in turn in both. Processor time hardly
depends on what else the machine does; the loop, measured before each run, tells how fast its processor was.
"""

import time
from collections.abc import Callable, Iterator

import numpy as np

from benchmarks.engine_speed import STACK, STANDARD_JOB, analysed
from benchmarks.lines import random_line, under_full_physics
from worker.memory import settle

SEED = 20260101


def fleet_rates() -> Iterator[tuple[str, float, float]]:
    """Yield the physics, its lines a second of processor time, and the time of the machine's loop [s]."""
    generator = np.random.default_rng(SEED)
    lines = [random_line(generator) for _ in range(STACK)]
    for physics, job in (("full", under_full_physics(lines, STANDARD_JOB)), ("source", (lines, STANDARD_JOB))):
        analysed(*job)
        settle()
        loop = _seconds(lambda: sum(range(10_000_000)))
        yield physics, STACK / _seconds(lambda job=job: analysed(*job)), loop  # type: ignore[misc]


def _seconds(task: Callable[[], object]) -> float:
    begin = time.process_time()
    task()
    return time.process_time() - begin


if __name__ == "__main__":
    for name, rate, loop in fleet_rates():
        print(f"{name:8}{rate:8.1f} lines/s at a loop of {loop:.4f} s: {rate * loop / 0.1:.1f} at 0.1 s", flush=True)
