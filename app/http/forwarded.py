"""What a proxy says of the connection to its client: from trusted proxies the client's address and scheme."""

from collections.abc import Sequence

from starlette.datastructures import URL
from starlette.types import ASGIApp, Scope
from uvicorn.middleware.proxy_headers import ProxyHeadersMiddleware


def believing(app: ASGIApp, proxies: Sequence[str]) -> ASGIApp:
    """Wrap an application so that it sees as its client whom these proxies name in `X-Forwarded-For`.

    The last address that is none of the proxies counts: what stands before it the client may have sent.
    """
    wrapped: ASGIApp = ProxyHeadersMiddleware(app, list(proxies))  # type: ignore[arg-type, assignment]
    return wrapped


def is_encrypted(scope: Scope) -> bool:
    """Tell whether the client's connection is encrypted, by the word of any proxy.

    For headers that only tell a browser to be careful, so that a client who lies harms nobody.
    """
    return scope["scheme"] == "https" or (b"x-forwarded-proto", b"https") in scope["headers"]


def own_address(scope: Scope) -> str:
    """Return the address of this service as the client of a request has reached it, without a slash at its end.

    It is made from what the client says, and is for answers to this client only.
    """
    place = URL(scope={**scope, "path": str(scope.get("root_path", "")).rstrip("/"), "query_string": b""})
    return str(place.replace(scheme="https") if is_encrypted(scope) else place)
