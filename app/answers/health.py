"""Health of the service."""

from typing import Literal

from app.schemas.fields import Answer, told


class Health(Answer):
    """Whether the service lives or can take work; `checks` says what was looked at."""

    status: Literal["ok", "unavailable"] = told("Whether all is well", "ok")
    checks: dict[str, str] = told(
        "What was looked at, and how it is", {"database": "ok", "migrations": "ok", "broker": "ok"}
    )
