"""The listening socket that the API's processes share, with the connections spread evenly over them.

All processes are told of a new connection, and the first to look takes it. Under a burst that is the same one again and
again: of fifty clients that come at once, often all fifty, while the other processes have nothing to do.
"""

import asyncio
import logging
import socket
from collections.abc import Callable
from typing import Any

import uvloop

_AT_ONCE = 4
_PAUSE_SECONDS = 0.002  # long enough for an idle process to wake up, too short for a client to notice
_EXHAUSTED_SECONDS = 1.0

Factory = Callable[[], asyncio.Protocol]

_logger = logging.getLogger(__name__)


class SharingLoop(uvloop.Loop):
    """The event loop of a server, which takes a few connections at a time from a socket that it is given."""

    async def create_server(self, protocol_factory: Any, *given: Any, sock: Any = None, **named: Any) -> Any:
        """Serve on a socket that others share, else as any loop does."""
        if sock is None:
            return await super().create_server(protocol_factory, *given, **named)
        sock.setblocking(False)
        sock.listen(named["backlog"])
        return Listener(self, sock, protocol_factory)


class Listener:
    """Takes a few connections, then leaves the next ones to the other processes for a moment.

    A process that is busy looks later than one that is not, and so gets fewer.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop, listening: socket.socket, factory: Factory) -> None:
        """Begin to listen."""
        self._loop, self._socket, self._factory = loop, listening, factory
        self._connecting: set[asyncio.Task[Any]] = set()
        self._pause: asyncio.TimerHandle | None = None
        self._listen()

    def close(self) -> None:
        """Take no more connections."""
        if self._pause is not None:
            self._pause.cancel()
        self._loop.remove_reader(self._socket)

    async def wait_closed(self) -> None:
        """Wait until the connections that were taken have their protocol."""
        await asyncio.gather(*self._connecting, return_exceptions=True)

    def _listen(self) -> None:
        self._pause = None
        self._loop.add_reader(self._socket, self._take)

    def _take(self) -> None:
        taken = 0
        try:
            for taken in range(_AT_ONCE):  # noqa: B007 - the number of those that were there
                self._begin(self._socket.accept()[0])
            self._rest(_PAUSE_SECONDS)
        except (BlockingIOError, InterruptedError, ConnectionAbortedError):
            if taken:
                self._rest(_PAUSE_SECONDS)
        except OSError as error:  # no file descriptors are left: who waits is taken when some are
            _logger.error("no connection can be taken for a while: %s", error)
            self._rest(_EXHAUSTED_SECONDS)

    def _begin(self, connection: socket.socket) -> None:
        task = self._loop.create_task(self._connect(connection))
        self._connecting.add(task)
        task.add_done_callback(self._connecting.discard)

    async def _connect(self, connection: socket.socket) -> None:
        connection.setblocking(False)
        await self._loop.connect_accepted_socket(self._factory, connection)

    def _rest(self, seconds: float) -> None:
        self._loop.remove_reader(self._socket)
        self._pause = self._loop.call_later(seconds, self._listen)
