"""The client and its methods."""

import json
import time
from collections.abc import Iterator, Mapping
from types import TracebackType
from typing import IO, TYPE_CHECKING, Any, Self, TypeVar
from uuid import UUID

import httpx
from pydantic import BaseModel

from app.answers.batches import BatchDocument, BatchTableName, RankedLine, RankingPage
from app.answers.jobs import JobDocument, JobPage
from app.answers.results import Extension, ResultDocument, TableName
from app.client import uploads
from app.client.connection import Connection, ServiceError, Show
from app.client.known_lines import KnownLines
from app.client.uploads import Lines, Upload, as_json
from app.schemas import Analysis, Line, Remedies, Study
from app.schemas.known import KnownLine

if TYPE_CHECKING:
    import pandas as pd

Json = dict[str, Any]
Model = TypeVar("Model", bound=BaseModel)
Followed = TypeVar("Followed", bound=JobDocument | BatchDocument)

_ENDED = frozenset({"successful", "failed", "dismissed"})
_FIRST_POLL_SECONDS = 0.1
_LONGEST_POLL_SECONDS = 2.0


class JobFailed(ServiceError):
    """Raised when the results of a failed or cancelled job are requested; `job` is its status."""

    def __init__(self, job: JobDocument) -> None:
        """Take the job's status."""
        self.job = job
        super().__init__(f"the job failed: {job.failure.detail}" if job.failure else "the job was cancelled")


