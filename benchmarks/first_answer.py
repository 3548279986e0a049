"""How long a person waits: from the POST of a line to its result on the embedded service (`galloping serve`)."""

import statistics
import tempfile
import time
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path
from typing import Any

import httpx

from app.reference.source_lines import example
from app.routes.own_documentation import KNOWN_LINE
from app.runtime.settings import Settings
from tests.embedded import serving
from tests.servers import free_port

POSTS = 60
PREVIEWED = {"loops": [1, 2], "models": ["hybrid"], "wind_speeds_m_per_s": {"start": 2.0, "stop": 12.0, "count": 11}}
PAUSE_SECONDS = 0.37  # a person posts now and then: the service is idle before each post


def first_answer() -> Iterator[tuple[str, float]]:
    """Yield the times of the first POST after the start, and median and 95th percentile of those after it."""
    with tempfile.TemporaryDirectory() as folder:
        settings = Settings(_env_file=None, data_dir=Path(folder))  # type: ignore[call-arg]
        with serving(settings, free_port()) as (_, client):
            first, _ = _seconds_to_result(client, 0)
            previews = [_seconds_of_preview(client, number) for number in range(POSTS + 1)]
            runs = [_seconds_to_result(client, number) for number in range(1, POSTS + 1)]
    waits = sorted(seconds for seconds, _ in runs)
    yield "first_answer_seconds", first
    yield "first_preview_seconds", previews[0]
    yield "preview_median_seconds", statistics.median(previews[1:])
    yield "preview_95_seconds", sorted(previews[1:])[int(0.95 * POSTS)]
    yield "answer_median_seconds", statistics.median(waits)
    yield "answer_95_seconds", waits[int(0.95 * len(waits))]
    for name in runs[0][1]:
        yield f"answer_{name}_seconds", statistics.median(parts[name] for _, parts in runs)


def _seconds_to_result(client: httpx.Client, number: int) -> tuple[float, dict[str, float]]:
    """Post a line that nobody has computed, wait for it and read its results."""
    document = _document(number)
    time.sleep(PAUSE_SECONDS)
    begin = time.perf_counter()
    posted = client.post("/v1/jobs", json=document).raise_for_status()
    accepted = time.perf_counter()
    location = posted.headers["Location"]
    status = client.get(location, headers={"Prefer": "wait=30"}).raise_for_status().json()
    seen = time.perf_counter()
    client.get(f"{location}/results").raise_for_status()
    end = time.perf_counter()
    moments = ("created_at", "started_at", "finished_at")
    created, started, finished = (datetime.fromisoformat(status[name]) for name in moments)
    parts = {
        "post": accepted - begin,
        "queue": (started - created).total_seconds(),
        "compute": (finished - started).total_seconds(),
        "notice": seen - accepted - (finished - created).total_seconds(),
        "read": end - seen,
    }
    return end - begin, parts


def _seconds_of_preview(client: httpx.Client, number: int) -> float:
    """Move a slider: a twin line as an engineer knows it, its ice a little thicker each time."""
    ice = {**KNOWN_LINE["ice"], "accretion": {**KNOWN_LINE["ice"]["accretion"], "thickness_m": 0.012 + 1e-5 * number}}
    begin = time.perf_counter()
    client.post("/v1/previews", json={"line": {**KNOWN_LINE, "ice": ice}, "analysis": PREVIEWED}).raise_for_status()
    return time.perf_counter() - begin


def _document(number: int) -> dict[str, Any]:
    line = example("c11-twin")
    line["span"]["length_m"] += 0.01 * number
    return {"line": line, "analysis": {"models": ["hybrid"]}}
