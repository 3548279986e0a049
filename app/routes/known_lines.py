"""Routes whose documents may have a line as an engineer knows it."""

from collections.abc import Callable
from typing import Any

from fastapi import Request

from app import convert
from app.convert.known.wrapping import without_wrapper
from app.http.strict_routes import StrictJsonRoute
from app.owned import records
from app.schemas.faults import BadInput


class KnownLineRoute(StrictJsonRoute):
    """A route that resolves such a line, with what the caller's owner keeps, before the schema reads the document."""

    def preparation(self, request: Request, document: Any) -> Callable[[], Any] | None:
        """Return the function that makes the line explicit, if it is not.

        Raises
        ------
        BadInput
            If the document is a line without its wrapper; the function raises it if its line cannot be resolved.
        """
        bare = without_wrapper(document, '{"line": <the line>, "analysis": {...}}, where analysis may be absent')
        if bare is not None:
            raise BadInput([bare])
        if not convert.is_known_request(document):
            return None

        def resolved() -> Any:
            with request.app.state.readers() as session:
                own = records.own_rows(session, request.state.caller.owner)
            return convert.explicit_request(document, own)

        return resolved
