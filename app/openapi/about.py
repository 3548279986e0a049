"""What the OpenAPI document says about the whole service: its description, its operator and its subjects."""

from typing import Any

from app.convert import ENGINE_VERSION
from app.runtime.settings import Settings

_DESCRIPTION = """Tells whether an iced transmission-line span gallops, from which wind speed, and how far.

Post a line to `/v1/jobs`, follow `Location` until the status is `successful`, then read `/results`.
Units stand in the names of the fields, and as `x-unit` in the schemas. A request may also say a number as
`{"value": 1000, "unit": "ft"}`. Faults are `application/problem+json` and name every field at once."""

_TAGS = {
    "jobs": "A line, a study or a comparison of remedies, computed by a worker",
    "results": "Tables, pictures and clearances of an ended job",
    "batches": "Many lines under one analysis",
    "lines": "What an engineer knows of a line, resolved or looked at without a job",
    "webhooks": "Messages about the end of jobs and batches",
    "aerodynamics": "Aerodynamic coefficients: fits, and tables of the owner",
    "reference": "Catalogues, the fields of a request and the tables of a result",
    "service": "Health, metrics and the meaning of problems",
}


def about(settings: Settings) -> dict[str, Any]:
    """Return what FastAPI is told of the document as a whole."""
    contact = {"name": settings.contact_name, "email": settings.contact_email}
    return {
        "title": "Galloping of iced conductors",
        "version": ENGINE_VERSION,
        "description": _DESCRIPTION,
        "contact": {name: value for name, value in contact.items() if value is not None},
        "servers": [{"url": settings.root_path or "/", "description": "This service"}],
        "openapi_tags": [{"name": name, "description": description} for name, description in _TAGS.items()],
    }
