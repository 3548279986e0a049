"""Routes whose documents may have a line as an engineer knows it."""

from typing import Any

from anyio import to_thread
from fastapi import Request

from app import convert
from app.http.strict_routes import StrictJsonRoute
from app.owned import records


class KnownLineRoute(StrictJsonRoute):
    """A route that resolves such a line, with what the caller's owner keeps, before the schema reads the document."""

    async def prepared(self, request: Request, document: Any) -> Any:
        """Return the document with an explicit line."""
        if not convert.is_known_request(document):
            return document

        def resolved() -> Any:
            with request.app.state.readers() as session:
                own = records.own_rows(session, request.state.caller.owner)
            return convert.explicit_request(document, own)

        return await to_thread.run_sync(resolved)
