"""How long the pages take on the embedded service: `python -m benchmarks.page_speed` prints them.

The bounds are 100 ms for the start page and 300 ms for the result of a line of 41 wind speeds, and ten seconds from the
first click on an example, in a service that was just started, to the page of its result; 50 ms for what a line becomes
while it is described. All on an idle machine.
"""

import os
import statistics
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import httpx

from app.pages import examples
from app.pages.lines.line_documents import to_texts
from app.pages.measures import SI
from app.runtime.settings import Settings
from tests import embedded, processes
from tests.app.pages.reading import BROWSER, read, send
from tests.servers import free_port

BOUNDS_MS = {"start": 100.0, "result": 300.0, "preview": 50.0, "rows": 50.0}
PREVIEW = "/pages/lines/preview"
WINDS = {"start": 2.0, "stop": 12.0, "count": 41}
DEVICES: list[dict[str, Any]] = [
    {"type": "spacer", "position_m": 10.0 + 5.0 * number, "mass_kg": 6.5, "polar_inertia_kg_m2": 0.4}
    for number in range(20)
]
PHASES = [{"name": "top", "y_m": 7.0}, {"name": "low", "y_m": -7.0}]
_REPETITIONS = 61
_BEYOND = 4  # of them are slower than the 95th percentile, or are it
_PATIENCE_SECONDS = 600.0


def main() -> None:
    """Print the first click on each example, and median, 95th percentile and largest time of each page."""
    for name in examples.NAMES:
        _print_first_click(name)
    _print_pages()


def _print_first_click(name: str) -> None:
    with (
        tempfile.TemporaryDirectory() as folder,
        embedded.serving(Settings(data_dir=Path(folder)), free_port()) as (process, client),
    ):
        client.timeout = httpx.Timeout(_PATIENCE_SECONDS)
        before, begun = _processor_seconds(process), time.perf_counter()
        path = send(client, f"/pages/examples/{name}", {}).headers["location"]
        _wait(client, path.replace("/pages/", "/v1/"))
        client.get(path, headers=BROWSER).raise_for_status()
        wall, processor = time.perf_counter() - begun, _processor_seconds(process) - before
    print(f"{name:10} first click to result {wall:5.1f} s, {processor:5.1f} s of processor, bound 10")


def _processor_seconds(process: processes.Process) -> float:
    """Return the processor time of a service, of all its processes and of those that ended."""
    ticks = 0
    for pid in processes.group(process):
        fields = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
        ticks += sum(map(int, fields[11:15]))
    return ticks / os.sysconf("SC_CLK_TCK")


def _print_pages() -> None:
    with tempfile.TemporaryDirectory() as folder:
        settings = Settings(data_dir=Path(folder))
        with embedded.serving(settings, free_port()) as (_, client):
            client.timeout = httpx.Timeout(_PATIENCE_SECONDS)
            analysis = {**examples.ANALYSIS, "wind_speeds_m_per_s": WINDS}
            location = embedded.submit(client, {"line": examples.line(examples.DRAKE), "analysis": analysis})
            _wait(client, location)
            result = location.replace("/v1/", "/pages/")
            pages = {"start": "/", "result": result, "curves": f"{result}/curves", "motion": f"{result}/motion"}
            for name, path in {**pages, "line": "/pages/lines/new", "jobs": "/pages/jobs"}.items():
                _print_times(name, _times(partial(client.get, path, headers=BROWSER)))
            line = examples.line(examples.DRAKE)
            for name, rows in {"preview": {}, "rows": {"devices": DEVICES, "phases": PHASES}}.items():
                texts = to_texts({"line": line | rows, "analysis": analysis}, SI)
                form = {**texts, "form_units": SI.name, "mark": read(client, "/").fields["mark"]}
                _print_times(name, _times(partial(client.post, PREVIEW, data=form, headers=BROWSER)))


def _print_times(name: str, times: list[float]) -> None:
    bound = f", bound {BOUNDS_MS[name]:.0f}" if name in BOUNDS_MS else ""
    print(
        f"{name:8} median {statistics.median(times):6.1f} ms, 95 % within {times[-_BEYOND]:6.1f} ms, "
        f"largest {times[-1]:6.1f} ms{bound}"
    )


def _wait(client: httpx.Client, location: str) -> None:
    until = time.monotonic() + _PATIENCE_SECONDS
    while embedded.status(client, location)["status"] != "successful":
        if time.monotonic() > until:
            raise TimeoutError(location)
        time.sleep(0.2)


def _times(ask: Callable[[], httpx.Response]) -> list[float]:
    ask().raise_for_status()  # loads what the answer needs
    times = []
    for _ in range(_REPETITIONS):
        begun = time.perf_counter()
        ask()
        times.append(1e3 * (time.perf_counter() - begun))
    return sorted(times)


if __name__ == "__main__":
    main()
