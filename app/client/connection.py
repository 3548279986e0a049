"""A connection to the service that retries requests and converts errors to `ServiceError`."""

import os
import random
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import IO, Any, TypeVar
from uuid import uuid4

import httpx
from pydantic import BaseModel, ValidationError

from app.schemas.faults import Fault

Show = Callable[[float, str], object]
Body = Callable[[], bytes | IO[bytes]]
Model = TypeVar("Model", bound=BaseModel)

_STRAINED = frozenset({429, 502, 503, 504})
_IN_FLIGHT = 409  # answer to a POST while another request with its key is in progress
_FIRST_PAUSE_SECONDS = 0.1
_LONGEST_PAUSE_SECONDS = 5.0


class ServiceError(Exception):
    """Raised when the service cannot be reached or gives an unexpected answer."""


class Refused(ServiceError):
    """Raised when the service refuses a document; `faults` lists its faults."""

    def __init__(self, faults: list[Fault]) -> None:
        """Take the faults that the service found."""
        self.faults = faults
        super().__init__("; ".join(str(fault) for fault in faults))


class NotFound(ServiceError):
    """Raised when the service has no such job, batch or address for this caller."""


class Unreachable(ServiceError):
    """Raised when no answer arrived; a retry may get one."""


class Connection:
    """A connection that retries; `GALLOPING_URL` and `GALLOPING_KEY` replace absent arguments."""

    def __init__(self, url: str | None, key: str | None, patience_seconds: float) -> None:
        """Open a connection.

        Raises
        ------
        ServiceError
            If the address is not valid.
        """
        self.url = url or os.environ.get("GALLOPING_URL", "http://127.0.0.1:8000")
        held = key or os.environ.get("GALLOPING_KEY")
        headers = {"Authorization": f"Bearer {held}"} if held else {}
        self._patience_seconds = patience_seconds
        with self._converting_errors():
            self._http = httpx.Client(base_url=self.url, timeout=30.0, headers=headers)
        self._prefix = self._http.base_url.path.rstrip("/")

    def close(self) -> None:
        """Close the connection."""
        self._http.close()

    def get(self, address: str) -> httpx.Response:
        """Return the answer to a GET.

        Raises
        ------
        ServiceError
            If there is no answer, or it is a problem.
        """
        return self._send("GET", address)

    def delete(self, address: str) -> httpx.Response:
        """Send a DELETE and return the answer.

        Raises
        ------
        ServiceError
            If there is no answer, or it is a problem.
        """
        return self._send("DELETE", address)

    def post(
        self, address: str, body: Body = bytes, headers: Mapping[str, str] | None = None, key: str | None = None
    ) -> httpx.Response:
        """Post a body under one idempotency key and return the answer; `body` creates the body for each attempt.

        Raises
        ------
        Refused
            If the body has faults.
        ServiceError
            If there is no answer, or it is another problem.
        """
        return self._send("POST", address, body, {**(headers or {}), "Idempotency-Key": key or str(uuid4())})

    def read(self, model: type[Model], answer: httpx.Response) -> Model:
        """Return the document in an answer; keep unknown fields of a newer service.

        Raises
        ------
        ServiceError
            If the answer is not such a document.
        """
        try:
            return model.model_validate_json(answer.content, extra="allow")
        except ValidationError as error:
            raise ServiceError(f"the server at {self.url} is not a galloping service") from error

    def lines(self, address: str) -> Iterator[str]:
        """Yield the lines of an answer as they arrive.

        Raises
        ------
        ServiceError
            If there is no answer, it is a problem, or it ends early.
        """
        with self._converting_errors(), self._http.stream("GET", self._below(address)) as answer:
            if answer.is_error:
                answer.read()
            yield from _checked(answer).iter_lines()

    def _send(
        self,
        method: str,
        address: str,
        body: Body | None = None,
        headers: Mapping[str, str] | None = None,
    ) -> httpx.Response:
        """Send a request until the answer is final or the patience ends."""
        deadline, pause = time.monotonic() + self._patience_seconds, _FIRST_PAUSE_SECONDS
        while True:
            may_retry = time.monotonic() + pause < deadline
            try:
                with self._converting_errors():
                    answer = self._http.request(
                        method, self._below(address), content=body() if body else None, headers=headers
                    )
            except Unreachable:
                if not may_retry:
                    raise
            else:
                busy = answer.status_code in _STRAINED or (method == "POST" and answer.status_code == _IN_FLIGHT)
                if not (busy and may_retry):
                    return _checked(answer)
                pause = max(pause, _retry_seconds(answer))
            time.sleep(min(pause, max(0.0, deadline - time.monotonic())))
            # Random, so that many clients do not retry at the same time.
            pause = min(2.0 * pause, _LONGEST_PAUSE_SECONDS) * random.uniform(0.8, 1.0)

    def _below(self, address: str) -> str:
        """Return an address below that of the service, whose links have the prefix of its proxy."""
        return address.removeprefix(self._prefix) if address.startswith(f"{self._prefix}/") else address

    @contextmanager
    def _converting_errors(self) -> Iterator[None]:
        try:
            yield
        except httpx.UnsupportedProtocol as error:
            raise ServiceError(f"{self.url} is not the address of a service: {error}") from error
        except httpx.TransportError as error:
            raise Unreachable(f"the service at {self.url} does not answer: {error}") from error
        except (httpx.HTTPError, httpx.InvalidURL, ValueError) as error:
            raise ServiceError(f"the service at {self.url} does not answer: {error}") from error


def _retry_seconds(answer: httpx.Response) -> float:
    seconds = answer.headers.get("Retry-After", "")
    return float(seconds) if seconds.isdecimal() else 0.0


def _checked(answer: httpx.Response) -> httpx.Response:
    """Return an answer if it reports success.

    Raises
    ------
    Refused
        If it lists faults of the document.
    NotFound
        If it is 404.
    ServiceError
        If it is any other problem.
    """
    if answer.is_success:
        return answer
    problem: dict[str, Any] = answer.json() if "json" in answer.headers.get("content-type", "") else {}
    if answer.status_code == 422 and problem.get("errors"):
        raise Refused([Fault(**fault) for fault in problem["errors"]])
    kind = NotFound if answer.status_code == 404 else ServiceError
    raise kind(f"the service answers {answer.status_code}: {problem.get('detail', answer.reason_phrase)}")
