"""Counts that do not depend on the machine: what a line costs in systems solved."""

import numpy as np

from benchmarks.engine_speed import STANDARD_JOB, analysed
from benchmarks.lines import random_line
from benchmarks.measure import numpy_forms, recorded_lapack

STEPS_A_CYCLE = 15.0  # of Newton's method for each cycle found: branches and confidence included; detuning takes four
CALLS_A_STACK = 700


def test_systems_solved_a_line() -> None:
    generator = np.random.default_rng(7)
    lines = [random_line(generator) for _ in range(8)]
    with numpy_forms(), recorded_lapack() as calls:
        results = analysed(lines, STANDARD_JOB)
    steps = sum(
        int(np.prod(arguments[0].shape[:-2]))
        for function, arguments in calls.recorded
        if function.__name__ == "solve" and arguments[0].shape[-1] in (34, 35)
    )
    cycles = sum(row.kind == "periodic" for result in results for row in result.limit_cycles)
    assert cycles >= 8 * 22
    assert steps / cycles < STEPS_A_CYCLE
    assert len(calls.recorded) < CALLS_A_STACK
