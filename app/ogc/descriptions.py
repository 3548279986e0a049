"""What the service says of itself to clients of OGC API - Processes: landing page, conformance, the process."""

from functools import cache, lru_cache
from typing import Any

from fastapi.responses import JSONResponse

from app.answers.results import ResultDocument
from app.convert import ENGINE_VERSION
from app.http.prefix import linked
from app.ogc.dialect import shared
from app.ogc.links import BASE, INPUTS, PROCESS, link
from app.openapi.line_forms import FORMS
from app.schemas import JobRequest
from app.schemas.field_table import inlined
from app.schemas.known import KnownLine

_CONFORMANCE = "http://www.opengis.net/spec/ogcapi-processes-1/1.0/conf"
_RELATION = "http://www.opengis.net/def/rel/ogc/1.0"
_CLASSES = ("core", "ogc-process-description", "json", "job-list", "dismiss", "callback")
_TITLE = "Galloping of iced conductors"
_ABOUT = (
    "Tells whether an iced transmission-line span gallops, from which wind speed, and how far; with a study also how "
    "that changes with one or two fields of the line, with remedies what they change."
)


def landing() -> dict[str, Any]:
    """Return the landing page."""
    return {
        "title": _TITLE,
        "description": _ABOUT,
        "links": [
            link("self", f"{BASE}/", "This document"),
            link("service-desc", "/openapi.json", "The whole API", "application/vnd.oai.openapi+json;version=3.1"),
            link("service-doc", "/docs", "The whole API for people", "text/html"),
            *(link(rel, f"{BASE}/conformance", "Conformance") for rel in ("conformance", f"{_RELATION}/conformance")),
            *(link(rel, f"{BASE}/processes", "Processes") for rel in ("processes", f"{_RELATION}/processes")),
            *(link(rel, f"{BASE}/jobs", "Jobs") for rel in ("job-list", f"{_RELATION}/job-list")),
        ],
    }


def conformance() -> dict[str, Any]:
    """Return the classes of the standard that these routes follow."""
    return {"conformsTo": [f"{_CONFORMANCE}/{name}" for name in _CLASSES]}


def summary() -> dict[str, Any]:
    """Return the process in a list."""
    address = f"{BASE}/processes/{PROCESS}"
    return {
        "id": PROCESS,
        "title": _TITLE,
        "description": _ABOUT,
        "version": ENGINE_VERSION,
        "keywords": ["galloping", "overhead line", "ice", "wind"],
        "jobControlOptions": ["sync-execute", "async-execute", "dismiss"],
        "outputTransmission": ["value"],
        "links": [
            link("self", address, "Description of the process"),
            link(f"{_RELATION}/execute", f"{address}/execution", "Execute the process"),
        ],
    }


@cache
def description() -> dict[str, Any]:
    """Return the process with the schemas of its inputs and of its output."""
    request = JobRequest.model_json_schema(by_alias=True)
    fields = inlined(request, request["$defs"])["properties"]
    known = KnownLine.model_json_schema(by_alias=True)
    forms = [fields["line"], inlined(known, known["$defs"])]
    named = [{**form, "title": title} for form, (title, _, _) in zip(forms, FORMS, strict=True)]
    schemas = {**{name: fields[name] for name in INPUTS}, "line": {"anyOf": named}}
    inputs = {
        name: {
            "title": name.capitalize(),
            "description": fields[name]["description"],
            "schema": shared(schemas[name]),
            "minOccurs": 1 if name == "line" else 0,
            "maxOccurs": 1,
        }
        for name in INPUTS
    }
    result = ResultDocument.model_json_schema(by_alias=True)
    output = {**shared(inlined(result, result["$defs"])), "contentMediaType": "application/json"}
    about = {"title": "Result", "description": "Every table of the result", "schema": output}
    return {**summary(), "inputs": inputs, "outputs": {"result": about}}


@lru_cache(maxsize=8)  # a service has few addresses; 300 kB are not to be written anew for each request
def description_text(address: str) -> bytes:
    """Return the description as JSON, with links to the service at an address."""
    return bytes(JSONResponse(linked(description(), address)).body)
