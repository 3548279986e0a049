"""The fleet's job up to 100,000 distinct lines: time and peak memory of one worker's process, size by size."""

import multiprocessing
import resource
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from itertools import islice

import numpy as np

from benchmarks.engine_speed import STANDARD_JOB, analysed
from benchmarks.lines import random_line
from engine.spec import Line

CHUNK = 256  # lines a message at most, whose results a worker holds at once (decision 0008)


@dataclass(frozen=True, slots=True)
class Run:
    """Lines analysed, the seconds of processor time that it took, and the process's largest memory [MB]."""

    lines: int
    seconds: float
    peak: float


def long_runs(largest: int) -> Iterator[Run]:
    """Run 100, 1,000, ... lines up to the largest number, each in a process of its own."""
    sizes = [size for size in (100, 1_000, 10_000, 100_000) if size <= largest]
    context = multiprocessing.get_context("spawn")
    for size in sizes:
        with ProcessPoolExecutor(1, mp_context=context) as pool:
            yield pool.submit(_measured, size).result()


def exponent(runs: list[Run]) -> float:
    """Fit the exponent of the time over the number of lines."""
    return float(np.polyfit(np.log([run.lines for run in runs]), np.log([run.seconds for run in runs]), 1)[0])


def _measured(size: int) -> Run:
    """Draw lines as they are needed and drop the results of a chunk when it is done."""
    analysed(list(islice(_lines(0), CHUNK)), STANDARD_JOB)
    seconds, remaining, source = 0.0, size, _lines(size)
    while remaining:
        chunk = list(islice(source, min(CHUNK, remaining)))
        remaining -= len(chunk)
        begin = time.process_time()
        analysed(chunk, STANDARD_JOB)
        seconds += time.process_time() - begin
    return Run(size, seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0)


def _lines(seed: int) -> Iterator[Line]:
    generator = np.random.default_rng(seed)
    while True:
        yield random_line(generator)
