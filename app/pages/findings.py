"""What a finished job found at one of its points, gathered once for all parts of its page."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sqlalchemy.orm import Session

from app.http.problems import ProblemError, ProblemKind
from app.routes.results import request_of_point
from app.storage import stored_results
from app.tables import Job

Row = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Findings:
    """A point of a job: its place among all points, the line, the analysis, the tables, and how it failed if it did."""

    point: int
    points: Sequence[Row]
    line: Row
    analysis: Row
    tables: Mapping[str, Sequence[Row]]

    @property
    def here(self) -> Row:
        """Return static state, warnings and failure of the point."""
        return next(point for point in self.points if point["point"] == self.point)

    @property
    def line_here(self) -> Row:
        """Return the line of the point: that of the request with the values of the study's axes."""
        axes = self.here["axes"]
        return with_axes(self.line, axes) if isinstance(axes, dict) and axes else self.line

    def rows(self, table: str) -> Sequence[Row]:
        """Return the rows of a table; none where results of an earlier version lack it."""
        return self.tables.get(table, ())

    @property
    def verdict(self) -> Row | None:
        """Return the verdict, None where the point failed or an earlier version gave none."""
        return next(iter(self.rows("verdict")), None)


def findings(session: Session, job: Job, point: int) -> Findings | None:
    """Return what a job found at a point, None if it ended without a result.

    Raises
    ------
    ProblemError
        404 if the job has results, but not at this point.
    """
    points = list(stored_results.points(session, job.id))
    if not points:
        return None
    tables = stored_results.tables_of_point(session, job.id, point)
    if tables is None:
        raise ProblemError(ProblemKind.NOT_FOUND, f"The job has no results at point {point}.")
    request, _ = request_of_point(session, job, point)
    return Findings(point, points, request.get("line") or {}, request.get("analysis") or {}, tables)


def with_axes(line: Mapping[str, Any], axes: Mapping[str, Any]) -> dict[str, Any]:
    """Return a line with the values of a study's axes at their dotted paths; paths through lists stay as they are."""
    made: dict[str, Any] = json.loads(json.dumps(line))
    for dotted, value in axes.items():
        *outer, last = dotted.split(".")
        part: Any = made
        for name in outer:
            part = part.get(name) if isinstance(part, dict) else None
        if isinstance(part, dict):
            part[last] = value
    return made
