"""The start page, and the document that a program finds in its place."""

from types import SimpleNamespace

from fastapi import APIRouter, Request, Response
from fastapi.responses import JSONResponse

from app.convert import ENGINE_VERSION
from app.http.problems import ProblemError, ProblemKind
from app.http.strict_routes import KnownParametersRoute
from app.jobs import job_records
from app.jobs.job_records import JobFilters
from app.pages import examples
from app.pages.drawings import bundles
from app.pages.forms import Fields
from app.pages.frame import address, moved, page, wants_page
from app.pages.submitting import submit
from app.pages.wording import words
from app.routes.dependencies import CallerOf, Readers
from app.runtime.version import SERVICE_VERSION

router = APIRouter(include_in_schema=False, route_class=KnownParametersRoute)

_RECENT = 8
_LINKS = {
    "service-desc": "/openapi.json",
    "service-doc": "/docs",
    "status": "/health/ready",
    "jobs": "/v1/jobs",
    "batches": "/v1/batches",
    "resolve-line": "/v1/lines/resolve",
    "conductors": "/v1/conductors",
    "ice-shapes": "/v1/ice-shapes",
    "fields": "/v1/fields",
    "tables": "/v1/tables",
    "version": "/v1/version",
    "conformance": "/ogc/conformance",
    "ogc-api-processes": "/ogc/",
}


@router.get("/")
def start(request: Request, caller: CallerOf, readers: Readers) -> Response:
    """Return the start page to a browser, and to a program what the service is and where its parts are."""
    if not wants_page(request):
        links = [{"rel": rel, "href": address(request)(path)} for rel, path in _LINKS.items()]
        versions = {"version": SERVICE_VERSION, "engine_version": ENGINE_VERSION}
        document = {"service": "Galloping of iced conductors", **versions, "links": links}
        return JSONResponse(document, headers={"Vary": "Accept"})
    with readers() as session:
        jobs = job_records.page(session, caller.owner, JobFilters(), None, _RECENT)
        return page(request, "start.html", jobs=jobs, examples=[(name, _card(name)) for name in examples.NAMES])


@router.post("/pages/examples/{name}")
async def run_example(request: Request, name: str, fields: Fields) -> Response:
    """Submit an example, and lead to the page of its result.

    Raises
    ------
    ProblemError
        404 if there is no such example.
    """
    if name not in examples.NAMES:
        raise ProblemError(ProblemKind.NOT_FOUND, f"There is no example {name[:40]!r}.")
    job = await submit(request, lambda: {"line": examples.line(name), "analysis": examples.ANALYSIS})
    return moved(request, f"/pages/jobs/{job.id}")


def _card(name: str) -> SimpleNamespace:
    said = getattr(words().examples, name)
    return SimpleNamespace(title=said.title, about=said.about, drawing=bundles.icon(examples.line(name)))
