"""Stream answers from the database while they are sent."""

import itertools
from collections.abc import Callable, Generator, Iterator, Mapping

from anyio import to_thread
from fastapi.responses import StreamingResponse
from sqlalchemy.orm import Session, sessionmaker
from starlette.concurrency import iterate_in_threadpool
from starlette.types import Receive, Scope, Send


class _ClosedStream(StreamingResponse):
    """A streaming response that begins with its first piece, and closes its generator even if the client leaves.

    So whatever is wrong with the first piece is answered as a problem; later on the answer can only break off.
    """

    def __init__(self, pieces: Generator[str | bytes, None, None], media_type: str, headers: Mapping[str, str]) -> None:
        """Take the generator of the pieces."""
        super().__init__(pieces, media_type=media_type, headers=headers)
        self._pieces = pieces

    def _first(self) -> list[str | bytes]:
        return list(itertools.islice(self._pieces, 1))

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send the pieces, then close the generator."""
        try:
            first = await to_thread.run_sync(self._first)
            self.body_iterator = iterate_in_threadpool(itertools.chain(first, self._pieces))
            await super().__call__(scope, receive, send)
        finally:
            self._pieces.close()


def streamed(
    readers: sessionmaker[Session],
    pieces: Callable[[Session], Iterator[str] | Iterator[bytes]],
    media_type: str,
    headers: Mapping[str, str],
) -> StreamingResponse:
    """Stream pieces that a database session reads while they are sent; close the session afterwards.

    The pieces must come from rows that are read in pages (`app.storage.pages`): a client may take them as slowly as it
    likes.
    """

    def stream() -> Generator[str | bytes, None, None]:
        with readers() as session:
            yield from pieces(session)

    return _ClosedStream(stream(), media_type, headers)
