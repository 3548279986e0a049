"""Answer HEAD wherever GET is served (RFC 9110): the same answer without its body."""

import anyio
from starlette.types import ASGIApp, Message, Receive, Scope, Send

_ENDLESS = b"text/event-stream"


class HeadAsGet:
    """ASGI middleware that passes HEAD to the application as GET and sends only the head of the answer."""

    def __init__(self, app: ASGIApp) -> None:
        """Wrap an application."""
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request."""
        if scope["type"] != "http" or scope["method"] != "HEAD":
            await self.app(scope, receive, send)
            return

        async with anyio.create_task_group() as answering:
            endless = False

            async def send_head(message: Message) -> None:
                nonlocal endless
                if message["type"] == "http.response.start":
                    endless = dict(message["headers"]).get(b"content-type", b"").startswith(_ENDLESS)
                if message["type"] == "http.response.body" and endless:
                    await send({"type": "http.response.body", "body": b""})
                    answering.cancel_scope.cancel()
                else:
                    await send({**message, "body": b""} if message["type"] == "http.response.body" else message)

            as_get = {**scope, "method": "GET"}
            try:
                await self.app(as_get, receive, send_head)
            finally:
                scope["route"] = as_get.get("route")  # the request log reads it
