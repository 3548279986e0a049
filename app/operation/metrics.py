"""Prometheus metrics: requests counted by the API processes, jobs read from the database.

Each process counts its requests. With several processes they count in shared files, so a killed process loses no
counts. Everything about jobs is read from SQL at each scrape. It is therefore right whichever workers run or were
killed, and workers need no port.
"""

import os
import platform
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from prometheus_client import CollectorRegistry, Histogram, ProcessCollector
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, InfoMetricFamily, Metric
from prometheus_client.exposition import choose_encoder
from prometheus_client.multiprocess import MultiProcessCollector
from sqlalchemy import case, func, select
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session, sessionmaker

from app.convert import ENGINE_VERSION
from app.jobs.webhooks import GIVEN_UP, Outcome
from app.operation.workers import listed
from app.runtime.version import SERVICE_VERSION
from app.storage import counters
from app.storage.counters import CounterName
from app.storage.database import database_time
from app.storage.steady_clock import steady_time
from app.tables import DeliveryState, Job, JobStatus, WebhookDelivery

Totals = Mapping[tuple[str, str], tuple[int, float]]

_METHODS = frozenset({"DELETE", "GET", "HEAD", "OPTIONS", "PATCH", "POST", "PUT"})
_BUCKETS = (0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0)
_KINDS = {CounterName.JOBS: "job", CounterName.CHUNKS: "chunk"}


@dataclass(frozen=True, slots=True)
class Requests:
    """Counts and times the requests of this process."""

    registry: CollectorRegistry
    seconds: Histogram

    def observe(self, method: str, route: str, status: int, seconds: float) -> None:
        """Record a finished request; `route` is a path template, so there are few different ones."""
        known = method if method in _METHODS else "other"
        self.seconds.labels(known, route, f"{status // 100}xx").observe(seconds)


def requests() -> Requests:
    """Create the request counters of one application."""
    registry = CollectorRegistry()
    seconds = Histogram(
        "galloping_http_request_seconds",
        "Time from a request to the end of its answer, by route",
        ["method", "route", "status"],
        buckets=_BUCKETS,
        registry=registry,
    )
    return Requests(registry, seconds)


def text(requests: Requests, readers: sessionmaker[Session], accept: str) -> tuple[bytes, str]:
    """Return all metrics in the format that an Accept header prefers, and its media type."""
    registry = CollectorRegistry()
    if "PROMETHEUS_MULTIPROC_DIR" in os.environ:
        MultiProcessCollector(registry)  # type: ignore[no-untyped-call]
    else:
        registry.register(requests.registry)
    registry.register(ProcessCollector(registry=None))
    registry.register(_Build())
    registry.register(_Jobs(readers))
    encode, media_type = choose_encoder(accept)
    return encode(registry), media_type


class _Build:
    """Says which version answers."""

    def collect(self) -> Iterator[Metric]:
        build = {"version": SERVICE_VERSION, "engine": ENGINE_VERSION, "python": platform.python_version()}
        yield InfoMetricFamily("galloping_build", "Versions of service, engine and Python", value=build)


@dataclass(frozen=True, slots=True)
class _Jobs:
    """Collects metrics from the database; if it is down, a metric says so and the other metrics remain."""

    readers: sessionmaker[Session]

    def collect(self) -> Iterator[Metric]:
        up = GaugeMetricFamily("galloping_database_up", "Whether the database answered this scrape")
        try:
            with self.readers() as session:
                totals = counters.totals(session)
                families = [*_open_jobs(session), *_counted(totals), *_webhooks(session, totals), *_workers(session)]
            up.add_metric([], 1.0)
        except SQLAlchemyError:
            families = []
            up.add_metric([], 0.0)
        yield up
        yield from families


def _workers(session: Session) -> Iterator[Metric]:
    now, seen = steady_time(session), [worker.seen_at for worker in listed(session)]
    yield GaugeMetricFamily("galloping_workers", "Workers that reported in the last hour and have not ended", len(seen))
    silence = GaugeMetricFamily("galloping_workers_silent_seconds", "Time since the last report of any worker")
    if seen:
        silence.add_metric([], max(0.0, (now - max(seen)).total_seconds()))
    yield silence


