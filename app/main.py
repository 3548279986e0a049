"""Assemble the web application: routes, middleware, problem handlers and the state that requests share."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from functools import partial
from typing import Any

from fastapi import FastAPI
from sqlalchemy import Engine
from starlette.types import ASGIApp

from app.batches.intake import Places
from app.coalescing.grouped_calls import GroupedCalls, committed_together
from app.coalescing.shared_watch import SharedWatch
from app.http import beside_loop, cors, problems
from app.http.compression import Compression
from app.http.forwarded import believing
from app.http.head_as_get import HeadAsGet
from app.http.prefix import UnderPrefix
from app.http.request_log import RequestLog
from app.http.security_headers import SecurityHeaders
from app.interactive import Previews, Workshop
from app.jobs import submissions
from app.jobs.dispatch import Sender, celery_application
from app.jobs.job_records import look_up
from app.jobs.owner_quotas import OverQuota, Quotas
from app.jobs.watched_states import batches_seen, jobs_seen
from app.ogc import routes as ogc
from app.openapi import about, finished
from app.operation import metrics
from app.operation.write_probe import WriteProbe
from app.pages import assets, frame, views
from app.routes import (
    aerodynamics,
    batch_changes,
    batch_intake,
    batch_ranking,
    batch_results,
    batches,
    clearance,
    deliveries,
    documentation,
    events,
    explorer,
    health,
    job_changes,
    jobs,
    lines,
    own_aerodynamics,
    own_conductors,
    own_quotas,
    pictures,
    previews,
    reference,
    remedies,
    results,
)
from app.runtime import telemetry
from app.runtime.settings import Settings, get_settings
from app.runtime.signing import make_signing_key
from app.security.gate import Gate, known_callers
from app.security.quotas import Meter
from app.security.strangers import Strangers
from app.storage.database import make_engine, session_factory

_INBOX_PAUSE_SECONDS = 0.006  # about as long as one group of posts takes
_MESSAGES_PAUSE_SECONDS = 0.05  # nobody waits for a message to leave; each group costs a transaction
_REPORTS_OF_OWNER, _REPORTS = 4, 16  # under way at once; each takes a second or two


class Service(FastAPI):
    """The FastAPI application. Its OpenAPI document is finished by `app.openapi`."""

    def openapi(self) -> dict[str, Any]:
        """Return the OpenAPI document, built once."""
        if not self.openapi_schema:
            self.openapi_schema = finished(super().openapi())
        return self.openapi_schema

    def build_middleware_stack(self) -> ASGIApp:
        """Wrap the application in the middleware that must also handle answers to internal errors."""
        stack = RequestLog(SecurityHeaders(super().build_middleware_stack()), self.state.requests.observe)
        settings: Settings = self.state.settings
        placed = UnderPrefix(stack, settings.root_path) if settings.root_path else stack
        return believing(placed, settings.trusted_proxies) if settings.trusted_proxies else placed


def create_app(settings: Settings | None = None) -> Service:
    """Build the application; without settings, read them from the environment of the process.

    Raises
    ------
    OSError
        If the directory of an SQLite database or the signing secret cannot be made.
    """
    settings = settings or get_settings()
    database = make_engine(settings)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        yield
        await _close(app)
        database.dispose()

    app = Service(
        **about(settings),
        lifespan=lifespan,
        docs_url=None,
        redoc_url=None,
        telemetry={
            "tracing": settings.opentelemetry,
            "metrics": False,
            "logs": False,
            "operation_spans": False,
            "exclude": telemetry.is_untraced,
        },
        redirect_slashes=False,
        generate_unique_id_function=lambda route: route.name,
        responses={"default": documentation.ANY_PROBLEM},
    )
    _equip(app, settings, database)
    _guard(app, settings)
    of_batches = dict.fromkeys((*batch_intake.ADDRESSES, views.BATCH_FILES), settings.max_batch_bytes)
    limits = {"": settings.max_body_bytes, **of_batches}
    slowest = settings.silent_body_seconds, settings.least_body_bytes_per_second
    problems.install(app, limits, slowest, frame.shown_problem)
    app.add_exception_handler(OverQuota, own_quotas.answer)
    app.add_middleware(Compression)
    app.add_middleware(HeadAsGet)
    if settings.cors_origins:
        cors.install(app, settings.cors_origins)
    _add_addresses(app)
    return app


def _guard(app: Service, settings: Settings) -> None:
    """Let requests in by key or token only, where there are keys, and count those of callers and of strangers."""
    app.state.meter = meter = Meter(settings)
    app.state.strangers = strangers = Strangers(settings, app.state.readers, meter)
    app.state.callers = callers = known_callers(app.state.readers, app.state.writers, settings.key_cache_seconds)
    app.add_middleware(Gate, settings, app.state.readers, callers, meter, strangers)


async def _close(app: Service) -> None:
    """End what the application holds: calls in the order of their work, watches, processes and connections."""
    state = app.state
    for calls in (state.inbox, state.messages, state.statuses):
        await calls.close()
    await state.meter.close()
    for watch in (state.job_watch, state.batch_watch):
        await watch.close()
    for workshop in (state.studio, state.printers):
        workshop.close()
    state.sender.close()
    state.prober.dispose()
    telemetry.finish()


def _add_addresses(app: Service) -> None:
    """Add the routes of the API, the pages, and the files that both need."""
    for module in (jobs, job_changes, remedies, lines, previews, results, pictures):
        app.include_router(module.router)
    for module in (batch_intake, batches, batch_changes, batch_results):
        app.include_router(module.router)
    for module in (batch_ranking, clearance, events, deliveries, aerodynamics, own_aerodynamics, own_conductors):
        app.include_router(module.router)
    for module in (reference, own_quotas, health, explorer):
        app.include_router(module.router)
    app.include_router(ogc.router)
    for router in views.routers():
        app.include_router(router)
    for address, files in {explorer.ASSETS: explorer.assets(), **assets.folders()}.items():
        app.mount(address, files)


def _equip(app: Service, settings: Settings, database: Engine) -> None:
    """Attach what routes share: database sessions, grouped calls, the message sender and the watches behind streams."""
    make_signing_key(settings)
    beside_loop.install(app)
    app.state.settings = settings
    app.state.requests = metrics.requests()
    app.state.readers = session_factory(database, read_only=True)
    app.state.writers = session_factory(database)
    app.state.prober = prober = make_engine(settings, impatient=True)
    app.state.probe = WriteProbe(prober)
    app.state.studio = Workshop(settings.drawing_processes)
    app.state.printers = Workshop(1, most_of_owner=_REPORTS_OF_OWNER, most=_REPORTS)
    app.state.previews = Previews(settings.preview_seconds)
    app.state.sender = Sender(celery_application(settings), app.state.writers)
    app.state.places = Places(settings.batches_at_once, settings.senders_at_once)
    app.state.quotas = allowed = Quotas.of(settings)
    accept = partial(submissions.accept, allowed=allowed)
    app.state.inbox = GroupedCalls(
        "inbox", partial(committed_together, app.state.writers, accept), _INBOX_PAUSE_SECONDS
    )
    app.state.messages = GroupedCalls(
        "messages", lambda job_ids: [app.state.sender.send(job_ids)] * len(job_ids), _MESSAGES_PAUSE_SECONDS
    )
    app.state.statuses = GroupedCalls("statuses", partial(look_up, app.state.readers))
    app.state.job_watch = SharedWatch("job-watch", partial(jobs_seen, app.state.readers), settings.watch_seconds)
    app.state.batch_watch = SharedWatch("batch-watch", partial(batches_seen, app.state.readers), settings.watch_seconds)
