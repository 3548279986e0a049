"""Kinds of routes that take what they know and refuse everything else."""

from collections import Counter
from collections.abc import Callable, Collection, Coroutine, Iterator
from typing import Any, get_args, get_origin

import orjson
from fastapi import Request, Response
from fastapi.dependencies.models import Dependant
from fastapi.routing import APIRoute
from pydantic import BaseModel

from app.http.beside_loop import QUICK_BYTES, beside_loop, mark_large
from app.http.problems import ProblemError, ProblemKind, invalid_document, validation_problem
from app.schemas.faults import BadInput, Fault, json_pointer, parse_json

_READING = frozenset({"GET", "HEAD"})


class KnownParametersRoute(APIRoute):
    """A route that refuses unknown and repeated query parameters, since a slip in them would do or show something else.

    Pages are read with whatever a link adds to their address. Only parameters that take a list may be repeated.
    """

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        """Return the handler that looks at the names of the parameters first."""
        handler = super().get_route_handler()
        kinds, strict = dict(_parameters(self.dependant)), self.include_in_schema
        single = frozenset(name for name, kind in kinds.items() if not _is_list(kind))

        async def knowing(request: Request) -> Response:
            if request.scope["query_string"]:
                if strict or request.method not in _READING:
                    _refuse_unknown(request, kinds.keys())
                _refuse_repeated(request, single)
            return await handler(request)

        return knowing


def _parameters(dependant: Dependant) -> Iterator[tuple[str, Any]]:
    """Yield the names and types of the query parameters that a route and what it depends on take."""
    for field in dependant.query_params:
        kind = field.field_info.annotation
        if isinstance(kind, type) and issubclass(kind, BaseModel):
            yield from ((inner.alias or name, inner.annotation) for name, inner in kind.model_fields.items())
        else:
            yield field.alias, kind
    for inner in dependant.dependencies:
        yield from _parameters(inner)


def _is_list(kind: Any) -> bool:
    return get_origin(kind) is list or any(_is_list(inner) for inner in get_args(kind))


def _refuse_repeated(request: Request, single: Collection[str]) -> None:
    counts = Counter(name for name, _ in request.query_params.multi_items() if name in single)
    detail = "must be given once; this parameter takes one value"
    faults = [Fault(json_pointer(["query", name]), "repeated", detail) for name, count in counts.items() if count > 1]
    if faults:
        raise ProblemError(ProblemKind.INVALID_PARAMETER, "See errors.", faults=faults)


def _refuse_unknown(request: Request, known: Collection[str]) -> None:
    unknown = [name for name in request.query_params if name not in known]
    if unknown:
        named = f"known are {', '.join(sorted(known))}" if known else "there are none here"
        detail = f"unknown parameter; {named}"
        faults = [Fault(json_pointer(["query", name]), "unknown_field", detail) for name in unknown]
        raise ProblemError(ProblemKind.INVALID_PARAMETER, "See errors.", faults=faults)


class StrictJsonRoute(KnownParametersRoute):
    """A route that accepts strict JSON only: answer 415 to another media type and 422 to any error in the text."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        """Return the handler that parses the body strictly."""
        handler = super().get_route_handler()
        takes_body = self.body_field is not None

        async def strict(request: Request) -> Response:
            if takes_body:
                _require_json(request)
            return await handler(_StrictRequest(request, self))

        return strict

    def checked(self, document: Any) -> Any:
        """Return a document as the schema reads it, or raise the problem of one that it refuses."""
        assert self.body_field is not None, "only routes with a body check one"
        found, errors = self.body_field.validate(document, {}, loc=("body",))
        if errors:
            raise validation_problem(errors, document)
        return found

    def preparation(self, request: Request, document: Any) -> Callable[[], Any] | None:
        """Return the function that makes of a posted document the one for the schema; None where that is the same.

        The function is called in a thread.

        Raises
        ------
        BadInput
            If the document cannot be prepared; the function may raise it, too.
        """
        del request, document
        return None


class _StrictRequest(Request):
    def __init__(self, request: Request, route: StrictJsonRoute) -> None:
        super().__init__(request.scope, request.receive)
        self._route = route

    async def json(self) -> Any:
        """Return the document for the schema; a large one as the schema has read it, which then leaves it as it is."""
        body = await self.body()
        try:
            if len(body) > QUICK_BYTES:
                mark_large(self)
                return await beside_loop(self, lambda: self._read(body))
            document = parse_json(body)
            prepare = self._route.preparation(self, document)
            return document if prepare is None else await beside_loop(self, lambda: self._checked(prepare()))
        except BadInput as error:
            raise invalid_document(error.faults) from error

    def _read(self, body: bytes) -> Any:
        document = parse_json(body)
        prepare = self._route.preparation(self, document)
        return self._checked(document if prepare is None else prepare())

    def _checked(self, document: Any) -> Any:
        if len(orjson.dumps(document, option=orjson.OPT_PASSTHROUGH_SUBCLASS)) > QUICK_BYTES:
            mark_large(self)
        return self._route.checked(document)


def _require_json(request: Request) -> None:
    media_type = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if media_type != "application/json":
        detail = f"The body is {media_type[:100]!r}, not application/json."
        raise ProblemError(ProblemKind.UNSUPPORTED_MEDIA_TYPE, detail, headers={"Accept-Post": "application/json"})
    encoding = request.headers.get("content-encoding", "identity").strip().lower()
    if encoding != "identity":
        detail = f"The content encoding {encoding[:100]!r} is accepted for batches only."
        raise ProblemError(ProblemKind.UNSUPPORTED_MEDIA_TYPE, detail, headers={"Accept-Encoding": "identity"})