def _open_jobs(session: Session) -> Iterator[Metric]:
    waiting = GaugeMetricFamily("galloping_jobs_waiting", "Jobs and chunks without a worker", labels=["kind"])
    unsent = GaugeMetricFamily(
        "galloping_jobs_unsent", "Waiting jobs and chunks without a message to the workers", labels=["kind"]
    )
    running = GaugeMetricFamily("galloping_jobs_running", "Jobs and chunks under a lease", labels=["kind"])
    age = GaugeMetricFamily(
        "galloping_oldest_waiting_seconds", "Age of the oldest waiting job or chunk", labels=["kind"]
    )
    now = database_time(session)
    found = {(row.chunk, row.status): row for row in _count_open(session)}
    for chunk, kind in ((0, "job"), (1, "chunk")):
        accepted = found.get((chunk, JobStatus.ACCEPTED))
        held = found.get((chunk, JobStatus.RUNNING))
        waiting.add_metric([kind], accepted.count if accepted else 0)
        unsent.add_metric([kind], accepted.unsent if accepted else 0)
        running.add_metric([kind], held.count if held else 0)
        age.add_metric([kind], max(0.0, (now - accepted.oldest).total_seconds()) if accepted else 0.0)
    yield from (waiting, unsent, running, age)


@dataclass(frozen=True, slots=True)
class _Open:
    chunk: int
    status: JobStatus
    count: int
    unsent: int
    oldest: datetime


def _count_open(session: Session) -> Iterator[_Open]:
    chunk = case((Job.batch_id.is_(None), 0), else_=1)
    unsent = func.sum(case((Job.dispatched_at.is_(None), 1), else_=0))
    wanted = select(chunk, Job.status, func.count(), unsent, func.min(Job.created_at))
    is_open = Job.status.in_((JobStatus.ACCEPTED, JobStatus.RUNNING))
    for row in session.execute(wanted.where(is_open).group_by(chunk, Job.status)):
        yield _Open(*row)


def _counted(totals: Totals) -> Iterator[Metric]:
    labels = ["kind", "status", "failure"]
    ended = CounterMetricFamily("galloping_jobs_ended", "Jobs and chunks that have ended", labels=labels)
    work = CounterMetricFamily(
        "galloping_engine_seconds", "Seconds of work of the attempts that ended jobs and chunks", labels=["kind"]
    )
    lost = CounterMetricFamily("galloping_leases_lost", "Jobs released from lost or stopped workers", labels=["why"])
    spent: dict[str, float] = dict.fromkeys(_KINDS.values(), 0.0)
    leases: dict[str, Any] = {"expired": 0, "returned": 0}
    for (name, label), (count, seconds) in sorted(totals.items()):
        if name == CounterName.LEASES:
            leases[label] = count
        elif kind := {name.value: kind for name, kind in _KINDS.items()}.get(name):
            status, _, failure = label.partition("/")
            ended.add_metric([kind, status, failure], count)
            spent[kind] += seconds
    for kind, seconds in spent.items():
        work.add_metric([kind], seconds)
    for why, count in leases.items():
        lost.add_metric([why], count)
    yield from (ended, work, lost)


def _webhooks(session: Session, totals: Totals) -> Iterator[Metric]:
    attempts = CounterMetricFamily(
        "galloping_webhook_attempts", "Attempts to send webhook messages", labels=["outcome"]
    )
    given_up = CounterMetricFamily("galloping_webhooks_given_up", "Webhook messages given up after the last attempt")
    pending = GaugeMetricFamily("galloping_webhooks_pending", "Webhook messages in progress or waiting to be sent")
    late = GaugeMetricFamily("galloping_webhook_late_seconds", "Delay of the oldest due webhook message")
    now = steady_time(session)
    due = func.min(WebhookDelivery.next_attempt_at)
    open_ones = select(func.count(), due).where(WebhookDelivery.state == DeliveryState.PENDING.value)
    count, oldest = session.execute(open_ones).one()
    for outcome in Outcome:
        attempts.add_metric([outcome.value], totals.get((CounterName.WEBHOOKS.value, outcome.value), (0, 0.0))[0])
    given_up.add_metric([], totals.get((CounterName.WEBHOOKS.value, GIVEN_UP), (0, 0.0))[0])
    pending.add_metric([], count)
    late.add_metric([], max(0.0, (now - oldest).total_seconds()) if oldest is not None else 0.0)
    yield from (attempts, given_up, pending, late)
