"""Documents of a job, as OGC API - Processes writes them: its status and its results."""

from collections.abc import Iterator
from typing import Any

from sqlalchemy.orm import Session

from app import convert
from app.export import formats
from app.ogc.links import BASE, PROCESS, link
from app.storage import stored_results
from app.tables import ENDED, Job, JobStatus


def status_info(job: Job, prefix: str = "") -> dict[str, Any]:
    """Return the status document of a job, its links under a prefix."""
    address = f"{prefix}{BASE}/jobs/{job.id}"
    moments = {"created": job.created_at, "started": job.started_at, "finished": job.finished_at}
    links = [
        link("self", address, "Status of the job"),
        link("alternate", f"{prefix}/v1/jobs/{job.id}", "The job under /v1"),
    ]
    if job.status is JobStatus.SUCCESSFUL:
        links.append(link("http://www.opengis.net/def/rel/ogc/1.0/results", f"{address}/results", "Results"))
    return {
        "processID": PROCESS,
        "type": "process",
        "jobID": str(job.id),
        "status": job.status.value,
        "message": job.failure_detail or job.step or job.status.value,
        "progress": 100 if job.status in ENDED else int(100 * job.progress),
        **{name: moment.isoformat() for name, moment in moments.items() if moment is not None},
        "links": links,
    }


def results(session: Session, job: Job, *, raw: bool) -> Iterator[str]:
    """Yield the pieces of a successful job's results: those of `/v1`, or in an object under the output's name."""
    points = list(stored_results.points(session, job.id))
    tables = {name: stored_results.rows(session, job.id, name) for name in convert.TABLES}
    text = formats.result_text(job.document, points, tables)
    if raw:
        yield from text
        return
    yield '{"result":{"mediaType":"application/json","value":'
    yield from text
    yield "}}"
