"""Compress answers as `Accept-Encoding` allows, with an entity tag of its own for each encoding (RFC 9110, 8.8.3)."""

import re

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette_compress import CompressMiddleware, add_compress_type, remove_compress_type

_SMALLEST_BYTES = 1000
_CODED = re.compile(r'-(?:gzip|zstd)"')

for _media_type in ("application/problem+json", "application/x-ndjson", "text/csv"):
    add_compress_type(_media_type)
# Pages hold the marks of forms beside what an address says, so that the length of a compressed one could betray a mark.
# Events are short, and some proxies hold back a compressed stream.
for _media_type in ("text/html", "text/event-stream"):
    remove_compress_type(_media_type)


class Compression:
    """ASGI middleware that compresses texts by zstd or gzip; what is compressed already passes unchanged."""

    def __init__(self, app: ASGIApp) -> None:
        """Wrap an application, which sees entity tags without an encoding."""
        self.app = CompressMiddleware(app, minimum_size=_SMALLEST_BYTES, brotli=False)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        known = Headers(scope=scope).get("if-none-match", "")
        if _CODED.search(known):
            bare = [(name, value) for name, value in scope["headers"] if name != b"if-none-match"]
            scope = {**scope, "headers": [*bare, (b"if-none-match", _CODED.sub('"', known).encode("latin-1"))]}

        async def send_tagged(message: Message) -> None:
            if message["type"] == "http.response.start":
                _tag(MutableHeaders(scope=message), known)
            await send(message)

        await self.app(scope, receive, send_tagged)


def _tag(headers: MutableHeaders, known: str) -> None:
    """Add to the tag of an answer its encoding, or that under which the client knows an answer without a body."""
    tag = headers.get("etag")
    if tag is None:
        return
    coded = {coding: f'{tag[:-1]}-{coding}"' for coding in ("zstd", "gzip")}
    own = coded.get(headers.get("content-encoding", ""))
    if own is None and tag not in known:
        own = next((text for text in coded.values() if text in known), None)
    if own is not None:
        headers["etag"] = own
