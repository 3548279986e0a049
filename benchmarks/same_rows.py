"""Whether two states of the engine find the same motions of a random fleet.

`python -m benchmarks.same_rows write FILE [lines]` stores the rows that this state finds under either physics; `python
-m benchmarks.same_rows compare FILE OTHER` counts the rows that only one of two such files has, and prints by how much
the numbers of the others differ. Rows are the same where all that is no number is equal and the wind speeds agree.
"""

import json
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.engine_speed import STANDARD_JOB, analysed
from benchmarks.lines import random_line, under_full_physics
from engine.result import Result

LINES = 256
SEED = 20260101
TABLES = ("frequencies", "critical_wind_speeds", "limit_cycles", "tensions", "bifurcations", "amplitude_curves")
SAME_WIND = 1e-5  # relative difference of wind speeds up to which rows may be the same
FLOOR = 1e-9  # of numbers whose relative difference counts

Row = dict[str, Any]


def written(count: int) -> dict[str, list[dict[str, list[Row]]]]:
    """Return the rows of every line by table, for each physics."""
    generator = np.random.default_rng(SEED)
    lines = [random_line(generator) for _ in range(count)]
    jobs = {"source": (lines, STANDARD_JOB), "full": under_full_physics(lines, STANDARD_JOB)}
    return {name: [_tables(result) for result in analysed(*job)] for name, job in jobs.items()}


def _tables(result: Result) -> dict[str, list[Row]]:
    rows = {name: [asdict(row) for row in getattr(result, name)] for name in TABLES}
    return rows | {"warnings": [{"text": text} for text in result.warnings]}


def compared(one: Sequence[Row], other: Sequence[Row]) -> tuple[list[tuple[Row, Row]], int, int]:
    """Return the pairs of rows that are the same, and how many only the first and only the second sequence has."""
    waiting: dict[tuple[Any, ...], list[Row]] = defaultdict(list)
    for row in other:
        waiting[_labels(row)].append(row)
    pairs = []
    for row in one:
        rivals = waiting[_labels(row)]
        distances = [_distance(row, rival) for rival in rivals]
        if distances and min(distances) < np.inf:
            pairs.append((row, rivals.pop(int(np.argmin(distances)))))
    return pairs, len(one) - len(pairs), len(other) - len(pairs)


def _labels(row: Row) -> tuple[Any, ...]:
    return tuple(str(value) for value in row.values() if not isinstance(value, float))


def _distance(row: Row, other: Row) -> float:
    """Return the largest relative difference of two rows; infinite at different wind speeds."""
    gaps = _gaps(row, other)
    return np.inf if gaps.get("wind_speed_m_per_s", 0.0) > SAME_WIND else max(gaps.values(), default=0.0)


def _gaps(row: Row, other: Row) -> dict[str, float]:
    numbers = ((name, value, other[name]) for name, value in row.items() if isinstance(value, float))
    return {name: abs(a - b) / max(abs(a), abs(b), FLOOR) for name, a, b in numbers if isinstance(b, float)}


def report(one: dict[str, Any], other: dict[str, Any]) -> Iterator[str]:
    """Yield a line of text for each physics and table, and for each column that differs."""
    for physics, table in ((physics, table) for physics in one for table in (*TABLES, "warnings")):
        matched = [compared(a[table], b[table]) for a, b in zip(one[physics], other[physics], strict=True)]
        pairs = [pair for part, _, _ in matched for pair in part]
        lost, found = (sum(part[at] for part in matched) for at in (1, 2))
        yield f"{physics:8}{table:24}{len(pairs):7} rows the same, {lost} lost, {found} found"
        gaps: Counter[str] = Counter()
        for row, rival in pairs:
            gaps |= Counter(_gaps(row, rival))
        for name, gap in gaps.most_common():
            yield f"        {name:36}{gap:10.1e}"


def main(command: str, file: str, *rest: str) -> None:
    """Write rows, or compare two files of them."""
    if command == "write":
        Path(file).write_text(json.dumps(written(int(rest[0]) if rest else LINES)))
        return
    for line in report(json.loads(Path(file).read_text()), json.loads(Path(rest[0]).read_text())):
        print(line)


if __name__ == "__main__":
    main(*sys.argv[1:])
