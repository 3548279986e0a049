"""The two forms of a line in the document: Python resolves the one before it reads the other, so no schema says so."""

from typing import Any

from app.reference.source_lines import example
from app.routes.own_documentation import KNOWN_LINE
from app.schemas.batch import BatchRequest

_REFERENCE = "#/components/schemas/{model}"
FORMS = (
    ("Line, spelled out", "Line", example("c11-twin")),
    ("Line as an engineer knows it", "KnownLine", KNOWN_LINE),
)


def with_both_forms(document: dict[str, Any]) -> dict[str, Any]:
    """Return an OpenAPI document in which jobs and batches take a line in either form."""
    schemas = document["components"]["schemas"]
    schemas["JobRequest"]["properties"]["line"] = {
        "description": "The line: spelled out, or as an engineer knows it, which is then resolved",
        "anyOf": [{"title": title, "$ref": _REFERENCE.format(model=name)} for title, name, _ in FORMS],
        "examples": [line for _, _, line in FORMS],
    }
    batch = BatchRequest.model_json_schema(by_alias=True, ref_template=_REFERENCE)
    spelled = batch.pop("$defs")["BatchLine"]
    beside = {"reference": spelled["properties"]["reference"]}  # what a line of a batch has beside its own fields
    known = schemas["KnownLine"]
    schemas |= {
        "BatchRequest": batch,
        "BatchLine": spelled,
        "KnownBatchLine": {**known, "title": "KnownBatchLine", "properties": {**known["properties"], **beside}},
    }
    batch["properties"]["lines"]["items"] = {
        "anyOf": [
            {"title": title, "$ref": _REFERENCE.format(model=name)}
            for (title, _, _), name in zip(FORMS, ("BatchLine", "KnownBatchLine"), strict=True)
        ]
    }
    return document
