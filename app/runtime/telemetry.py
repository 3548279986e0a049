"""Optional OpenTelemetry traces: a span for each request, and under it a span for its job."""

import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from opentelemetry import propagate, trace

from app.runtime.correlation import Ids
from app.runtime.settings import Settings
from app.runtime.version import SERVICE_VERSION

_FLUSH_SECONDS = 2.0


def configure(settings: Settings, process: str) -> None:
    """Send this process's spans to the collector at `OTEL_EXPORTER_OTLP_ENDPOINT` if tracing is on.

    Raises
    ------
    ImportError
        If tracing is on and the extra `galloping[opentelemetry]` is not installed.
    """
    if not settings.opentelemetry:
        return
    # Optional, and slow to load.
    from opentelemetry.exporter.otlp.proto.http.trace_exporter import OTLPSpanExporter  # noqa: PLC0415
    from opentelemetry.sdk.resources import OTELResourceDetector, Resource  # noqa: PLC0415
    from opentelemetry.sdk.trace import TracerProvider  # noqa: PLC0415
    from opentelemetry.sdk.trace.export import BatchSpanProcessor  # noqa: PLC0415

    # OTEL_SERVICE_NAME and OTEL_RESOURCE_ATTRIBUTES come first, which they would not against attributes of a resource.
    ours = {"service.name": f"galloping-{process}", "service.version": SERVICE_VERSION, "galloping.process": process}
    named = OTELResourceDetector().detect()
    provider = TracerProvider(resource=Resource.create(ours).merge(named))
    provider.add_span_processor(BatchSpanProcessor(OTLPSpanExporter(), schedule_delay_millis=1000))
    trace.set_tracer_provider(provider)


def is_untraced(scope: Mapping[str, Any]) -> bool:
    """Tell whether a request makes no span: the probes and scrapes of monitoring, which come every few seconds."""
    path: str = scope.get("path", "").removeprefix(scope.get("root_path", ""))
    return path == "/metrics" or path.startswith("/health/")


def finish(**_: object) -> None:
    """Send the remaining spans before the process ends, waiting only briefly for an absent collector."""
    flush = getattr(trace.get_tracer_provider(), "force_flush", None)
    if flush is not None:  # the library does not keep to its own timeout
        thread = threading.Thread(target=flush, name="last-spans", daemon=True)
        thread.start()
        thread.join(_FLUSH_SECONDS)


@contextmanager
def job_span(ids: Ids) -> Iterator[None]:
    """Open a span for a job under the span of the request that created it; without a tracer, do nothing."""
    parent = propagate.extract({"traceparent": ids.trace_parent} if ids.trace_parent else {})
    known: dict[str, str | int] = {"job.id": ids.job_id or "", "job.attempt": ids.attempt or 0}
    with trace.get_tracer("galloping").start_as_current_span("job", parent, attributes=known):
        yield
