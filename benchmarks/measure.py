"""Timing: medians over several runs, and the LAPACK calls of a run."""

import statistics
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from engine.kernels import compiled

LAPACK = ("solve", "inv", "eig", "eigvals", "eigh", "eigvalsh", "cholesky", "svd", "det")


def median_seconds(task: Callable[[], object], runs: int = 5) -> float:
    """Return the median wall time of several runs [s]."""
    times = []
    for _ in range(runs):
        begin = time.perf_counter()
        task()
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def side_by_side(*tasks: Callable[[], object], runs: int = 7) -> list[list[float]]:
    """Run all tasks one after another in several rounds; return the wall times of each task [s].

    The machine's speed drifts from one minute to the next, so ratios should be taken within a round.
    """
    rounds = [[median_seconds(task, 1) for task in tasks] for _ in range(runs)]
    return [list(times) for times in zip(*rounds, strict=True)]


def median_ratio(times: list[float], others: list[float]) -> float:
    """Return the median over rounds of the ratio of two times."""
    return statistics.median(a / b for a, b in zip(times, others, strict=True))


@dataclass(slots=True)
class Calls:
    """Every LAPACK call of a recorded run: its function and arguments."""

    recorded: list[tuple[Callable[..., Any], tuple[Any, ...]]] = field(default_factory=list)

    def replay(self) -> None:
        """Repeat the recorded calls and nothing else."""
        for function, arguments in self.recorded:
            function(*arguments)

    def systems(self) -> int:
        """Return the number of matrices handed to LAPACK."""
        return sum(int(np.prod(np.shape(arguments[0])[:-2])) for _, arguments in self.recorded)


@contextmanager
def recorded_lapack() -> Iterator[Calls]:
    """Record the calls of numpy.linalg that reach LAPACK while the context is open."""
    calls, originals = Calls(), {name: getattr(np.linalg, name) for name in LAPACK}

    def recorder(function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any, **options: Any) -> Any:
            calls.recorded.append((function, tuple(np.array(a) for a in arguments)))
            return function(*arguments, **options)

        return call

    try:
        for name, function in originals.items():
            setattr(np.linalg, name, recorder(function))
        yield calls
    finally:
        for name, function in originals.items():
            setattr(np.linalg, name, function)


@contextmanager
def numpy_forms() -> Iterator[None]:
    """Switch the compiled kernels off while the context is open, so that every linear system goes to LAPACK."""
    before = compiled.AVAILABLE
    try:
        compiled.AVAILABLE = False
        yield
    finally:
        compiled.AVAILABLE = before
