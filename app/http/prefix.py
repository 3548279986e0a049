"""Behind a proxy that serves this service under a prefix such as `/gal`: requests with it, and answers that name it."""

from typing import Any

from fastapi.responses import JSONResponse
from starlette.types import ASGIApp, Receive, Scope, Send

from app.http.forwarded import own_address


class UnderPrefix:
    """ASGI middleware that finds the prefix on every path, whether or not the proxy has removed it."""

    def __init__(self, app: ASGIApp, prefix: str) -> None:
        """Wrap an application; the prefix begins with a slash and does not end with one."""
        self.app = app
        self._prefix = prefix

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request."""
        if scope["type"] == "http":
            path, raw = scope["path"], scope.get("raw_path") or b""
            if path != self._prefix and not path.startswith(f"{self._prefix}/"):
                path, raw = self._prefix + path, self._prefix.encode() + raw
            scope = {**scope, "root_path": self._prefix, "path": path, "raw_path": raw}
        await self.app(scope, receive, send)


def prefix_of(scope: Scope) -> str:
    """Return the prefix under which a request came, empty without one."""
    return str(scope.get("root_path", "")).rstrip("/")


def path_of(scope: Scope) -> str:
    """Return the path of a request without the prefix."""
    return str(scope["path"]).removeprefix(prefix_of(scope))


class LinkedJSON(JSONResponse):
    """JSON whose `links`, `next` and `Location` gain the prefix when it is sent; until then they have none.

    So what is stored under an idempotency key is the same under every prefix.
    """

    def __init__(self, content: Any, *given: Any, **named: Any) -> None:
        """Take what a JSON response takes."""
        super().__init__(content, *given, **named)
        self._content = content

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send the answer under the prefix of its request."""
        place = self._place(scope)
        if place:
            self.body = self.render(linked(self._content, place))
            self.headers["content-length"] = str(len(self.body))
            if "location" in self.headers:
                self.headers["location"] = place + self.headers["location"]
        await super().__call__(scope, receive, send)

    def _place(self, scope: Scope) -> str:
        """Return what comes before the addresses."""
        return prefix_of(scope)


class AddressedJSON(LinkedJSON):
    """JSON whose `links`, `next` and `Location` become whole addresses when it is sent.

    For clients that use an address as they find it, and do not resolve it against that of the request.
    """

    def _place(self, scope: Scope) -> str:
        return own_address(scope)


def linked(document: Any, prefix: str) -> Any:
    """Return a document whose own addresses begin with the prefix."""
    if not isinstance(document, dict):
        return document
    own = {name: prefix + document[name] for name in ("next", "type") if str(document.get(name)).startswith("/")}
    return {**_with_links(document, prefix), **own}


def _with_links(node: Any, prefix: str) -> Any:
    if isinstance(node, list):
        return [_with_links(item, prefix) for item in node]
    if not isinstance(node, dict):
        return node
    inner = {name: _with_links(value, prefix) if isinstance(value, list) else value for name, value in node.items()}
    if isinstance(node.get("links"), list):
        inner["links"] = [{**link, "href": prefix + link["href"]} for link in node["links"]]
    return inner
