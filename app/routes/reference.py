"""Reference data for requests and results: conductors, ice shapes, the input fields and the result tables."""

from typing import Annotated

from fastapi import APIRouter, Query
from fastapi.responses import JSONResponse

from app.answers.reference import ConductorList, FieldList, IceShapeList, TableList, Version
from app.convert import ENGINE_VERSION
from app.export.exported_columns import all_tables
from app.http.problems import ProblemKind
from app.http.strict_routes import KnownParametersRoute
from app.owned import records
from app.reference import conductors
from app.reference.ice_shapes import ICE_SHAPES
from app.routes import documentation, reference_documentation
from app.routes.dependencies import PREFIX, CallerOf, Readers
from app.runtime.version import SERVICE_VERSION
from app.schemas import field_table
from app.schemas.fields import example_of

router = APIRouter(prefix=PREFIX, tags=["reference"], route_class=KnownParametersRoute)


@router.get(
    "/version",
    summary="Get the versions",
    response_model=Version,
    responses={200: documentation.body("The versions", ("application/json", example_of(Version)))},
)
def get_version() -> JSONResponse:
    """Return the versions of the service, of the computation and of the addresses."""
    return JSONResponse({"service": SERVICE_VERSION, "engine": ENGINE_VERSION, "api": PREFIX.removeprefix("/")})


@router.get(
    "/conductors",
    summary="Search the conductor catalogue",
    response_model=ConductorList,
    responses={
        200: documentation.body("The conductors found", ("application/json", reference_documentation.CONDUCTORS)),
        **documentation.problems(ProblemKind.INVALID_PARAMETER),
    },
)
def list_conductors(
    caller: CallerOf,
    readers: Readers,
    search: Annotated[
        str, Query(max_length=100, description="Words to find in name, designation, type or stranding, ignoring case")
    ] = "",
) -> JSONResponse:
    """List bare conductors: the owner's own, then those of the catalogue with published figures and their source."""
    with readers() as session:
        own = records.conductor_rows(session, caller.owner)
    return JSONResponse({"conductors": [row.listed() for row in conductors.search(search, own)]})


@router.get(
    "/ice-shapes",
    summary="List the ice shapes with known coefficients",
    response_model=IceShapeList,
    responses={200: documentation.body("The shapes", ("application/json", reference_documentation.ICE_SHAPES))},
)
def list_ice_shapes() -> JSONResponse:
    """List the ice shapes whose aerodynamic coefficients were read in a named source, with its gaps and caveats."""
    return JSONResponse({"ice_shapes": [shape.listed() for shape in ICE_SHAPES]})


@router.get(
    "/fields",
    summary="List the input fields",
    response_model=FieldList,
    responses={200: documentation.body("The fields", ("application/json", reference_documentation.FIELDS))},
)
def list_fields() -> JSONResponse:
    """List every field of a request with unit, bounds, default and description, generated from the schemas."""
    return JSONResponse({"fields": field_table.all_fields()})


@router.get(
    "/tables",
    summary="List the result tables",
    response_model=TableList,
    responses={200: documentation.body("The tables", ("application/json", reference_documentation.TABLES))},
)
def list_tables() -> JSONResponse:
    """List every result table with the unit and the description of each column, generated from the declarations."""
    return JSONResponse({"tables": all_tables()})
