"""The fleet's job with up to 100,000 different lines: time and peak memory of one worker process at each size."""

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

CHUNK = 256  # most lines in a message; a worker holds their results at once (decision 0008)


@dataclass(frozen=True, slots=True)
class Run:
    """Number of lines analysed, processor time [s], and peak memory of the process [MB]."""

    lines: int
    seconds: float
    peak: float


def long_runs(largest: int) -> Iterator[Run]:
    """Run 100, 1,000, ... lines up to the largest number, each size in a separate process."""
    sizes = [size for size in (100, 1_000, 10_000, 100_000) if size <= largest]
    context = multiprocessing.get_context("spawn")
    for size in sizes:
        with ProcessPoolExecutor(1, mp_context=context) as pool:
            yield pool.submit(_measured, size).result()


def exponent(runs: list[Run]) -> float:
    """Fit the time as a power of the number of lines; return the exponent."""
    return float(np.polyfit(np.log([run.lines for run in runs]), np.log([run.seconds for run in runs]), 1)[0])


def _measured(size: int) -> Run:
    """Measure a number of lines, after a warm-up; draw lines chunk by chunk and drop each chunk's results."""
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
