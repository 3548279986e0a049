"""Rank the lines of a batch by amplitude, by margin of the critical wind speed, or by clearance between phases."""

import math
from typing import Annotated, Any, Literal, Self
from urllib.parse import urlencode
from uuid import UUID

from fastapi import APIRouter, Query
from pydantic import BaseModel, ConfigDict, Field
from sqlalchemy import Row

from app.answers.batches import RankingPage
from app.batches import ranking
from app.batches.ranking import Order, Place
from app.http import paging
from app.http.prefix import LinkedJSON
from app.http.problems import ProblemKind, query_fault
from app.http.strict_routes import KnownParametersRoute
from app.routes import batch_documentation, documentation
from app.routes.batch_status import batch_address, require_results
from app.routes.dependencies import PREFIX, CallerOf, Readers, SettingsOf
from app.runtime.signing import signing_key
from app.storage.stored_results import ranking_columns

router = APIRouter(prefix=f"{PREFIX}/batches/{{batch_id}}", tags=["batches"], route_class=KnownParametersRoute)

_CRITICAL, _HEIGHT, _WIDTH = "lowest_critical_wind_speed_m_per_s", "largest_height_m", "largest_width_m"
Spacing = Annotated[float | None, Field(gt=0.0, le=100.0)]


class RankingQuery(BaseModel):
    """The figure by which to rank the lines, and where the page begins."""

    model_config = ConfigDict(extra="forbid")

    by: Literal["amplitude", "critical-wind-margin", "clearance", "risk"] = Field(
        default="amplitude",
        description="`amplitude`: largest vertical amplitude first. `critical-wind-margin`: smallest margin of the "
        "critical wind speed first. `clearance`: smallest clearance first. `risk`: most hours of galloping a year "
        "first, hours of which nothing is known among them",
    )
    design_wind_speed_m_per_s: Annotated[float | None, Field(ge=0.0, le=100.0)] = Field(
        default=None, description="Required by the margin, which is the critical minus this design wind speed [m/s]"
    )
    vertical_spacing_m: Spacing = Field(
        default=None, description="For the clearance: vertical distance between two phases [m]"
    )
    horizontal_spacing_m: Spacing = Field(
        default=None,
        description="For the clearance instead: horizontal distance between two phases, which gallop alike [m]",
    )
    partial: bool = Field(default=False, description="Rank the lines finished so far, even if others still wait or run")
    limit: int = Field(default=50, ge=1, le=500, description="Lines on a page")
    cursor: str | None = Field(default=None, max_length=200, description="Cursor from a `next` address")

    def checked(self) -> Self:
        """Return the query if it has exactly the parameters that its figure needs.

        Raises
        ------
        ProblemError
            400 otherwise.
        """
        spacings = (self.vertical_spacing_m is not None) + (self.horizontal_spacing_m is not None)
        if (self.design_wind_speed_m_per_s is not None) != (self.by == "critical-wind-margin"):
            raise query_fault("design_wind_speed_m_per_s", "must be given with by=critical-wind-margin, and only then")
        if spacings != (self.by == "clearance"):
            rule = "give exactly one of vertical_spacing_m and horizontal_spacing_m with by=clearance, and only then"
            raise query_fault("vertical_spacing_m", rule)
        return self

    def order(self) -> Order:
        """Return the order that puts the most critical line first."""
        if self.by == "amplitude":
            return Order("largest_vertical_m", descending=True)
        if self.by == "critical-wind-margin":
            return Order(_CRITICAL, descending=False)
        if self.by == "risk":
            return Order("galloping_hours_a_year", descending=True)
        return Order(_HEIGHT if self.vertical_spacing_m is not None else _WIDTH, descending=True)


@router.get(
    "/ranking",
    summary="Rank the lines of a batch",
    response_model=RankingPage,
    responses={
        200: documentation.body("A page of lines", ("application/json", batch_documentation.RANKING)),
        **documentation.problems(ProblemKind.INVALID_PARAMETER, ProblemKind.NOT_FOUND, ProblemKind.NOT_READY),
    },
)
def rank_lines(
    batch_id: UUID,
    ranking_query: Annotated[RankingQuery, Query()],
    caller: CallerOf,
    readers: Readers,
    settings: SettingsOf,
) -> LinkedJSON:
    """Return one page of the lines, most critical first; `next` is the address of the next page.

    A line whose motion is unknown or unbounded at any wind speed comes first by amplitude and clearance, with
    `unknown_motions`; one that is unstable without wind comes first by margin. Left out are lines without a critical
    wind speed up to the limit (by margin), lines without a climate (by risk), lines analysed without wind speeds
    (otherwise), and failed ones, which the status of the batch counts.
    """
    query, key = ranking_query.checked(), signing_key(settings)
    order = query.order()
    after = _place(key, batch_id, order, query.cursor)
    require_results(readers, caller, batch_id, partial=query.partial)
    with readers() as session:
        found = ranking.page(session, batch_id, order, after, query.limit + 1)
    before = after.rank if after else 0
    lines = [_line(query, before + i, row) for i, row in enumerate(found[: query.limit], start=1)]
    following = None
    if len(found) > query.limit:
        last = found[query.limit - 1]
        place = Place(getattr(last, order.figure), last.number, before + query.limit)
        following = _next_address(batch_id, query, ranking.encode(key, batch_id, order, place))
    return LinkedJSON({"lines": lines, "next": following})


def _line(query: RankingQuery, rank: int, row: Row[Any]) -> dict[str, Any]:
    margin = clearance = None
    if query.design_wind_speed_m_per_s is not None:
        margin = row.lowest_critical_wind_speed_m_per_s - query.design_wind_speed_m_per_s
    if query.vertical_spacing_m is not None:
        clearance = _left(query.vertical_spacing_m, row.largest_height_m)
    elif query.horizontal_spacing_m is not None:
        clearance = _left(query.horizontal_spacing_m, row.largest_width_m)
    return {
        "rank": rank,
        **{name: getattr(row, name) for name in ("number", "reference", "asset_id")},
        **ranking_columns(row),
        "margin_m_per_s": margin,
        "clearance_m": clearance,
    }


def _left(spacing: float, taken: float) -> float | None:
    """Return what a motion leaves of the spacing [m], None where the motion is unknown."""
    return None if math.isinf(taken) else spacing - taken


def _place(key: bytes, batch_id: UUID, order: Order, cursor: str | None) -> Place | None:
    try:
        return ranking.decode(key, batch_id, order, cursor) if cursor else None
    except paging.BadCursor as error:
        raise query_fault("cursor", str(error)) from error


def _next_address(batch_id: UUID, query: RankingQuery, cursor: str) -> str:
    parameters = query.model_dump(exclude_unset=True, exclude={"cursor"})
    return f"{batch_address(batch_id)}/ranking?{urlencode({**parameters, 'cursor': cursor})}"
