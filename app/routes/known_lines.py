"""Routes whose documents may have a line as an engineer knows it."""

from typing import Any

from anyio import to_thread
from fastapi import Request

from app import convert
from app.convert.known.wrapping import without_wrapper
from app.http.strict_routes import StrictJsonRoute
from app.owned import records
from app.schemas.faults import BadInput


class KnownLineRoute(StrictJsonRoute):
    """A route that resolves such a line, with what the caller's owner keeps, before the schema reads the document."""

    async def prepared(self, request: Request, document: Any) -> Any:
        """Return the document with an explicit line.

        Raises
        ------
        BadInput
            If the document is a line without its wrapper, or its line cannot be resolved.
        """
        bare = without_wrapper(document, '{"line": <the line>, "analysis": {...}}, where analysis may be absent')
        if bare is not None:
            raise BadInput([bare])
        if not convert.is_known_request(document):
            return document

        def resolved() -> Any:
            with request.app.state.readers() as session:
                own = records.own_rows(session, request.state.caller.owner)
            return convert.explicit_request(document, own)

        return await to_thread.run_sync(resolved)
