"""The load of many workers on PostgreSQL and Redis: a simulation with measured costs, written to docs/capacity.md.

A discrete-event simulation of a closed queueing network. Each worker takes a message from the broker (one thread),
claims its chunk, computes it and writes its results. Statements run on the processors of the database; bytes go through
its one log. Meanwhile every worker renews leases and sweeps. The batch never runs out, as under full load.
"""

import heapq
import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from app.runtime.settings import Settings

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "capacity.md"
FIGURES = ROOT / "benchmarks" / "latest.json"
WANTED = ("line_", "post_", "read_", "claim_", "heartbeat_", "sweep_")
WORKERS = (1, 10, 100, 1000)
SEED = 20260101
CHUNKS_A_WORKER = 40
SPREAD = 0.15  # of a chunk's computing time, relative to its mean
GOOD = 0.9  # share of the workers' rate above which the workers count as the limit
LOG_BYTES_PER_S = 200e6  # of a fast disk, with group commit


@dataclass(slots=True)
class Station:
    """A number of servers with one first-come, first-served queue; `busy` is their total working time [s]."""

    servers: int
    busy: float = 0.0
    free: list[float] = field(default_factory=list)

    def serve(self, at: float, seconds: float) -> float:
        """Serve a request that arrives at a time and takes this long [s]; return when it is done [s]."""
        if not self.free:
            self.free = [0.0] * self.servers
        begin = max(at, heapq.heappop(self.free))
        heapq.heappush(self.free, begin + seconds)
        self.busy += seconds
        return begin + seconds


@dataclass(frozen=True, slots=True)
class Outcome:
    """Lines per second, their share of the workers' own rate, and the utilization of each station."""

    lines_per_s: float
    efficiency: float
    database: float
    log: float
    broker: float


def simulate(figures: dict[str, float], workers: int, processors: int, seed: int = SEED) -> Outcome:
    """Simulate workers and a database with a number of processors; `figures` are those of benchmarks/latest.json."""
    generator = np.random.default_rng(seed)
    lines = 1.0 / figures["line_messages"]
    database, log, broker = Station(processors), Station(1), Station(1)
    computing = 1e-3 * figures["line_worker_ms"] * lines
    writing = 1e-3 * (figures["line_database_ms"] * lines + _upkeep_ms(figures, computing))
    events = [(float(moment), "fetch") for moment in generator.uniform(0.0, computing, workers)]
    heapq.heapify(events)
    done, last, wanted = 0, 0.0, CHUNKS_A_WORKER * workers
    while done < wanted:
        at, step = heapq.heappop(events)
        if step == "fetch":
            arrived = broker.serve(at, 1e-3 * figures["line_broker_ms"] * lines)
            claimed = database.serve(arrived, 1e-3 * figures["claim_database_ms"])
            end = claimed + computing * float(generator.lognormal(-0.5 * SPREAD**2, SPREAD))
            heapq.heappush(events, (end, "store"))
        else:
            written = database.serve(at, writing)
            last = log.serve(written, figures["line_log_bytes"] * lines / LOG_BYTES_PER_S)
            done += 1
            heapq.heappush(events, (last, "fetch"))
    rate = done * lines / last
    return Outcome(
        lines_per_s=rate,
        efficiency=rate * figures["line_worker_ms"] * 1e-3 / workers,
        database=database.busy / (last * processors),
        log=log.busy / last,
        broker=broker.busy / last,
    )


def limit(found: Outcome) -> str:
    """Name the bottleneck: the workers, or the busiest station if they wait for one."""
    if found.efficiency >= GOOD:
        return "workers"
    return max(("database", "log", "broker"), key=lambda station: float(getattr(found, station)))


def _upkeep_ms(figures: dict[str, float], computing: float) -> float:
    """Return the database's processor time for leases and sweeps while a worker computes a chunk [ms]."""
    settings = Settings()
    beats = figures["heartbeat_database_ms"] / settings.heartbeat_seconds
    return computing * (beats + figures["sweep_database_ms"] / settings.sweep_seconds)


def tables(figures: dict[str, float]) -> Iterator[tuple[str, list[str]]]:
    """Yield the mark and the lines of each table on the page."""
    rows = [f"| `{name}` | {value:.4g} |" for name, value in sorted(figures.items())]
    yield "figures", ["| figure | value |", "|---|---|", *rows]
    names = (
        "workers",
        "database processors",
        "lines a second",
        "of the workers' rate",
        "database",
        "log",
        "broker",
        "limit",
    )
    rows = []
    for workers in WORKERS:
        for processors in (4, 16, 64):
            found = simulate(figures, workers, processors)
            shares = (f"{share:.0%}" for share in (found.efficiency, found.database, found.log, found.broker))
            rows.append(
                f"| {workers} | {processors} | {found.lines_per_s:,.0f} | {' | '.join(shares)} | {limit(found)} |"
            )
    yield "simulation", [f"| {' | '.join(names)} |", "|---" * len(names) + "|", *rows]
    yield "bytes", list(_bytes(figures))


def _bytes(figures: dict[str, float]) -> Iterator[str]:
    yield "| lines | rows | in the database | in its log | messages |"
    yield "|---|---|---|---|---|"
    for lines in (10_000, 100_000, 1_000_000, 10_000_000):
        sizes = (figures["line_bytes"] * lines / 1e9, figures["line_log_bytes"] * lines / 1e9)
        rows, messages = figures["line_rows"] * lines, figures["line_messages"] * lines
        yield f"| {lines:,} | {rows:,.0f} | {sizes[0]:.2f} GB | {sizes[1]:.2f} GB | {messages:,.0f} |"


def main() -> None:
    """Rewrite the tables of docs/capacity.md from the latest figures of `make bench`."""
    text, found = PAGE.read_text(), json.loads(FIGURES.read_text())
    for mark, lines in tables({name: value for name, value in found.items() if name.startswith(WANTED)}):
        before, rest = text.split(f"<!-- {mark} -->", 1)
        _, after = rest.split("<!-- end -->", 1)
        text = before + "\n".join([f"<!-- {mark} -->", *lines, "<!-- end -->"]) + after
    PAGE.write_text(text)


if __name__ == "__main__":
    main()
