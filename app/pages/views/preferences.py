"""What a reader prefers, units and appearance, kept in cookies for a year."""

from fastapi import APIRouter, Request, Response

from app.http.forwarded import is_encrypted
from app.http.strict_routes import KnownParametersRoute
from app.pages.forms import Fields, local_path
from app.pages.frame import THEMES, address, moved
from app.pages.measures import BY_NAME

router = APIRouter(include_in_schema=False, route_class=KnownParametersRoute)

_YEAR_SECONDS = 365 * 24 * 3600
_CHOICES = {"units": tuple(BY_NAME), "theme": THEMES}


@router.post("/pages/preferences")
async def keep_preferences(request: Request, fields: Fields) -> Response:
    """Keep what the form says, and go back to the page on which it was."""
    answer = moved(request, local_path(fields.get("back", "/")))
    for name, choices in _CHOICES.items():
        if fields.get(name) in choices:
            keep(request, answer, name, fields[name])
    return answer


def keep(request: Request, answer: Response, name: str, choice: str) -> None:
    """Let an answer keep a preference, `units` or `theme`, in the reader's browser."""
    answer.set_cookie(
        f"galloping_{name}",
        choice,
        max_age=_YEAR_SECONDS,
        path=address(request)("/"),
        secure=is_encrypted(request.scope),
        httponly=True,
        samesite="lax",
    )
