"""The client itself."""

import json
import time
from collections.abc import Iterator, Mapping
from types import TracebackType
from typing import IO, TYPE_CHECKING, Any, Literal, Self, TypeVar
from uuid import UUID

import httpx
from pydantic import BaseModel

from app.answers.batches import BatchDocument, BatchTableName
from app.answers.jobs import JobDocument, JobPage
from app.answers.results import ResultDocument, TableName
from app.client import uploads
from app.client.connection import Connection, ServiceError, Show
from app.client.uploads import Lines, Upload, as_json
from app.schemas import Analysis, Line, Study

if TYPE_CHECKING:
    import pandas as pd

Json = dict[str, Any]
Model = TypeVar("Model", bound=BaseModel)
Followed = TypeVar("Followed", JobDocument, BatchDocument)

_ENDED = frozenset({"successful", "failed", "dismissed"})
_FIRST_LOOK_SECONDS = 0.1
_LONGEST_LOOK_SECONDS = 2.0


class JobFailed(ServiceError):
    """Raised when a result is asked of a job that failed or was cancelled; `job` is its status."""

    def __init__(self, job: JobDocument) -> None:
        """Take the job's status."""
        self.job = job
        super().__init__(f"the job failed: {job.failure.detail}" if job.failure else "the job was cancelled")


