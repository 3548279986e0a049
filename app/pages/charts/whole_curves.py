"""Curves from the onset on for a job that did not ask for them, computed when its page is read and never stored."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from app.interactive import Busy, Previews, TakesTooLong
from app.pages.findings import Findings
from app.pages.what_if.documents import ties_phases
from app.pages.wording import words

_LEFT_OUT = {"uncertainty": {"samples": 0}, "check": "none", "risk": False}
_MODEL = "hybrid"  # some 25 ms a line; the finite element model takes a second or more
_ELSEWHERE = ("study", "placement")  # the line that was analysed is not that of the request


async def with_whole_curves(
    previews: Previews, owner: str, document: Mapping[str, Any], found: Findings
) -> tuple[Findings, str | None]:
    """Return findings with the hybrid model's curves, and a sentence where they are not what the job asked for.

    Parameters
    ----------
    previews : Previews
        Computes them, in its bounds.
    owner : str
    document : mapping
        The request of the job.
    found : Findings
        Returned as it is where the job asked for curves, or nothing begins to move.
    """
    said = words().curves
    if found.analysis.get("amplitude_curves") == "reported" or not found.rows("critical_wind_speeds"):
        return found, None
    models = found.analysis.get("models") or ()
    if _MODEL not in models or ties_phases(found.line) or any(document.get(name) for name in _ELSEWHERE):
        return found, said.not_whole
    asked = {"models": [_MODEL], "amplitude_curves": "reported", "loop_competition": "neglected"}
    analysis = {**found.analysis, **_LEFT_OUT, **asked, "device_effect": "neglected"}
    try:
        result = await previews.compute(owner, {"line": found.line, "analysis": analysis})
    except (Busy, TakesTooLong, ArithmeticError, ValueError):
        return found, said.not_whole
    tables = {**found.tables, "amplitude_curves": result.tables["amplitude_curves"]}
    return replace(found, tables=tables), said.one_whole if len(models) > 1 else None
