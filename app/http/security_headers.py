"""Security headers that every answer carries, for clients that are browsers."""

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.http.forwarded import is_encrypted

_PICTURES_AND_PROBLEMS = (
    b"default-src 'none'; style-src 'unsafe-inline'; img-src data:; "
    b"base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_SWAGGER = (
    b"default-src 'none'; connect-src 'self'; img-src 'self' data: blob:; "
    b"script-src 'unsafe-inline' 'self'; style-src 'unsafe-inline' 'self'; "
    b"base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_ALWAYS = (
    (b"cache-control", b"no-store"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"referrer-policy", b"no-referrer"),
    (b"x-content-type-options", b"nosniff"),
    (b"x-frame-options", b"DENY"),
)
_ENCRYPTED = (b"strict-transport-security", b"max-age=31536000")


class SecurityHeaders:
    """ASGI middleware that adds the headers which an answer does not set itself."""

    def __init__(self, app: ASGIApp) -> None:
        """Wrap an application."""
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        policy = (b"content-security-policy", _SWAGGER if scope["path"].endswith("/docs") else _PICTURES_AND_PROBLEMS)
        wanted = (*_ALWAYS, policy, _ENCRYPTED) if is_encrypted(scope) else (*_ALWAYS, policy)

        async def send_safe(message: Message) -> None:
            if message["type"] == "http.response.start":
                present = {name.lower() for name, _ in message["headers"]}
                message["headers"] = [*message["headers"], *(item for item in wanted if item[0] not in present)]
            await send(message)

        await self.app(scope, receive, send_safe)
