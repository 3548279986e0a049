"""Fit aerodynamic coefficients of a line to measured coefficients."""

from typing import Annotated

from fastapi import APIRouter, Body, Response
from fastapi.responses import JSONResponse

from app import convert, schemas
from app.answers.aerodynamics import FitAnswer
from app.http.problems import ProblemKind, invalid_document
from app.http.strict_routes import StrictJsonRoute
from app.jobs import idempotency, job_records
from app.routes import documentation, reference_documentation
from app.routes.dependencies import PREFIX, Writers
from app.routes.idempotent_posts import KEY_PROBLEMS, KeyOf, PostOutcome, run_once
from app.schemas.faults import BadInput

router = APIRouter(prefix=f"{PREFIX}/aerodynamics", tags=["aerodynamics"], route_class=StrictJsonRoute)


@router.post(
    "/fit",
    summary="Fit measured coefficients",
    response_model=FitAnswer,
    responses={
        200: {
            **documentation.body("The fit", ("application/json", reference_documentation.FIT)),
            "headers": documentation.REPLAYED_HEADER,
        },
        **documentation.problems(
            *KEY_PROBLEMS, ProblemKind.TOO_LARGE, ProblemKind.UNSUPPORTED_MEDIA_TYPE, ProblemKind.INVALID_DOCUMENT
        ),
    },
)
def fit_coefficients(
    document: Annotated[schemas.MeasuredCoefficients, Body(openapi_examples=reference_documentation.FIT_REQUESTS)],
    key: KeyOf,
    writers: Writers,
) -> Response:
    """Fit cubics about the static angle to measured lift, drag and moment, in the form of a line's `ice`.

    Lift and drag are turned into the section's axes: C_y = C_L cos a + C_D sin a, C_z = -C_L sin a + C_D cos a, and
    C_theta = C_M, with a in radians from the static angle.
    """
    try:
        answer = JSONResponse(convert.fit(document))
    except BadInput as error:
        raise invalid_document(error.faults) from error

    def fingerprint() -> str:
        return idempotency.fingerprint(router.prefix, job_records.canonical(document.model_dump(mode="json")))

    return run_once(writers, key, fingerprint, lambda _: PostOutcome(answer)).answer
