"""Run the requests of the walk through docs/guide.md, and write what the commands print below them."""

import contextlib
import io
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from app import convert
from app.cli.lines import result_document
from app.cli.remedies import print_remedies
from app.cli.report import print_report

PAGE = Path(__file__).parents[1] / "docs" / "guide.md"
BEGIN, END = "<!-- walkthrough -->", "<!-- end -->"
TRIED, BEGIN_REMEDIES, END_REMEDIES = "<!-- remedies request -->", "<!-- remedies -->", "<!-- end of remedies -->"


def request_of(page: str) -> dict[str, Any]:
    """Return the first request of the page."""
    found = re.search(r"```json\n(.*?)```", page, re.DOTALL)
    assert found is not None, "the walk begins with a request"
    document: dict[str, Any] = json.loads(found[1])
    return document


def printed(request: dict[str, Any], show: Callable[[Any], None] = print_report) -> str:
    """Return what `galloping analyse`, or another command that shows a result, prints of a request when not cut off."""
    complete = convert.read(convert.explicit_request(request)).kept()
    points = [item for item in convert.run(complete) if isinstance(item, convert.PointResult)]
    text = io.StringIO()
    with contextlib.redirect_stdout(text):
        show(result_document(complete, points))
    return "\n".join(line.rstrip() for line in text.getvalue().splitlines())


def with_output(page: str) -> str:
    """Return the page with the output of its requests."""
    request = request_of(page)
    tried = request_of(page.split(TRIED, 1)[1])
    page = _between(page, BEGIN, END, printed(request))
    return _between(page, BEGIN_REMEDIES, END_REMEDIES, printed({**request, "remedies": tried}, print_remedies))


def _between(page: str, begin: str, end: str, text: str) -> str:
    before, rest = page.split(begin, 1)
    _, after = rest.split(end, 1)
    return f"{before}{begin}\n```text\n{text}\n```\n{end}{after}"


if __name__ == "__main__":
    PAGE.write_text(with_output(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
