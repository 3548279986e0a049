"""Aerodynamic coefficients of a line from what was measured."""

from typing import Annotated

from fastapi import APIRouter, Body, Response
from fastapi.responses import JSONResponse

from app import convert, schemas
from app.answers.aerodynamics import FitAnswer
from app.http.problems import ProblemKind, StrictJsonRoute, invalid_document
from app.jobs import idempotency, job_records
from app.routes import documentation, reference_documentation
from app.routes.dependencies import PREFIX, Writers
from app.routes.idempotent_posts import KEY_PROBLEMS, KeyOf, PostOutcome, run_once
from app.schemas.faults import BadInput

router = APIRouter(prefix=f"{PREFIX}/aerodynamics", tags=["aerodynamics"], route_class=StrictJsonRoute)


@router.post(
    "/fit",
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
def fit(
    document: Annotated[schemas.MeasuredCoefficients, Body(openapi_examples=reference_documentation.FIT_REQUESTS)],
    key: KeyOf,
    writers: Writers,
) -> Response:
    """Fit cubics about the static angle to measured lift, drag and moment, as a line's `ice` takes them.

    Lift and drag are turned with the section: C_y = C_L cos a + C_D sin a, C_z = -C_L sin a + C_D cos a, and
    C_theta = C_M, with a in radians from the static angle.
    """
    try:
        answer = JSONResponse(convert.fit(document))
    except BadInput as error:
        raise invalid_document(error.faults) from error

    def fingerprint() -> str:
        return idempotency.fingerprint(router.prefix, job_records.canonical(document.model_dump(mode="json")))

    return run_once(writers, key, fingerprint, lambda _: PostOutcome(answer)).answer
