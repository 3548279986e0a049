"""Requests of OGC API - Processes: what to execute, and which jobs to list."""

from collections.abc import Iterator
from datetime import datetime
from itertools import islice
from typing import Annotated, Any, Literal

from pydantic import (
    AliasChoices,
    AwareDatetime,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    TypeAdapter,
    ValidationError,
)

from app import convert, schemas
from app.http.problems import query_fault
from app.jobs.job_records import JobFilters
from app.jobs.webhooks import Subscription
from app.ogc.links import INPUTS, PROCESS
from app.schemas.faults import MOST_FAULTS, BadInput, Fault, faults_of, json_pointer
from app.tables import DeliveryEvent, JobStatus

_QUALIFIED = frozenset({"value", "mediaType", "encoding", "schema"})
_LARGEST_PAGE = 500
_MOMENT: TypeAdapter[datetime] = TypeAdapter(AwareDatetime)


class Subscriber(BaseModel):
    """Where to send the results of a job, and where to report its beginning and its failure."""

    model_config = ConfigDict(extra="forbid", strict=True, populate_by_name=True)

    success: str | None = Field(None, alias="successUri", max_length=2000)
    in_progress: str | None = Field(None, alias="inProgressUri", max_length=2000)
    failed: str | None = Field(None, alias="failedUri", max_length=2000)

    def subscriptions(self) -> dict[str, Subscription]:
        """Return who is told of which event, by the pointers of their addresses."""
        told = (
            ("successUri", self.success, DeliveryEvent.SUCCEEDED),
            ("inProgressUri", self.in_progress, DeliveryEvent.STARTED),
            ("failedUri", self.failed, DeliveryEvent.FAILED),
        )
        return {f"/subscriber/{name}": Subscription(url, event) for name, url, event in told if url is not None}


class Execution(BaseModel):
    """A request to execute the process; members that the standard does not know are ignored, as it asks."""

    model_config = ConfigDict(extra="ignore", strict=True)

    inputs: dict[str, Any]
    outputs: dict[Literal["result"], Any] | None = None
    response: Literal["raw", "document"] = "raw"
    # The standard's name, and the one under which weaver's client sends it.
    subscriber: Subscriber | None = Field(None, validation_alias=AliasChoices("subscriber", "subscribers"))

    def request(self, own: convert.OwnRows) -> schemas.JobRequest:
        """Return the job that the inputs say, its line resolved with the caller's own rows.

        Raises
        ------
        BadInput
            With every fault, with JSON pointers below `/inputs`.
        """
        faults = list(islice(self._faults(), MOST_FAULTS + 1))
        if faults:
            raise BadInput(faults)
        document = {name: _bare(value) for name, value in self.inputs.items()}
        try:
            return schemas.JobRequest.model_validate(convert.explicit_request(document, own))
        except ValidationError as error:
            raise BadInput(faults_of(error.errors(include_url=False), root="/inputs")) from error
        except BadInput as error:
            raise BadInput([Fault(f"/inputs{f.pointer}", f.code, f.detail) for f in error.faults]) from error

    def _faults(self) -> Iterator[Fault]:
        for name, value in self.inputs.items():
            pointer = json_pointer(("inputs", name))
            if name not in INPUTS:
                yield Fault(pointer, "unknown_field", "unknown field")
            elif isinstance(value, dict) and "href" in value:
                yield Fault(pointer, "by_reference", "must be given by value; the service follows no links")


def _split(texts: Any) -> Any:
    return [part for text in texts for part in text.split(",")] if isinstance(texts, list) else texts


_COMMAS = BeforeValidator(_split)  # clients repeat a parameter, or write its values with commas


class JobsQuery(BaseModel):
    """Filters of the list of jobs, as the standard names them; `f` is how pygeoapi's clients ask for a format."""

    model_config = ConfigDict(extra="forbid")

    type: Annotated[list[Literal["process"]], _COMMAS] = []
    processID: Annotated[list[Annotated[str, Field(max_length=100)]], _COMMAS] = []  # noqa: N815 - the standard's name
    status: Annotated[list[JobStatus], _COMMAS] = []
    datetime: Annotated[str | None, Field(max_length=100)] = None
    minDuration: Annotated[int | None, Field(ge=0)] = None  # noqa: N815
    maxDuration: Annotated[int | None, Field(ge=0)] = None  # noqa: N815
    limit: Annotated[int, Field(ge=1)] = 50
    cursor: Annotated[str | None, Field(max_length=200)] = None
    f: Literal["json"] = "json"

    @property
    def rows(self) -> int:
        """Return how many jobs a page shows: no more than the service allows, which the standard calls no error."""
        return min(self.limit, _LARGEST_PAGE)

    def filters(self) -> JobFilters | None:
        """Return the filters, None where they match no job of this service.

        Raises
        ------
        ProblemError
            400 if the interval of time is none.
        """
        if self.processID and PROCESS not in self.processID:
            return None
        begin, end = _interval(self.datetime) if self.datetime else (None, None)
        return JobFilters(
            statuses=tuple(self.status),
            created_after=begin,
            created_before=end,
            shortest_seconds=self.minDuration,
            longest_seconds=self.maxDuration,
        )


def _bare(value: Any) -> Any:
    """Return an input by itself; a value of the standard may say its media type beside it."""
    return value["value"] if isinstance(value, dict) and "value" in value and value.keys() <= _QUALIFIED else value


def _interval(text: str) -> tuple[datetime | None, datetime | None]:
    ends = text.split("/")
    try:
        moments = [None if end in {"", ".."} else _MOMENT.validate_python(end) for end in ends]
    except ValidationError as error:
        raise query_fault("datetime", "must be moments with a time zone, as in RFC 3339") from error
    if len(moments) == 1:
        return moments[0], moments[0]
    if len(moments) != 2:
        raise query_fault("datetime", "must be a moment or two with a slash between them")
    return moments[0], moments[1]
