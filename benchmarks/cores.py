"""The speed of this machine with one and two processes, and the time that the command line takes to start."""

import json
import multiprocessing
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

from app.reference.source_lines import example
from benchmarks.engine_speed import STANDARD_JOB, analysed
from benchmarks.lines import random_line
from benchmarks.measure import median_seconds

ADDITIONS = 10_000_000
LINES = 512
RUNS = 5


def plain_python() -> Iterator[tuple[str, float]]:
    """Yield the time of ten million additions in Python, a measure of the machine's speed during the run."""
    yield "machine_loop_seconds", median_seconds(lambda: sum(range(ADDITIONS)), RUNS)


def two_processes() -> Iterator[tuple[str, float]]:
    """Yield the rate of the engine in two processes over that in one, the upper limit for the service's scaling."""
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(2, mp_context=context) as pool:
        list(pool.map(_rate, [64, 64]))
        ratios = []
        for _ in range(RUNS):
            alone = pool.submit(_rate, LINES).result()
            ratios.append(sum(pool.map(_rate, [LINES, LINES])) / alone)
    yield "machine_two_core_speedup", statistics.median(ratios)


def _rate(count: int) -> float:
    """Return the engine's rate in lines per second."""
    generator = np.random.default_rng(20260101)
    lines = [random_line(generator) for _ in range(count)]
    begin = time.perf_counter()
    analysed(lines, STANDARD_JOB)
    return count / (time.perf_counter() - begin)


def command_line() -> Iterator[tuple[str, float]]:
    """Yield the time of the whole process `galloping analyse`, and the time until it has read and checked its line."""
    with tempfile.TemporaryDirectory() as directory:
        whole = Path(directory) / "line.json"
        whole.write_text(json.dumps({"line": example("c11-twin"), "analysis": {"wind_speeds_m_per_s": [6.0]}}))
        refused = Path(directory) / "refused.json"
        refused.write_text(json.dumps({"line": {**example("c11-twin"), "colour": "red"}}))
        yield "analyse_seconds", median_seconds(lambda: _analyse(whole, 0), 2 * RUNS)
        yield "analyse_start_seconds", median_seconds(lambda: _analyse(refused, 2), 2 * RUNS)


def _analyse(request: Path, code: int) -> None:
    command = [sys.executable, "-m", "app.cli", "analyse", str(request)]
    ended = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    assert ended.returncode == code
