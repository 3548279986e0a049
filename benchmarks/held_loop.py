"""How long one request holds the event loop: `python -m benchmarks.held_loop`, `--write` for docs/reliability.md.

The application runs in this process. Beside each request a clock ticks every 5 ms on the same loop; a gap is what any
other request would have waited. The processor's time in the longest gap does not depend on what else the machine does.
"""

import asyncio
import gc
import itertools
import json
import statistics
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

import httpx

from app.main import create_app
from app.runtime.settings import Settings
from app.storage.migration import migrate
from benchmarks.reliability_figures import report
from tests.app.pages.reading import BROWSER, Page
from tests.documents import short_request

TICK_SECONDS = 0.005
RUNS = 3
_JSON = {"Content-Type": "application/json"}
_FORM = {"Content-Type": "application/x-www-form-urlencoded", **BROWSER}


@dataclass(frozen=True, slots=True)
class Post:
    """A request: its address, its body and its header fields."""

    path: str
    body: bytes
    headers: Mapping[str, str]


def main() -> None:
    """Print and write the longest gaps."""
    report("held loop", asyncio.run(_figures()))


async def _figures() -> dict[str, str]:
    with tempfile.TemporaryDirectory() as folder:
        settings = Settings(data_dir=Path(folder))
        await asyncio.to_thread(migrate, settings)
        app = create_app(settings)
        gc.collect()
        gc.freeze()  # as `app.serve` does
        transport = httpx.ASGITransport(app, client=("127.0.0.1", 1))
        async with (
            app.router.lifespan_context(app),
            httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1", timeout=600.0) as client,
        ):
            mark = Page(await client.get("/pages/lines/new", headers=BROWSER)).fields["mark"]
            return {name: await _longest(client, make) for name, make in _posts(mark).items()}


async def _longest(client: httpx.AsyncClient, make: Callable[[int], Post]) -> str:
    """Return the longest gaps of some runs, the first of which loads what is loaded once."""
    found = [await _gap(client, make(number)) for number in range(RUNS + 1)][1:]
    gaps, processor = zip(*found, strict=True)
    return (
        f"{statistics.median(gaps):.3f} s (largest {max(gaps):.3f}), {statistics.median(processor):.3f} s of processor"
    )


async def _gap(client: httpx.AsyncClient, post: Post) -> tuple[float, float]:
    """Return the longest gap between two ticks during a request [s], and the most processor time in one [s]."""
    ended, ticks = asyncio.Event(), []

    async def tick() -> None:
        while not ended.is_set():
            ticks.append((time.perf_counter(), time.process_time()))
            await asyncio.sleep(TICK_SECONDS)

    clock = asyncio.create_task(tick())
    answer = await client.post(post.path, content=post.body, headers=post.headers)
    assert answer.status_code < 500, answer.text
    await asyncio.sleep(10.0 * TICK_SECONDS)
    ended.set()
    await clock
    steps = [(b[0] - a[0] - TICK_SECONDS, b[1] - a[1]) for a, b in itertools.pairwise(ticks)]
    return max(gap for gap, _ in steps), max(busy for _, busy in steps)


def _posts(mark: str) -> dict[str, Callable[[int], Post]]:
    """Return the requests; each run has another document, which no stored result answers."""
    return {
        "a line of 1 kB": lambda number: _json("/v1/jobs", _request(20, number)),
        "a job with a table of 9,900 rows": lambda number: _json("/v1/jobs", _request(9_900, number)),
        "an estimate of a study of 10,000 points": lambda _: _json("/v1/jobs/estimate", _study()),
        "a fit of 9,900 rows": lambda number: _json("/v1/aerodynamics/fit", _table(9_900, number)),
        "a JSON batch of 2 MB, checked only": lambda _: _json("/v1/batches/estimate", _batch()),
        "a form of 18 MB of escapes": lambda _: Post(
            "/pages/lines/new", f"mark={mark}&x={'%41' * 6_000_000}".encode(), _FORM
        ),
        "a form of 9,000 rows": lambda _: Post("/pages/lines/new", urlencode(_rows(mark)).encode(), _FORM),
    }


def _json(path: str, document: Any) -> Post:
    return Post(path, json.dumps(document).encode(), _JSON)


def _form(body: str) -> Post:
    return Post("/pages/lines/new", body.encode(), _FORM)


def _table(rows: int, number: int) -> dict[str, Any]:
    step = 180.0 / rows
    row = {"lift": 0.3 + 1e-6 * number, "drag": 1.2, "moment": -0.1}
    measured = [{"angle_deg": step * place - 90.0, **row} for place in range(rows)]
    return {"table": measured, "static_angle_deg": 0.0, "half_range_deg": 80.0}


def _request(rows: int, number: int) -> dict[str, Any]:
    document = short_request()
    ice = {name: value for name, value in document["line"]["ice"].items() if name != "aerodynamics_at_rest"}
    return {**document, "line": {**document["line"], "ice": {**ice, "aerodynamics": _table(rows, number)}}}


def _study() -> dict[str, Any]:
    axis = {"parameter": "span.horizontal_tension_n", "values": [20_000 + number for number in range(10_000)]}
    return {**short_request(), "study": {"axes": [axis]}}


def _batch() -> dict[str, Any]:
    document = short_request()
    count = 2_000_000 // len(json.dumps(document["line"]) + ", ")
    return {"lines": [document["line"]] * count, "analysis": document["analysis"]}


def _rows(mark: str) -> dict[str, str]:
    return {"mark": mark, **{f"line.devices.{number}.type": "spacer" for number in range(9_000)}}


if __name__ == "__main__":
    main()
