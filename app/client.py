"""The service seen from outside: submit a request, follow its job, fetch what came of it."""

import json
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import httpx

from app.faults import Fault

_POLL_SECONDS = 0.2
_ENDED = frozenset({"successful", "failed", "dismissed"})
_STRAINED = frozenset({429, 502, 503, 504})

Show = Callable[[float, str], object]
Json = dict[str, Any]


class ServiceError(Exception):
    """Raised when the service cannot be reached or answers something else than it should."""


class Refused(ServiceError):
    """Raised when the service refuses a document; `faults` holds what it found."""

    def __init__(self, faults: list[Fault]) -> None:
        """Take what the service found."""
        self.faults = faults
        super().__init__("; ".join(str(fault) for fault in faults))


@contextmanager
def connect(url: str, key: str | None = None) -> Iterator[httpx.Client]:
    """Open a client of the service, with a key if it asks for one.

    Raises
    ------
    ServiceError
        If the address is none, or the service does not answer while it is used.
    """
    headers = {"Authorization": f"Bearer {key}"} if key else {}
    try:
        with httpx.Client(base_url=url, headers=headers, timeout=30.0) as service:
            yield service
    except (httpx.HTTPError, httpx.InvalidURL, ValueError) as error:
        raise ServiceError(f"the service at {url} does not answer: {error}") from error
    except (LookupError, TypeError) as error:
        raise ServiceError(f"what answers at {url} is not this service") from error


def submit(service: httpx.Client, document: Mapping[str, Any]) -> Json:
    """Post a request and return the status of its job.

    Raises
    ------
    Refused
        If the document is at fault.
    ServiceError
        If the service answers something else.
    """
    # NaN goes out as it stands: the service names the field, which refusing to write it here would not.
    text = json.dumps(document)
    answer = service.post("/v1/jobs", content=text, headers={"Content-Type": "application/json"})
    if answer.status_code == 422:
        raise Refused([Fault(**fault) for fault in answer.json()["errors"]])
    return _json(answer)


def follow(service: httpx.Client, job: Mapping[str, Any], show: Show) -> Json:
    """Look at a job until it has ended, and return its last status; `show` is called with fraction and step.

    Raises
    ------
    ServiceError
        If the service answers something unexpected.
    """
    address = _link(job, "self")
    while True:
        answer = service.get(address)
        if answer.status_code not in _STRAINED:
            status = _json(answer)
            show(status["progress"], status["step"])
            if status["status"] in _ENDED:
                return status
        time.sleep(_POLL_SECONDS)


def results(service: httpx.Client, job: Mapping[str, Any]) -> Json:
    """Return the result document of an ended job.

    Raises
    ------
    ServiceError
        If there is none.
    """
    return _json(service.get(_link(job, "results")))


def download(service: httpx.Client, job: Mapping[str, Any], path: str) -> bytes:
    """Return what lies under the address of a job.

    Raises
    ------
    ServiceError
        If there is nothing.
    """
    return _checked(service.get(f"{_link(job, 'self')}/{path}")).content


def _link(job: Mapping[str, Any], relation: str) -> str:
    return {str(link["rel"]): str(link["href"]) for link in job["links"]}[relation]


def _json(answer: httpx.Response) -> Json:
    document: Json = _checked(answer).json()
    return document


def _checked(answer: httpx.Response) -> httpx.Response:
    if answer.is_error:
        problem = answer.json() if "json" in answer.headers.get("content-type", "") else {}
        raise ServiceError(f"the service answers {answer.status_code}: {problem.get('detail', answer.reason_phrase)}")
    return answer
