"""Tables of measured coefficients that an owner keeps: store, list and remove them."""

from typing import Annotated, Any
from uuid import UUID

from fastapi import APIRouter, Body, Response
from fastapi.responses import JSONResponse
from sqlalchemy.orm import Session

from app.answers.owned import OwnTableList, OwnTableRow
from app.http.problems import ProblemError, ProblemKind, invalid_document
from app.http.strict_routes import StrictJsonRoute
from app.jobs import idempotency, job_records
from app.owned import records
from app.owned.records import TooMany
from app.reference.coefficient_doubts import ice_direction, table_doubts
from app.routes import documentation, own_documentation
from app.routes.dependencies import PREFIX, CallerOf, Readers, Writers
from app.routes.idempotent_posts import KEY_PROBLEMS, KeyOf, PostOutcome, run_once
from app.schemas.faults import Fault
from app.schemas.measured import OwnTable
from app.tables import OwnAerodynamics

router = APIRouter(prefix=f"{PREFIX}/aerodynamics/own", tags=["aerodynamics"], route_class=StrictJsonRoute)


@router.post(
    "",
    summary="Store an own table of coefficients",
    response_model=OwnTableRow,
    responses={
        200: {
            **documentation.body("The table as it is kept", ("application/json", own_documentation.OWN_TABLE)),
            "headers": documentation.REPLAYED_HEADER,
        },
        **documentation.problems(
            *KEY_PROBLEMS, ProblemKind.TOO_LARGE, ProblemKind.UNSUPPORTED_MEDIA_TYPE, ProblemKind.INVALID_DOCUMENT
        ),
    },
)
def store_own_table(
    document: Annotated[OwnTable, Body(openapi_examples=own_documentation.OWN_TABLE_REQUESTS)],
    caller: CallerOf,
    key: KeyOf,
    writers: Writers,
) -> Response:
    """Store a table of measured lift, drag and moment in place of the owner's table with the same name.

    A line names it as `{"catalogue": name, "angle_deg": ...}` in `ice.aerodynamics`. Slips that it shows are told:
    angles in radians, lift and drag swapped; so is the direction of the ice that the moments tell.
    """
    given = document.model_dump(mode="json", by_alias=True)

    def make(session: Session) -> PostOutcome:
        return PostOutcome(JSONResponse(_listed(records.put_aerodynamics(session, caller.owner, document.name, given))))

    try:
        return run_once(
            writers, key, lambda: idempotency.fingerprint(router.prefix, job_records.canonical(given)), make
        ).answer
    except TooMany as error:
        raise invalid_document([Fault("", "too_many", str(error))]) from error


@router.get(
    "",
    summary="List own tables of coefficients",
    response_model=OwnTableList,
    responses={200: documentation.body("The tables", ("application/json", own_documentation.OWN_TABLES))},
)
def list_own_tables(caller: CallerOf, readers: Readers) -> JSONResponse:
    """List the tables that the owner keeps, by name, with the slips that they show."""
    with readers() as session:
        rows = records.kept(session, OwnAerodynamics, caller.owner)
    return JSONResponse({"tables": [*map(_listed, rows)]})


@router.delete(
    "/{table_id}",
    summary="Remove an own table of coefficients",
    status_code=204,
    response_model=None,
    responses={204: {"description": "It is removed"}, **documentation.problems(ProblemKind.NOT_FOUND)},
)
def remove_own_table(table_id: UUID, caller: CallerOf, writers: Writers) -> Response:
    """Remove a table that the owner keeps."""
    with writers.begin() as session:
        if not records.remove(session, OwnAerodynamics, caller.owner, table_id):
            raise ProblemError(ProblemKind.NOT_FOUND, f"There is no own table {table_id}.")
    return Response(status_code=204)


def _listed(row: OwnAerodynamics) -> dict[str, Any]:
    measured = OwnTable.model_validate(row.document)
    found = [(one.angle, one.lift, one.drag, one.moment) for one in measured.table]
    return {
        "id": str(row.id),
        "created_at": row.created_at.isoformat(),
        "table": row.document,
        "doubts": table_doubts(found),
        "ice_direction_deg": ice_direction(found),
    }
