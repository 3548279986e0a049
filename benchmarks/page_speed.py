"""How long the pages take on the embedded service: `python -m benchmarks.page_speed` prints medians in milliseconds.

The bounds are 100 ms for the start page and 300 ms for the result of a line of 41 wind speeds, on an idle machine.
"""

import statistics
import tempfile
import time
from pathlib import Path

import httpx

from app.pages import examples
from app.runtime.settings import Settings
from tests import embedded
from tests.servers import free_port

BOUNDS_MS = {"start": 100.0, "result": 300.0}
WINDS = {"start": 2.0, "stop": 12.0, "count": 41}
_REPETITIONS = 21
_PATIENCE_SECONDS = 600.0
_BROWSER = {"Accept": "text/html"}


def main() -> None:
    """Print the median and the largest time of each page."""
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
                median, largest = _times(client, path)
                bound = f", bound {BOUNDS_MS[name]:.0f}" if name in BOUNDS_MS else ""
                print(f"{name:8} median {median:6.1f} ms, largest {largest:6.1f} ms{bound}")


def _wait(client: httpx.Client, location: str) -> None:
    until = time.monotonic() + _PATIENCE_SECONDS
    while embedded.status(client, location)["status"] != "successful":
        if time.monotonic() > until:
            raise TimeoutError(location)
        time.sleep(0.2)


def _times(client: httpx.Client, path: str) -> tuple[float, float]:
    client.get(path, headers=_BROWSER).raise_for_status()
    times = []
    for _ in range(_REPETITIONS):
        begun = time.perf_counter()
        client.get(path, headers=_BROWSER)
        times.append(1e3 * (time.perf_counter() - begun))
    return statistics.median(times), max(times)


if __name__ == "__main__":
    main()
