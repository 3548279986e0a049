"""Logging for all our processes: one event a line on standard error, with the ids of the request and the job.

Modules log with the standard library and pass facts as `extra`; structlog formats the lines.
"""

import logging
import sys

import structlog
from structlog.stdlib import ExtraAdder, ProcessorFormatter
from structlog.typing import EventDict, Processor, WrappedLogger

from app.runtime import correlation
from app.runtime.settings import Settings

_WORDY = ("celery", "kombu", "amqp", "alembic", "httpx", "httpcore", "matplotlib", "opentelemetry")


def configure(settings: Settings) -> None:
    """Configure the logs of this process from the settings, replacing any earlier configuration."""
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(_formatter(settings))
    logging.basicConfig(level=settings.log_level.upper(), handlers=[handler], force=True)
    logging.captureWarnings(True)
    for name in _WORDY:
        logging.getLogger(name).setLevel(max(logging.WARNING, logging.root.level))


def _formatter(settings: Settings) -> ProcessorFormatter:
    """Return a formatter that writes JSON for machines or coloured lines for people."""
    renderers: list[Processor] = [ProcessorFormatter.remove_processors_meta]
    if settings.log_format == "json":
        renderers += [structlog.processors.format_exc_info, structlog.processors.JSONRenderer(default=str)]
    else:
        renderers.append(structlog.dev.ConsoleRenderer(colors=sys.stderr.isatty()))
    facts: list[Processor] = [
        structlog.processors.TimeStamper(fmt="iso", utc=True),
        structlog.stdlib.add_log_level,
        structlog.stdlib.add_logger_name,
        ExtraAdder(),
        _add_ids,
    ]
    return ProcessorFormatter(foreign_pre_chain=facts, processors=renderers)


def _add_ids(_logger: WrappedLogger, _method: str, event: EventDict) -> EventDict:
    ids = correlation.current()
    found = {
        "request_id": ids.request_id,
        "trace_id": correlation.trace_id(),
        "job_id": ids.job_id,
        "attempt": ids.attempt,
    }
    event.update({name: value for name, value in found.items() if value is not None})
    event.pop("color_message", None)  # uvicorn repeats its message here for terminals
    return event
