"""A request whose result has every part that a page can show."""

from typing import Any

from app.pages import examples


def known_request() -> dict[str, Any]:
    """Return a short request of a line with assumptions and a phase above it."""
    line = {**examples.line(examples.DRAKE), "phases": [{"name": "top", "y_m": 7.0, "z_m": 0.0}]}
    analysis = {
        **examples.ANALYSIS,
        "loops": [1],
        "models": ["hybrid"],
        "wind_speeds_m_per_s": [4.0, 8.0],
        "uncertainty": {"samples": 8, "seed": 1},
    }
    return {"line": {**line, "required_clearance_m": 1.5}, "analysis": analysis}
