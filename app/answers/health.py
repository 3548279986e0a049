"""Health of the service."""

from typing import Literal

from app.schemas.fields import Answer, described


class Health(Answer):
    """Health of the service, with the state of each part in `checks`."""

    status: Literal["ok", "unavailable"] = described("Health of the whole service", "ok")
    checks: dict[str, str] = described(
        "State of each part of the service", {"database": "ok", "migrations": "ok", "broker": "ok"}
    )
