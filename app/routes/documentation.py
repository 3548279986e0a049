"""OpenAPI examples of every body and every problem; tests validate each against its schema."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

from app import convert
from app.answers.jobs import JobDocument
from app.answers.problem_pages import Problem
from app.answers.results import ResultDocument
from app.export.formats import PARQUET, XLSX, csv_text
from app.http.problems import MEDIA_TYPE, ProblemKind, problem_document
from app.reference.source_lines import EXAMPLE_NAMES, example
from app.schemas.devices.tried_remedies import EXAMPLE as REMEDIES
from app.schemas.faults import Fault
from app.schemas.fields import example_of, with_marks
from app.schemas.placement import EXAMPLE as PLACEMENT

_JOB = "0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e"
_ADDRESS = f"/v1/jobs/{_JOB}"
_PROBLEM_SCHEMA = {"$ref": "#/components/schemas/Problem"}


DIALECT = (
    "Form of a CSV: plain (RFC 4180), excel (with a byte order mark), or excel_semicolon (that, with semicolons and "
    "decimal commas, as Excel expects in most of Europe)"
)


def table_as_csv(name: str, before: Mapping[str, object] = MappingProxyType({})) -> str:
    """Return an example of a table as CSV, after the columns `before`."""
    (row,) = convert.example_tables()[name]
    return "".join(csv_text([*before, *row], [{**before, **row}]))


REPLAYED_HEADER: dict[str, Any] = {
    "Idempotency-Replayed": {
        "description": "`true` if this is the first answer under the `Idempotency-Key`, given again",
        "schema": {"type": "string", "enum": ["true"]},
    }
}
ACCEPTED_HEADERS: dict[str, Any] = {
    "Location": {"description": "Address of the status", "schema": {"type": "string"}},
    "Retry-After": {"description": "Seconds to wait before the next request", "schema": {"type": "integer"}},
    **REPLAYED_HEADER,
}
_NOTHING_YET = ("started_at", "finished_at", "duration_seconds", "failure", "engine_version", "reused_from")
ACCEPTED_JOB: dict[str, Any] = {
    **example_of(JobDocument),
    "status": "accepted",
    "progress": 0.0,
    "step": "",
    "attempt": 0,
    **dict.fromkeys(_NOTHING_YET),
}
FINISHED_JOB: dict[str, Any] = {
    **example_of(JobDocument),
    "status": "successful",
    "progress": 1.0,
    "step": "done",
    "failure": None,
    "reused_from": None,
    "links": [{"rel": "self", "href": _ADDRESS}, {"rel": "results", "href": f"{_ADDRESS}/results"}],
}
DISMISSED_JOB: dict[str, Any] = {**ACCEPTED_JOB, "status": "dismissed", "finished_at": "2026-11-22T10:00:02+00:00"}
STOPPING_JOB: dict[str, Any] = {
    **example_of(JobDocument),
    "cancel_requested": True,
    **dict.fromkeys(("finished_at", "duration_seconds", "failure", "engine_version", "reused_from")),
}
RESULT: dict[str, Any] = {**example_of(ResultDocument), "failures": [], "failure": None}
PROBLEM_PAGE: dict[str, Any] = {
    "slug": ProblemKind.NOT_READY.slug,
    "status": ProblemKind.NOT_READY.status,
    "title": ProblemKind.NOT_READY.title,
    "description": ProblemKind.NOT_READY.description,
}
TABLE_ANSWER: dict[str, Any] = {
    "description": "The rows of the table; in JSON under the table's name",
    "content": {
        "application/json": {
            "schema": {"type": "object", "additionalProperties": {"type": "array", "items": {"type": "object"}}},
            "examples": {name: {"value": with_marks({name: rows})} for name, rows in convert.example_tables().items()},
        },
        "text/csv": {
            "schema": {"type": "string"},
            "example": table_as_csv("frequencies"),
        },
        PARQUET: {"schema": {"type": "string", "format": "binary"}},
        XLSX: {"schema": {"type": "string", "format": "binary"}},
    },
}
PICTURE_ANSWER: dict[str, Any] = {
    "description": "The picture",
    "content": {
        "image/svg+xml": {"schema": {"type": "string"}, "example": "<svg/>"},
        "image/png": {"schema": {"type": "string", "format": "binary"}},
        "application/pdf": {"schema": {"type": "string", "format": "binary"}},
    },
}
JOB_PAGE: dict[str, Any] = {"jobs": [FINISHED_JOB], "next": None}

REQUESTS: dict[str, Any] = {
    **{name: {"summary": example(name)["name"], "value": {"line": example(name)}} for name in EXAMPLE_NAMES},
    "wind-speed-range": {
        "summary": "21 wind speeds, hybrid model only",
        "value": {
            "line": example("c11-twin"),
            "analysis": {
                "loops": [1, 2],
                "models": ["hybrid"],
                "wind_speeds_m_per_s": {"start": 4.0, "stop": 6.0, "count": 21},
            },
        },
    },
    "study": {
        "summary": "Three tensions",
        "value": {
            "line": example("c11-twin"),
            "analysis": {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [6.0]},
            "study": {"axes": [{"parameter": "span.horizontal_tension_n", "values": [24000, 30000, 36000]}]},
        },
    },
    "placement": {
        "summary": "Best places of two pendulums",
        "value": {
            "line": example("c11-twin"),
            "analysis": {"models": ["hybrid"], "wind_speeds_m_per_s": [4.0]},
            "placement": PLACEMENT,
        },
    },
}
REMEDIES_REQUESTS: dict[str, Any] = {
    "usual": {
        "summary": "The usual remedies",
        "value": {"line": example("c11-twin"), "analysis": {"wind_speeds_m_per_s": [6.0]}},
    },
    "named": {
        "summary": "Three remedies, one of them placed by search",
        "value": {
            "line": example("c11-twin"),
            "analysis": {"models": ["hybrid"], "wind_speeds_m_per_s": [6.0]},
            "remedies": REMEDIES,
        },
    },
}

_FAULTS = {
    ProblemKind.INVALID_DOCUMENT: [
        Fault("/line/span/length_m", "greater_than_equal", "input should be greater than or equal to 1"),
        Fault("/line/conductor/colour", "unknown_field", "unknown field"),
    ],
    ProblemKind.INVALID_PARAMETER: [
        Fault("/query/cursor", "invalid", "the cursor is not one that this service issued")
    ],
}

UNCHANGED: dict[int | str, dict[str, Any]] = {
    304: {
        "description": "The client has this answer: its `ETag` is in `If-None-Match`",
        "headers": {"ETag": {"description": "Strong tag of the answer", "schema": {"type": "string"}}},
    }
}
# FastAPI adds the model's schema under its own media type, which `app.openapi` corrects.
ANY_PROBLEM: dict[str, Any] = {"model": Problem}
ANY_PROBLEM_AS_SENT: dict[str, Any] = {
    "description": "Problem details (RFC 9457), as application/problem+json",
    "content": {
        MEDIA_TYPE: {
            "schema": _PROBLEM_SCHEMA,
            "example": problem_document(ProblemKind.NOT_FOUND, ProblemKind.NOT_FOUND.description, _ADDRESS),
        }
    },
}


def problems(*kinds: ProblemKind) -> dict[int | str, dict[str, Any]]:
    """Return the OpenAPI entries for these problems and for the two that every address can answer."""
    by_status: dict[int | str, list[ProblemKind]] = {}
    for kind in (*kinds, ProblemKind.UNAVAILABLE, ProblemKind.INTERNAL):
        by_status.setdefault(kind.status, []).append(kind)
    return {
        status: {"description": " Or: ".join(kind.description for kind in same), "content": _content(same)}
        for status, same in by_status.items()
    }


def body(description: str, *media_types: tuple[str, Any]) -> dict[str, Any]:
    """Return the OpenAPI entry for a successful answer, with an example for each media type."""
    content = {name: {"example": with_marks(value)} for name, value in media_types}
    return {"description": description, "content": content}


def _content(kinds: Sequence[ProblemKind]) -> dict[str, Any]:
    samples = {
        kind.slug: {"value": problem_document(kind, kind.description, _ADDRESS, _FAULTS.get(kind, ()))}
        for kind in kinds
    }
    return {MEDIA_TYPE: {"schema": _PROBLEM_SCHEMA, "examples": samples}}