class Client(KnownLines):
    """A connection to the service; use it in a `with` statement or close it.

    Every method raises `ServiceError` if the service does not answer in time or answers with a problem, and `Refused`
    if the service finds faults in the document.
    """

    def __init__(self, url: str | None = None, key: str | None = None, *, patience_seconds: float = 60.0) -> None:
        """Take the address and the key; GALLOPING_URL and GALLOPING_KEY replace absent ones.

        A failing request is retried for `patience_seconds`.

        Raises
        ------
        ServiceError
            If the address is not valid.
        """
        self._connection = Connection(url, key, patience_seconds)

    def __enter__(self) -> Self:
        """Return the client."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the connection."""
        self.close()

    def close(self) -> None:
        """Close the connection."""
        self._connection.close()

    def analyse(
        self,
        line: Line | KnownLine | Mapping[str, Any],
        analysis: Analysis | Mapping[str, Any] | None = None,
        study: Study | Mapping[str, Any] | None = None,
    ) -> ResultDocument:
        """Submit a line, wait until the job ends, and return its results.

        Raises
        ------
        JobFailed
            If the job failed; `results` still returns the points that it finished.
        """
        job = self.wait(self.submit(line, analysis, study))
        if job.status != "successful":
            raise JobFailed(job)
        return self.results(job)

    def submit(
        self,
        line: Line | KnownLine | Mapping[str, Any],
        analysis: Analysis | Mapping[str, Any] | None = None,
        study: Study | Mapping[str, Any] | None = None,
    ) -> JobDocument:
        """Submit a line for analysis and return the status of its job."""
        given = {"line": line, "analysis": analysis, "study": study}
        return self.submit_document({name: as_json(part) for name, part in given.items() if part is not None})

    def submit_document(self, document: Mapping[str, Any], *, idempotency_key: str | None = None) -> JobDocument:
        """Submit a whole request; with the idempotency key of an earlier request, return that request's job."""
        return self._posted("/v1/jobs", document, idempotency_key)

    def compare_remedies(
        self,
        line: Line | Mapping[str, Any],
        analysis: Analysis | Mapping[str, Any] | None = None,
        remedies: Remedies | Mapping[str, Any] | None = None,
    ) -> list[Json]:
        """Compare a line with remedies, the usual ones if none are named, and return the rows of the table `remedies`.

        Raises
        ------
        JobFailed
            If the job failed.
        """
        given = {"line": line, "analysis": analysis, "remedies": remedies}
        document = {name: as_json(part) for name, part in given.items() if part is not None}
        job = self.wait(self._posted("/v1/remedies", document, None))
        if job.status != "successful":
            raise JobFailed(job)
        return self.rows(job, "remedies")

    def job(self, job_id: UUID | str) -> JobDocument:
        """Return the status of a job."""
        return self._get(JobDocument, f"/v1/jobs/{job_id}")

    def jobs(self, **filters: str | int | list[str]) -> Iterator[JobDocument]:
        """Yield the jobs that match the filters of `GET /v1/jobs`, newest first, page by page."""
        address: str | None = str(httpx.URL("/v1/jobs", params=filters))
        while address is not None:
            page = self._get(JobPage, address)
            yield from page.jobs
            address = page.next

    def wait(self, job: Followed, show: Show | None = None, *, seconds: float | None = None) -> Followed:
        """Poll a job or batch until it ends, and return its final status.

        Parameters
        ----------
        job : JobDocument or BatchDocument
            Status of the job or batch, as `submit` returned it.
        show : callable, optional
            Called with the fraction done, 0 to 1, and the current step.
        seconds : float, optional
            Longest time to wait.

        Raises
        ------
        TimeoutError
            If the job or batch does not end in time.
        """
        begin, pause = time.monotonic(), _FIRST_POLL_SECONDS
        while True:
            found = self._get(type(job), _address(job))
            if show is not None:
                show(found.progress, found.step if isinstance(found, JobDocument) else "")
            if found.status in _ENDED:
                return found
            if seconds is not None and time.monotonic() - begin + pause > seconds:
                raise TimeoutError(f"{_address(job)} is {found.status}, {found.progress:.0%} done")
            time.sleep(pause)
            pause = min(1.5 * pause, _LONGEST_POLL_SECONDS)

    def results(self, job: JobDocument) -> ResultDocument:
        """Return all results of a finished job."""
        return self._get(ResultDocument, f"{_address(job)}/results")

    def rows(self, job: JobDocument, table: TableName) -> list[Json]:
        """Return the rows of one table of a finished job."""
        found: dict[str, list[Json]] = json.loads(self.download(job, f"results/{table}?format=json"))
        (only,) = found.values()
        return only

    def frame(self, job: JobDocument, table: TableName) -> "pd.DataFrame":
        """Return one table of a finished job as a data frame; needs pandas (`galloping[pandas]`)."""
        return uploads.frame(self.rows(job, table))

    def plot(
        self, job: JobDocument, picture: str = "amplitude", extension: Extension = "svg", **look: str | float
    ) -> bytes:
        """Return a picture of a finished job: amplitude, orbit, or another one named in its links.

        `look` holds theme ("light", "dark"), width and height [px], point, and the abscissa of a study.
        """
        return self.download(job, str(httpx.URL(f"plots/{picture}.{extension}", params=look)))

    def download(self, job: JobDocument | BatchDocument, path: str) -> bytes:
        """Return the content at a path below the address of a job or batch."""
        return self._connection.get(f"{_address(job)}/{path}").content

    def cancel(self, job: JobDocument | BatchDocument) -> None:
        """Cancel a job or batch; one that has ended keeps its results."""
        self._connection.post(f"{_address(job)}/cancel")

    def remove(self, job: JobDocument | BatchDocument) -> None:
        """Remove a job or batch that has ended, with its results; one that has not is refused, not cancelled."""
        self._connection.delete(f"{_address(job)}?if_ended=true")

    def submit_batch(
        self,
        lines: Lines,
        analysis: Analysis | Mapping[str, Any] | None = None,
        *,
        defaults: Mapping[str, Any] | None = None,
        atomic: bool = False,
        idempotency_key: str | None = None,
    ) -> BatchDocument:
        """Submit many lines under one analysis, sent as a stream of any length.

        Parameters
        ----------
        lines : iterable of lines, path, or pandas.DataFrame
            A path leads to a file of NDJSON, JSON, CSV, XLSX, GeoJSON (.geojson) or CIM (.xml, .rdf), which may end in
            .gz. The columns of a frame or a sheet are dotted field names such as `span.length_m`. NDJSON and JSON files
            contain their analysis and defaults.
        analysis : Analysis or mapping, optional
            The analysis of every line.
        defaults : mapping, optional
            Fields of a line, for the lines that leave them open.
        atomic : bool
            Whether one wrong line rejects the whole batch.
        """
        with uploads.opened(lines, as_json(analysis or {}), defaults) as upload:
            address = f"/v1/batches?{upload.query(atomic)}"
            answer = self._connection.post(address, lambda: _from_start(upload), upload.headers, idempotency_key)
        return self._connection.read(BatchDocument, answer)

    def batch(self, batch_id: UUID | str) -> BatchDocument:
        """Return the status of a batch."""
        return self._get(BatchDocument, f"/v1/batches/{batch_id}")

    def batch_rows(self, batch: BatchDocument, table: BatchTableName | None = None) -> Iterator[Json]:
        """Yield the rows of one table of a batch, or all results of each line as one object, as they arrive."""
        named = {"format": "ndjson"} | ({"table": table} if table else {})
        for line in self._connection.lines(str(httpx.URL(f"{_address(batch)}/results", params=named))):
            yield json.loads(line)

    def batch_frame(self, batch: BatchDocument, table: BatchTableName = "summary") -> "pd.DataFrame":
        """Return one table of a batch as a data frame; needs pandas (`galloping[pandas]`)."""
        return uploads.frame(self.batch_rows(batch, table))

    def ranking(self, batch: BatchDocument, **query: str | float | bool) -> Iterator[RankedLine]:
        """Yield the lines of a batch in the order of a figure, `by="risk"` for the hours of galloping a year.

        The query is that of `GET /v1/batches/{id}/ranking`.
        """
        address: str | None = str(httpx.URL(f"{_address(batch)}/ranking", params=query))
        while address is not None:
            page = self._get(RankingPage, address)
            yield from page.lines
            address = page.next

    def resubmit(self, batch: BatchDocument) -> BatchDocument:
        """Run the failed lines of a batch again."""
        return self._connection.read(BatchDocument, self._connection.post(f"{_address(batch)}/resubmit"))

    def _posted(self, address: str, document: Mapping[str, Any], idempotency_key: str | None) -> JobDocument:
        # Send NaN as it is: the service names the field in its answer.
        text = json.dumps(document).encode()
        answer = self._connection.post(address, lambda: text, {"Content-Type": "application/json"}, idempotency_key)
        return self._connection.read(JobDocument, answer)

    def _get(self, model: type[Model], address: str) -> Model:
        return self._connection.read(model, self._connection.get(address))


def _address(job: JobDocument | BatchDocument) -> str:
    return {link.rel: link.href for link in job.links}["self"]


def _from_start(upload: Upload) -> IO[bytes]:
    upload.file.seek(0)
    return upload.file
