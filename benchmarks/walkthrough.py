"""Run the request of the walk through docs/guide.md, and write what the command prints below it."""

import contextlib
import io
import json
import re
from pathlib import Path
from typing import Any

from app import convert
from app.cli.lines import result_document
from app.cli.report import print_report

PAGE = Path(__file__).parents[1] / "docs" / "guide.md"
BEGIN, END = "<!-- walkthrough -->", "<!-- end -->"


def request_of(page: str) -> dict[str, Any]:
    """Return the first request of the page."""
    found = re.search(r"```json\n(.*?)```", page, re.DOTALL)
    assert found is not None, "the walk begins with a request"
    document: dict[str, Any] = json.loads(found[1])
    return document


def printed(request: dict[str, Any]) -> str:
    """Return what `galloping analyse` prints of a request on a wide terminal."""
    complete = convert.read(convert.explicit_request(request)).kept()
    points = [item for item in convert.run(complete) if isinstance(item, convert.PointResult)]
    text = io.StringIO()
    with contextlib.redirect_stdout(text):
        print_report(result_document(complete, points))
    return "\n".join(line.rstrip() for line in text.getvalue().splitlines())


def with_output(page: str) -> str:
    """Return the page with the output of its request."""
    before, rest = page.split(BEGIN, 1)
    _, after = rest.split(END, 1)
    return f"{before}{BEGIN}\n```text\n{printed(request_of(page))}\n```\n{END}{after}"


if __name__ == "__main__":
    PAGE.write_text(with_output(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
