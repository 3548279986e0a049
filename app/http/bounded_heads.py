"""HTTP as the server speaks it, with bounds on the head of a request: the server itself takes any and waits for ever.

Nothing of the application sees a head before it is whole, so only the connection can end one that is too large or slow.
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

_logger = logging.getLogger(__name__)


class _HeadTooLarge(Exception):
    """Raised in the parser, which stops at it."""


class BoundedHeads(HttpToolsProtocol):
    """The server's protocol on one connection, which answers 431 to a head that is too large, and ends.

    At a head that is too slow it ends without an answer. No more than `MOST_BYTES` and one reading of the socket
    (256 kB) are held of any.
    """

    def __init__(self, *given: Any, **named: Any) -> None:
        """Begin a connection."""
        super().__init__(*given, **named)
        self._unsettled = 0  # bytes since the last that belonged to a body or ended a request
        self._bytes = 0
        self._fields = 0
        self._is_refused = False
        self._deadline: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Wait for the first head."""
        super().connection_made(transport)
        self._await_head()

    def connection_lost(self, exc: Exception | None) -> None:
        """End."""
        self._end_wait()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Take what has come, unless the connection only waits for its client to have read why it ends."""
        if self._is_refused:
            return
        self._unsettled += len(data)
        super().data_received(data)
        if self._unsettled > MOST_BYTES and not (self._is_refused or self.transport.is_closing()):
            self._refuse()

    def on_message_begin(self) -> None:
        """Begin to count."""
        self._bytes = self._fields = 0
        if self._deadline is None:
            self._await_head()
        super().on_message_begin()

    def on_headers_complete(self) -> None:
        """Hand the head over."""
        self._end_wait()
        super().on_headers_complete()

    def on_url(self, url: bytes) -> None:
        """Take a part of the address."""
        self._count(len(url), fields=0)
        super().on_url(url)

    def on_header(self, name: bytes, value: bytes) -> None:
        """Take a field."""
        self._count(len(name) + len(value) + len(": \r\n"), fields=1)
        super().on_header(name, value)

    def on_body(self, body: bytes) -> None:
        """Take a part of a body, for which the application has a bound of its own."""
        self._unsettled = 0
        super().on_body(body)

    def on_message_complete(self) -> None:
        """End a request."""
        self._unsettled = 0
        super().on_message_complete()

    def send_400_response(self, msg: str) -> None:
        """Answer to what the parser has stopped at."""
        if self._is_too_large():
            self._refuse()
        else:
            super().send_400_response(msg)

    def _count(self, count: int, fields: int) -> None:
        self._bytes += count
        self._fields += fields
        if self._is_too_large():
            raise _HeadTooLarge

    def _await_head(self) -> None:
        self._deadline = self.loop.call_later(_HEAD_SECONDS, self._give_up)

    def _give_up(self) -> None:
        if self.flow.read_paused:  # earlier requests are at work, and what is missing waits in the socket
            self._await_head()
        else:
            self.transport.close()

    def _end_wait(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def _is_too_large(self) -> bool:
        return self._bytes > MOST_BYTES or self._fields > MOST_FIELDS

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