class Client:
    """A connection to the service, to be used in a `with` statement or closed.

    Every method raises `ServiceError` if the service cannot be reached in time or answers with a problem, and `Refused`
    if it finds faults in what was sent.
    """

    def __init__(self, url: str | None = None, key: str | None = None, *, patience_seconds: float = 60.0) -> None:
        """Take the address and the key; GALLOPING_URL and GALLOPING_KEY of the environment hold where they are absent.

        A request is tried again for `patience_seconds`.

        Raises
        ------
        ServiceError
            If the address is none.
        """
        self._connection = Connection(url, key, patience_seconds)

    def __enter__(self) -> Self:
        """Use the connection."""
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
        line: Line | Mapping[str, Any],
        analysis: Analysis | Mapping[str, Any] | None = None,
        study: Study | Mapping[str, Any] | None = None,
    ) -> ResultDocument:
        """Submit a line, wait for the end, and return everything that was found.

        Raises
        ------
        JobFailed
            If the job failed; what it has nevertheless is under `results`.
        """
        job = self.wait(self.submit(line, analysis, study))
        if job.status != "successful":
            raise JobFailed(job)
        return self.results(job)

    def submit(
        self,
        line: Line | Mapping[str, Any],
        analysis: Analysis | Mapping[str, Any] | None = None,
        study: Study | Mapping[str, Any] | None = None,
    ) -> JobDocument:
        """Submit a line for analysis and return the status of its job."""
        given = {"line": line, "analysis": analysis, "study": study}
        return self.submit_document({name: as_json(part) for name, part in given.items() if part is not None})

    def submit_document(self, document: Mapping[str, Any], *, idempotency_key: str | None = None) -> JobDocument:
        """Submit a whole request; with the key of an earlier one that one's job is returned."""
        # NaN goes out as it stands: the service names the field, which refusing to write it here would not.
        text = json.dumps(document).encode()
        answer = self._connection.post("/v1/jobs", lambda: text, {"Content-Type": "application/json"}, idempotency_key)
        return self._connection.read(JobDocument, answer)

    def job(self, job_id: UUID | str) -> JobDocument:
        """Return the status of a job."""
        return self._get(JobDocument, f"/v1/jobs/{job_id}")

    def jobs(self, **filters: str | int | list[str]) -> Iterator[JobDocument]:
        """Yield the jobs that pass the filters of `GET /v1/jobs`, newest first, page by page."""
        address: str | None = str(httpx.URL("/v1/jobs", params=filters))
        while address is not None:
            page = self._get(JobPage, address)
            yield from page.jobs
            address = page.next

    def wait(self, job: Followed, show: Show | None = None, *, seconds: float | None = None) -> Followed:
        """Look at a job or batch until it has ended, and return its last status.

        Parameters
        ----------
        job : JobDocument or BatchDocument
            As it was submitted.
        show : callable, optional
            Is called with the fraction done, 0 to 1, and the step.
        seconds : float, optional
            How long to wait at most.

        Raises
        ------
        TimeoutError
            If it has not ended in time.
        """
        begin, pause = time.monotonic(), _FIRST_LOOK_SECONDS
        while True:
            found = self._get(type(job), _address(job))
            if show is not None:
                show(found.progress, found.step if isinstance(found, JobDocument) else "")
            if found.status in _ENDED:
                return found
            if seconds is not None and time.monotonic() - begin + pause > seconds:
                raise TimeoutError(f"{_address(job)} is {found.status}, {found.progress:.0%} done")
            time.sleep(pause)
            pause = min(1.5 * pause, _LONGEST_LOOK_SECONDS)

    def results(self, job: JobDocument) -> ResultDocument:
        """Return everything that was found by an ended job."""
        return self._get(ResultDocument, f"{_address(job)}/results")

    def rows(self, job: JobDocument, table: TableName) -> list[Json]:
        """Return the rows of one table of an ended job."""
        found: dict[str, list[Json]] = json.loads(self.download(job, f"results/{table}?format=json"))
        (only,) = found.values()
        return only

    def frame(self, job: JobDocument, table: TableName) -> "pd.DataFrame":
        """Return one table of an ended job as a data frame; needs pandas (`galloping[pandas]`)."""
        return uploads.frame(self.rows(job, table))

    def plot(self, job: JobDocument, picture: str = "amplitude", extension: Literal["svg", "png"] = "svg") -> bytes:
        """Return a picture of an ended job: amplitude, orbit, or what else its links name."""
        return self.download(job, f"plots/{picture}.{extension}")

    def download(self, job: JobDocument | BatchDocument, path: str) -> bytes:
        """Return what lies at a path under the address of a job or batch."""
        return self._connection.get(f"{_address(job)}/{path}").content

    def cancel(self, job: JobDocument | BatchDocument) -> None:
        """Cancel a job or batch; one that has ended is removed with its results."""
        self._connection.delete(_address(job))

    def submit_batch(
        self,
        lines: Lines,
        analysis: Analysis | Mapping[str, Any] | None = None,
        *,
        atomic: bool = False,
        idempotency_key: str | None = None,
    ) -> BatchDocument:
        """Submit many lines under one analysis; they are sent as a stream, whatever their number.

        Parameters
        ----------
        lines : iterable of lines, path, or pandas.DataFrame
            A path is that of an NDJSON, JSON or CSV file, which may end in .gz; the columns of a frame and of CSV are
            dotted field names such as `span.length_m`. NDJSON and JSON hold their analysis themselves.
        analysis : Analysis or mapping, optional
            What is asked of every line.
        atomic : bool
            Whether a single line at fault shall refuse all.
        """
        with uploads.opened(lines, as_json(analysis or {})) as upload:
            address = f"/v1/batches?{upload.query(atomic)}"
            answer = self._connection.post(address, lambda: _from_start(upload), upload.headers, idempotency_key)
        return self._connection.read(BatchDocument, answer)

    def batch(self, batch_id: UUID | str) -> BatchDocument:
        """Return the status of a batch."""
        return self._get(BatchDocument, f"/v1/batches/{batch_id}")

    def batch_rows(self, batch: BatchDocument, table: BatchTableName | None = None) -> Iterator[Json]:
        """Yield the rows of one table of a batch, or an object a line with everything, as they come in."""
        named = {"format": "ndjson"} | ({"table": table} if table else {})
        for line in self._connection.lines(str(httpx.URL(f"{_address(batch)}/results", params=named))):
            yield json.loads(line)

    def batch_frame(self, batch: BatchDocument, table: BatchTableName = "summary") -> "pd.DataFrame":
        """Return one table of a batch as a data frame; needs pandas (`galloping[pandas]`)."""
        return uploads.frame(self.batch_rows(batch, table))

    def resubmit(self, batch: BatchDocument) -> BatchDocument:
        """Run the failed lines of a batch once more."""
        return self._connection.read(BatchDocument, self._connection.post(f"{_address(batch)}/resubmit"))

    def _get(self, model: type[Model], address: str) -> Model:
        return self._connection.read(model, self._connection.get(address))


def _address(job: JobDocument | BatchDocument) -> str:
    return {link.rel: link.href for link in job.links}["self"]


def _from_start(upload: Upload) -> IO[bytes]:
    upload.file.seek(0)
    return upload.file
