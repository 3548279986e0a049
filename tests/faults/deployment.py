"""PostgreSQL, Redis, an API and workers as processes of their own, each of which can be killed and started again."""

import contextlib
import os
import random
import signal
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Generic, TypeVar

import httpx

from app.runtime.settings import Settings
from app.storage.migration import migrate
from tests.moved_clocks import MovedClock
from tests.processes import Process, children, group, pool_children, running
from tests.servers import free_port, postgres_directory, postgres_running, redis_server, wait_until

Held = TypeVar("Held")


class Part(Generic[Held]):
    """Something that runs as long as a context lasts, and may be ended and begun anew at any time."""

    def __init__(self, run: Callable[[], AbstractContextManager[Held]]) -> None:
        self._run, self._stack = run, ExitStack()
        self.start()

    def start(self) -> None:
        self.held = self._stack.enter_context(self._run())

    def stop(self) -> None:
        self._stack.close()


@dataclass(frozen=True, slots=True)
class Deployment:
    """What runs, where the API listens, and the clocks that a test sets: of the server, the API and each worker."""

    settings: Settings
    address: str
    postgres: Part[str]
    redis: Part[str]
    api: Part[Process]
    workers: tuple[Part[Process], ...]
    clocks: list[MovedClock] = field(default_factory=list)

    def is_ready(self) -> bool:
        try:
            return httpx.get(f"{self.address}/health/ready", timeout=5.0).is_success
        except httpx.TransportError:
            return False


@contextlib.contextmanager
def deployed(directory: Path, workers: int, *, moved_clocks: bool = False) -> Iterator[Deployment]:
    """Run everything with short times, one process a worker, until the end of the context."""
    ports = {name: free_port() for name in ("postgres", "redis", "api")}
    settings = Settings(
        data_dir=directory,
        database_url=f"postgresql://galloping@127.0.0.1:{ports['postgres']}/postgres",
        broker_url=f"redis://127.0.0.1:{ports['redis']}/0",
        lease_seconds=5.0,
        heartbeat_seconds=0.5,
        sweep_seconds=0.5,
        redispatch_seconds=3.0,
        max_attempts=10,
        worker_processes=1,
    )
    with ExitStack() as stack, postgres_directory() as files:
        clocks = [MovedClock(files / f"clock-{number}") for number in range(workers + 2)] if moved_clocks else []
        server, own, *each = [clock.environment for clock in clocks] or [{}] * (workers + 2)
        # PostgreSQL crashes and recovers from its log; Redis forgets every message.
        postgres = Part(lambda: postgres_running(files, ports["postgres"], signal.SIGQUIT, server))
        stack.callback(postgres.stop)
        redis = Part(lambda: redis_server(ports["redis"], signal.SIGKILL))
        stack.callback(redis.stop)
        migrate(settings)
        api = Part(lambda: running(settings, "-m", "app.serve", "127.0.0.1", str(ports["api"]), extra=own))
        stack.callback(api.stop)
        crew = tuple(Part(partial(running, settings, "-m", "worker", extra=variables)) for variables in each)
        for worker in crew:
            stack.callback(worker.stop)
        made = Deployment(settings, f"http://127.0.0.1:{ports['api']}", postgres, redis, api, crew, clocks)
        wait_until(made.is_ready, 60.0, "readiness")
        yield made


def kill_some_worker(crew: tuple[Part[Process], ...], chance: random.Random) -> str:
    """Kill a process that runs jobs, a pool, a supervisor, or a whole worker; start anew what nobody else would."""
    worker = chance.choice(crew)
    kind = chance.choice(("process", "process", "pool", "supervisor", "worker"))
    if kind in ("process", "pool"):
        found = pool_children(worker.held) if kind == "process" else children(worker.held.pid)
        if found and _kill(chance.choice(found)):
            return kind
    elif kind == "supervisor":
        worker.held.kill()
        worker.held.wait()
        wait_until(lambda: not group(worker.held), 10.0, "the end of the orphans")
    worker.stop()
    worker.start()
    return kind if kind == "supervisor" else "worker"


def _kill(pid: int) -> bool:
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        return False
    return True
