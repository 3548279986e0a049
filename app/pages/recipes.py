"""The request of a job as others can repeat it: as curl, as Python, and as the document itself."""

import json
import pprint
from dataclasses import dataclass
from typing import Any

from app.tables import Job


@dataclass(frozen=True, slots=True)
class Recipes:
    """A request in three forms."""

    curl: str
    python: str
    document: str


def recipes(job: Job, service: str, *, with_key: bool) -> Recipes:
    """Return what submits the request of a job to the service at an address, without its estimates written out."""
    document = json.dumps(said(job.document), indent=1, ensure_ascii=False)
    bearer = '  -H "Authorization: Bearer $GALLOPING_KEY" \\\n' if with_key else ""
    curl = (
        f"curl -X POST {service}/v1/jobs \\\n  -H 'Content-Type: application/json' \\\n{bearer}"
        f"  --data-binary @- <<'END'\n{document}\nEND"
    )
    literal = pprint.pformat(said(job.document), width=100, sort_dicts=False)
    python = (
        f"from galloping import Client\n\nrequest = {literal}\n"
        f"with Client({service!r}) as service:  # GALLOPING_KEY holds the key, where the service wants one\n"
        "    result = service.analyse(**request)\n"
        "    print(result.verdict)"
    )
    return Recipes(curl, python, document)


def said(document: dict[str, Any]) -> dict[str, Any]:
    """Return a request as it was said: a line that was resolved in the form in which the engineer knew it."""
    known, rest = document.get("known"), {name: value for name, value in document.items() if name != "known"}
    found: dict[str, Any] = without_nulls({**rest, "line": known["line"]} if known else rest)
    return found


def without_nulls(value: Any) -> Any:
    """Return a document without the fields that say nothing."""
    if isinstance(value, dict):
        return {name: without_nulls(inner) for name, inner in value.items() if inner is not None}
    return [without_nulls(item) for item in value] if isinstance(value, list) else value
