"""Bounds on the head of a request, its bytes, fields and time, and on clients that take no answer.

Uvicorn with httptools bounds none of them. The application sees a head only when it is complete, so only the protocol
can stop one that is too large or too slow; and only it can end a connection without writing what nobody takes.
"""

import asyncio
import logging
from typing import Any

import orjson
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

from app.http.problems import MEDIA_TYPE, ProblemKind, problem_document

MOST_BYTES = 65_536
"""Bytes of the address and the fields of a head, and bytes that may come without any of them being a body."""
MOST_FIELDS = 200
"""Fields of a head, those that follow a body in chunks included."""

_HEAD_SECONDS = 30.0  # from the connection, or from the first byte of a further request, to the end of a head
# As with bodies: a connection that is closed on a client who still sends is reset, and the answer with it.
_LINGER_SECONDS = 2.0
_STALLED_SECONDS = 60.0  # in which a client that is owed more than the buffers of the sockets hold takes nothing

_logger = logging.getLogger(__name__)


class _HeadTooLarge(Exception):
    """Raised in the parser's callbacks, which ends the parsing."""


class _SeveralHosts(Exception):
    """Raised in the parser's callbacks, which answers 400: a proxy may have judged by another one (RFC 9112, 3.2)."""


class BoundedHeads(HttpToolsProtocol):
    """Uvicorn's protocol, which also answers 431 to a head that is too large and ends connections that are too slow.

    A connection holds at most `MOST_BYTES` and one read of its socket (256 kB) of a head.
    """

    def __init__(self, *given: Any, **named: Any) -> None:
        """Begin a connection."""
        super().__init__(*given, **named)
        self._head_bytes = 0  # bytes since the last that belonged to a body or ended a request
        self._is_refused = False
        self._deadline: asyncio.TimerHandle | None = None
        self._stall: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Wait for the first head."""
        super().connection_made(transport)
        self._await_head()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop the timers."""
        self._stop_timer()
        self._stop_stall()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Parse data, unless the head was refused: then only read on, so that the client can read the answer."""
        if self._is_refused:
            return
        self._head_bytes += len(data)
        super().data_received(data)
        if self._head_bytes > MOST_BYTES and not (self._is_refused or self.transport.is_closing()):
            self._refuse()

    def on_message_begin(self) -> None:
        """Start the timer of a head."""
        if self._deadline is None:
            self._await_head()
        super().on_message_begin()

    def on_header(self, name: bytes, value: bytes) -> None:
        """Count the fields, also those that follow a body in chunks."""
        super().on_header(name, value)
        if len(self.headers) > MOST_FIELDS:
            self._refuse()
            raise _HeadTooLarge

    def on_headers_complete(self) -> None:
        """Start the request, if its head is within the bound."""
        if len(self.url) + sum(len(name) + len(value) + len(": \r\n") for name, value in self.headers) > MOST_BYTES:
            self._refuse()
            raise _HeadTooLarge
        if [name for name, _ in self.headers].count(b"host") > 1:
            raise _SeveralHosts
        self._stop_timer()
        super().on_headers_complete()

    def on_body(self, body: bytes) -> None:
        """Pass on a part of a body, which the application bounds."""
        self._head_bytes = 0
        super().on_body(body)

    def on_message_complete(self) -> None:
        """End a request."""
        self._head_bytes = 0
        super().on_message_complete()

    def pause_writing(self) -> None:
        """Begin to watch whether the client takes anything."""
        super().pause_writing()
        self._stop_stall()
        self._watch_stall()

    def resume_writing(self) -> None:
        """Stop watching."""
        self._stop_stall()
        super().resume_writing()

    def send_400_response(self, msg: str) -> None:
        """Answer the fault at which the parser has stopped, unless that was a refusal."""
        if not self._is_refused:
            super().send_400_response(msg)

    def _await_head(self) -> None:
        self._deadline = self.loop.call_later(_HEAD_SECONDS, self._give_up)

    def _give_up(self) -> None:
        if self.flow.read_paused:  # earlier requests are running, and the rest of this one waits in the socket
            self._await_head()
        else:
            self.transport.close()

    def _stop_timer(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def _watch_stall(self) -> None:
        waiting = self.transport.get_write_buffer_size()

        def end_if_stalled() -> None:
            if self.transport.get_write_buffer_size() < waiting:
                self._watch_stall()
            else:
                _logger.info("a client takes nothing of its answer; its connection is ended")
                self.transport.abort()

        self._stall = self.loop.call_later(_STALLED_SECONDS, end_if_stalled)

    def _stop_stall(self) -> None:
        if self._stall is not None:
            self._stall.cancel()
            self._stall = None

    def _refuse(self) -> None:
        self._is_refused = True
        _logger.warning("a head of more than %d bytes or %d fields is refused", MOST_BYTES, MOST_FIELDS)
        if self.cycle is None or self.cycle.response_complete:
            self.transport.write(_refusal())
            if self.transport.can_write_eof():
                self.transport.write_eof()
            self.loop.call_later(_LINGER_SECONDS, self.transport.close)
        else:  # an answer to an earlier part of what was sent may have begun
            self.transport.close()


def _refusal() -> bytes:
    kind = ProblemKind.HEAD_TOO_LARGE
    detail = f"The address and the fields are more than {MOST_BYTES} bytes, or the fields more than {MOST_FIELDS}."
    body = orjson.dumps(problem_document(kind, detail, ""))
    head = f"HTTP/1.1 {kind.status} Request Header Fields Too Large\r\nContent-Type: {MEDIA_TYPE}\r\n"
    return f"{head}Content-Length: {len(body)}\r\nConnection: close\r\n\r\n".encode() + body
