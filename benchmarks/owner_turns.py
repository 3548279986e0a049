"""How many jobs of a busy owner begin before one of another owner: `python -m benchmarks.owner_turns`.

One owner posts many jobs at once. While workers run them, another owner posts one job after the other, each when the
one before has ended. Counted are the busy owner's jobs that begin between such a post and the beginning of its job.
`--write` writes docs/reliability.md.
"""

import contextlib
import statistics
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import datetime
from pathlib import Path
from typing import Any

import httpx

from app.runtime.settings import Settings
from app.security import keys
from app.security.caller import Scope
from app.storage.database import make_engine, session_factory
from app.storage.migration import migrate
from benchmarks.reliability_figures import report
from tests import embedded, processes
from tests.app.lines import changed
from tests.documents import short_request
from tests.servers import free_port, postgres_server, redis_server, wait_until

JOBS = 200
POSTS = 15
_PAUSE_SECONDS = 0.02
_PATIENCE_SECONDS = 600.0
_PAGE = 500


def main() -> None:
    """Print and write what another owner waits for, on an embedded service and with workers on Redis."""
    found = {}
    for name, workers in (("one process, embedded", 0), ("1 worker on Redis", 1), ("3 workers on Redis", 3)):
        with _served(workers) as (client, busy, other):
            found[name] = _waited(client, busy, other)
    report("owners' turns", found)


@contextlib.contextmanager
def _served(workers: int) -> Iterator[tuple[httpx.Client, dict[str, str], dict[str, str]]]:
    """Run a service with so many workers of one process, and give a client and the keys of two owners."""
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        settings = Settings(data_dir=folder, worker_processes=1, changes_per_minute=10**9)
        if workers:
            database, broker = stack.enter_context(postgres_server()), stack.enter_context(redis_server())
            settings = settings.model_copy(update={"database_url": Settings(database_url=database).database_url})
            settings = settings.model_copy(update={"broker_url": broker})
        migrate(settings)
        headers = [_key(settings, owner) for owner in ("busy", "other")]
        port = free_port()
        if workers:
            stack.enter_context(processes.running(settings, "-m", "app.serve", "127.0.0.1", str(port)))
            client = stack.enter_context(httpx.Client(base_url=f"http://127.0.0.1:{port}"))
            wait_until(lambda: embedded.is_ready(client), 120.0, "readiness")
            for _ in range(workers):
                stack.enter_context(processes.running_worker(settings))
        else:
            _, client = stack.enter_context(embedded.serving(settings, port))
        client.timeout = httpx.Timeout(_PATIENCE_SECONDS)
        yield client, headers[0], headers[1]


def _key(settings: Settings, owner: str) -> dict[str, str]:
    engine = make_engine(settings)
    with session_factory(engine).begin() as session:
        _, key = keys.create(session, owner, tuple(Scope), None, None)
    engine.dispose()
    return {"Authorization": f"Bearer {key}"}


def _waited(client: httpx.Client, busy: dict[str, str], other: dict[str, str]) -> str:
    """Return the jobs of the busy owner that began before each of the other one's, and the time until that ended."""
    _ended(client, busy, _posted(client, busy, 0))  # loads the engine
    with ThreadPoolExecutor(8) as pool:
        posted = list(pool.map(lambda number: _posted(client, busy, number), range(1, JOBS + 1)))
    own = [_ended(client, other, _posted(client, other, JOBS + 1 + number)) for number in range(POSTS)]
    left = _jobs(client, busy, "accepted")
    for identity in posted:
        _ended(client, busy, identity)
    began = [_moment(job["started_at"]) for job in _jobs(client, busy)]
    before = [sum(_moment(job["created_at"]) < at < _moment(job["started_at"]) for at in began) for job in own]
    seconds = [(_moment(job["finished_at"]) - _moment(job["created_at"])).total_seconds() for job in own]
    assert left, "the busy owner's jobs ended too early"
    return (
        f"median {statistics.median(before):g}, mean {statistics.mean(before):.1f}, most {max(before)} of {JOBS}; "
        f"ended after {statistics.median(seconds):.2f} s (longest {max(seconds):.2f})"
    )


def _posted(client: httpx.Client, header: dict[str, str], number: int) -> str:
    line = changed("span.horizontal_tension_n", 28_000.0 + number, short_request()["line"])
    answer = client.post("/v1/jobs", json={**short_request(), "line": line}, headers=header)
    identity: str = answer.raise_for_status().json()["id"]
    return identity


def _ended(client: httpx.Client, header: dict[str, str], identity: str) -> dict[str, Any]:
    deadline = time.monotonic() + _PATIENCE_SECONDS
    while time.monotonic() < deadline:
        found: dict[str, Any] = client.get(f"/v1/jobs/{identity}", headers=header).raise_for_status().json()
        if found["finished_at"] is not None:
            assert found["status"] == "successful", found
            return found
        time.sleep(_PAUSE_SECONDS)
    raise TimeoutError(identity)


def _jobs(client: httpx.Client, header: dict[str, str], status: str | None = None) -> list[dict[str, Any]]:
    query: dict[str, Any] = {"limit": _PAGE, **({"status": status} if status else {})}
    found: list[dict[str, Any]] = client.get("/v1/jobs", params=query, headers=header).raise_for_status().json()["jobs"]
    return found


def _moment(text: str) -> datetime:
    return datetime.fromisoformat(text)


if __name__ == "__main__":
    main()
