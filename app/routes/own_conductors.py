"""Conductors that an owner keeps: store them from a spreadsheet, list and remove them."""

import hashlib
from typing import Annotated, Any
from uuid import UUID

from fastapi import APIRouter, Depends, Request, Response
from fastapi.responses import JSONResponse
from sqlalchemy.orm import Session

from app.answers.owned import OwnConductorList, StoredConductors
from app.http.beside_loop import beside_loop
from app.http.problems import ProblemError, ProblemKind, invalid_document
from app.http.strict_routes import KnownParametersRoute
from app.jobs import idempotency
from app.owned import records
from app.owned.conductor_sheets import MOST_READ, read_conductors
from app.owned.records import TooMany
from app.owned.spreadsheets import read_sheet
from app.reference.conductor_doubts import doubts
from app.routes import documentation, own_documentation
from app.routes.dependencies import PREFIX, CallerOf, Readers, Writers
from app.routes.idempotent_posts import KEY_PROBLEMS, KeyOf, PostOutcome, run_once
from app.schemas.faults import BadInput, Fault
from app.tables import OwnConductor

router = APIRouter(prefix=f"{PREFIX}/conductors/own", tags=["reference"], route_class=KnownParametersRoute)


async def _sheet(request: Request) -> bytes:
    media_type = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if media_type != "text/csv":
        detail = f"The body is {media_type[:100]!r}, not text/csv."
        raise ProblemError(ProblemKind.UNSUPPORTED_MEDIA_TYPE, detail, headers={"Accept-Post": "text/csv"})
    return await request.body()


@router.post(
    "",
    summary="Store own conductors from a spreadsheet",
    response_model=StoredConductors,
    responses={
        200: {
            **documentation.body("The rows as they are kept", ("application/json", own_documentation.STORED)),
            "headers": documentation.REPLAYED_HEADER,
        },
        **documentation.problems(
            *KEY_PROBLEMS, ProblemKind.TOO_LARGE, ProblemKind.UNSUPPORTED_MEDIA_TYPE, ProblemKind.INVALID_DOCUMENT
        ),
    },
    openapi_extra=own_documentation.SHEET_BODY,
)
async def store_conductors(
    request: Request, raw: Annotated[bytes, Depends(_sheet)], caller: CallerOf, key: KeyOf, writers: Writers
) -> Response:
    """Store the conductors of a CSV, in place of the owner's rows with the same names; with a fault, store none.

    The first row names the columns; units stand there, `diameter [mm]`, or in a second row. Own rows precede the
    shipped ones of the same name wherever a conductor is looked up.
    """

    def make(session: Session) -> PostOutcome:
        sheet = read_sheet(raw, MOST_READ)
        rows = records.put_conductors(session, caller.owner, read_conductors(sheet))
        return PostOutcome(JSONResponse({"conductors": [*map(_listed, rows)], "notes": list(sheet.notes)}))

    def fingerprint() -> str:
        return idempotency.fingerprint(router.prefix, hashlib.sha256(raw).hexdigest())

    try:
        made = await beside_loop(request, lambda: run_once(writers, key, fingerprint, make))
    except BadInput as error:
        raise invalid_document(error.faults) from error
    except TooMany as error:
        raise invalid_document([Fault("", "too_many", str(error))]) from error
    return made.answer


@router.get(
    "",
    summary="List own conductors",
    response_model=OwnConductorList,
    responses={200: documentation.body("The rows", ("application/json", own_documentation.LISTED))},
)
def list_own_conductors(caller: CallerOf, readers: Readers) -> JSONResponse:
    """List the conductors that the owner keeps, by name, with what their figures contradict."""
    with readers() as session:
        rows = records.kept(session, OwnConductor, caller.owner)
    return JSONResponse({"conductors": [*map(_listed, rows)]})


@router.delete(
    "/{conductor_id}",
    summary="Remove an own conductor",
    status_code=204,
    response_model=None,
    responses={204: {"description": "It is removed"}, **documentation.problems(ProblemKind.NOT_FOUND)},
)
def remove_conductor(conductor_id: UUID, caller: CallerOf, writers: Writers) -> Response:
    """Remove a conductor that the owner keeps."""
    with writers.begin() as session:
        if not records.remove(session, OwnConductor, caller.owner, conductor_id):
            raise ProblemError(ProblemKind.NOT_FOUND, f"There is no own conductor {conductor_id}.")
    return Response(status_code=204)


def _listed(row: OwnConductor) -> dict[str, Any]:
    conductor = records.catalogue_row(row)
    return {
        "id": str(row.id),
        "created_at": row.created_at.isoformat(),
        "conductor": conductor.listed(),
        "doubts": doubts(conductor),
    }
