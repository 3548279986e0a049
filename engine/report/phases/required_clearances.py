"""The distance that two phases must keep, and whether they do."""

from typing import TypedDict

from engine.spec import Line


class Judged(TypedDict):
    """The columns of a row of clearances that judge it."""

    distance_m: float | None
    required_m: float | None
    margin_m: float | None
    ok: bool | None
    overlap_m: float | None


def required_between(line: Line, one: str, other: str) -> float | None:
    """Return the distance that two phases must keep [m]: the larger of their own, else that of the line."""
    own = [phase.required_clearance for phase in line.phases if phase.name in (one, other)]
    return max((value for value in own if value is not None), default=line.required_clearance)


def judged(distance: float | None, required: float | None) -> Judged:
    """Return distance, required distance, margin, whether it is kept, and the overlap of envelopes."""
    margin = None if distance is None or required is None else distance - required
    return {
        "distance_m": distance,
        "required_m": required,
        "margin_m": margin,
        "ok": None if margin is None else margin >= 0.0,
        "overlap_m": None if distance is None else max(0.0, -distance),
    }
