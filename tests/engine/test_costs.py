"""Counts that do not depend on the machine: what a line costs in systems solved."""

import numpy as np

from benchmarks.engine_speed import STANDARD_JOB, analysed
from benchmarks.lines import random_line
from benchmarks.measure import numpy_forms, recorded_lapack

BALANCES_A_CYCLE = 7.5  # Newton steps a cycle found, those of starts that lead to a known one included
CALLS_A_STACK = 170


def test_systems_solved_a_line() -> None:
    generator = np.random.default_rng(7)
    lines = [random_line(generator) for _ in range(8)]
    with numpy_forms(), recorded_lapack() as calls:
        results = analysed(lines, STANDARD_JOB)
    balances = sum(
        int(np.prod(arguments[0].shape[:-2]))
        for function, arguments in calls.recorded
        if function.__name__ == "solve" and arguments[0].shape[-1] == 34
    )
    cycles = sum(row.kind == "periodic" for result in results for row in result.limit_cycles)
    assert cycles >= 8 * 22
    assert balances / cycles < BALANCES_A_CYCLE
    assert len(calls.recorded) < CALLS_A_STACK
