"""Cost of lines in engineers' forms: a batch of them against the same lines spelled out, and one line resolved."""

import statistics
import tempfile
import time
from collections.abc import Iterator, Sequence
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
from starlette.testclient import TestClient

from app import convert
from app.main import create_app
from app.runtime.settings import Settings
from app.storage.migration import migrate
from benchmarks.samples import TWIN_DRAKE

LINES = 1000
CONDUCTORS = ("Drake", "242-AL1/39-ST1A")
RESOLVED_ALONE = 50


def known_fleet() -> Iterator[tuple[str, float]]:
    """Yield processor time: forms over explicit lines, intake and engine, block by block in turn; one line [ms]."""
    analysis = convert.read_analysis({"models": ["hybrid"]})
    lines = list(forms(LINES))
    blocks = [lines[first : first + convert.STACK] for first in range(0, LINES, convert.STACK)]
    _seconds(blocks[0][:8], analysis)
    known, spelled = 0.0, 0.0
    for number, block in enumerate(blocks):
        explicit = [convert.resolve_document(line)["line"] for line in block]
        first, second = (block, explicit) if number % 2 else (explicit, block)
        times = _seconds(first, analysis), _seconds(second, analysis)
        known += times[0] if first is block else times[1]
        spelled += times[1] if first is block else times[0]
    yield "known_fleet_ratio", known / spelled
    yield "known_fleet_lines_per_s_core", LINES / known
    line = next(forms(1))
    yield "resolve_ms", 1e3 * statistics.median([_alone(line) for _ in range(RESOLVED_ALONE)])
    yield "resolve_route_p99_ms", 1e3 * _route(line)


def forms(count: int) -> Iterator[dict[str, Any]]:
    """Yield lines of different lengths, conductors and ice: all forms, nothing that can be estimated."""
    generator = np.random.default_rng(1)
    for number in range(count):
        line = deepcopy(TWIN_DRAKE)
        line["conductor"]["catalogue"] = CONDUCTORS[number % len(CONDUCTORS)]
        line["span"]["length_m"] = round(float(generator.uniform(150.0, 400.0)), 1)
        del line["span"]["ruling_span_m"]
        line["ice"]["accretion"] = {
            "shape": ("crescent", "uniform", "d_shape")[number % 3],
            "thickness_m": round(float(generator.uniform(0.005, 0.02)), 4),
        }
        line["supports"] = {"left": {"insulator_length_m": 2.4}, "right": {"adjacent_span_m": 280.0}}
        yield line


def _seconds(lines: Sequence[dict[str, Any]], analysis: Any) -> float:
    """Return the processor time to take lines in as a batch does, and to analyse them [s]."""
    begin = time.process_time()
    numbered = []
    for number, line in enumerate(lines, 1):
        explicit, known = convert.explicit_line(line)
        document = convert.read_line(explicit, analysis).model_dump(mode="json", by_alias=True)
        numbered.append(convert.NumberedLine(number, document, known))
    points = list(convert.run_stack(analysis.model_dump(mode="json", by_alias=True), numbered))
    assert len([point for point in points if isinstance(point, convert.PointResult)]) == len(lines)
    return time.process_time() - begin


def _alone(line: dict[str, Any]) -> float:
    begin = time.process_time()
    convert.resolve_document(line)
    return time.process_time() - begin


def _route(line: dict[str, Any]) -> float:
    """Return the 99th percentile of the time of the route with a database, without a network [s]."""
    times = []
    with tempfile.TemporaryDirectory() as directory:
        settings = Settings(data_dir=Path(directory))
        migrate(settings)
        with TestClient(create_app(settings), "http://127.0.0.1:8000", client=("127.0.0.1", 1)) as client:
            for _ in range(4 * RESOLVED_ALONE):
                begin = time.perf_counter()
                client.post("/v1/lines/resolve", json=line).raise_for_status()
                times.append(time.perf_counter() - begin)
    return float(np.quantile(times[RESOLVED_ALONE // 5 :], 0.99))
