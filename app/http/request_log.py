"""Give every request an id, and log it with its status and duration."""

import logging
import time
from collections.abc import Callable, Mapping
from dataclasses import replace

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.runtime import correlation

REQUEST_ID = "X-Request-ID"

_READS = frozenset({"GET", "HEAD"})

Observe = Callable[[str, str, int, float], None]

_logger = logging.getLogger(__name__)


class RequestLog:
    """ASGI middleware around all others, so that even the answer to a defect carries the request id."""

    def __init__(self, app: ASGIApp, observe: Observe) -> None:
        """Wrap an application; call `observe` with method, route, status and seconds of every request."""
        self.app = app
        self.observe = observe

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        begin = time.perf_counter()
        headers = Headers(scope=scope)
        ids = correlation.of_request(headers.get(REQUEST_ID), headers.get("traceparent"))
        parent = ids.trace_parent
        status = 499  # nginx's code for a client that left before the answer

        async def send_with_id(message: Message) -> None:
            nonlocal status, parent
            if message["type"] == "http.response.start":
                parent = correlation.trace_parent()  # of the request's span, which has ended when the line is written
                status = message["status"]
                MutableHeaders(scope=message)[REQUEST_ID] = ids.request_id or ""
            await send(message)

        with correlation.bound(ids):
            try:
                await self.app(scope, receive, send_with_id)
            finally:
                seconds = time.perf_counter() - begin
                self.observe(scope["method"], route_of(scope), status, seconds)
                with correlation.bound(replace(ids, trace_parent=parent)):
                    _log(scope, status, seconds)


def _log(scope: Scope, status: int, seconds: float) -> None:
    # Polling clients cause thousands of these; the metrics count them.
    uneventful = scope["method"] in _READS and status < 400
    level = logging.DEBUG if uneventful else logging.INFO
    if not _logger.isEnabledFor(level):
        return
    facts: Mapping[str, object] = {
        "method": scope["method"],
        "path": scope["path"],
        "route": route_of(scope),
        "status": status,
        "milliseconds": round(1000.0 * seconds, 2),
        "client": scope["client"][0] if scope.get("client") else None,
    }
    _logger.log(level, "request", extra=facts)


def route_of(scope: Scope) -> str:
    """Return the path template of the route that served a request, such as /v1/jobs/{job_id}; empty without a route."""
    return getattr(scope.get("route"), "path_format", "")
