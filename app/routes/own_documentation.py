"""OpenAPI examples and bodies of what an owner keeps, and of lines as engineers know them."""

from typing import Any

from app.answers.lines import ResolvedLine
from app.answers.owned import OwnConductorRow, OwnTableRow
from app.answers.reference import ConductorRow
from app.schemas.fields import example_of

_CONDUCTOR = example_of(ConductorRow) | {"source": "own row", "source_address": None, "licence": None, "own": True}
_ROW = example_of(OwnConductorRow) | {"conductor": _CONDUCTOR}

LISTED: dict[str, Any] = {"conductors": [_ROW]}
STORED: dict[str, Any] = {"conductors": [_ROW], "notes": ["Cells are separated by semicolons."]}
SHEET = (
    "name;type;stranding;area [mm2];diameter [mm];mass [kg/km];rated strength [kN];modulus [GPa];expansion [1e-6/K]\n"
    "Own Drake;ACSR;26/7;468,5;28,11;1628;140,1;74;18,9\n"
)
SHEET_BODY: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "content": {"text/csv": {"schema": {"type": "string"}, "example": SHEET}},
    }
}

_KEPT = example_of(OwnTableRow)
OWN_TABLE: dict[str, Any] = _KEPT
OWN_TABLES: dict[str, Any] = {"tables": [_KEPT]}
OWN_TABLE_REQUESTS: dict[str, Any] = {"our-d": {"summary": "A table to name in lines", "value": _KEPT["table"]}}

KNOWN_LINE: dict[str, Any] = {
    "name": "twin Drake, 300 m",
    "conductor": {"catalogue": "Drake"},
    "bundle": {"subconductors": 2, "spacing_m": 0.457, "arrangement": "horizontal"},
    "span": {
        "length_m": 304.8,
        "temperature_c": -5.0,
        "everyday": {"temperature_c": 15.0, "share_of_rated_strength": 0.2},
    },
    "ice": {
        "accretion": {"shape": "crescent", "thickness_m": 0.012, "kind": "glaze"},
        "aerodynamics": {"catalogue": "c11-40"},
    },
}
KNOWN_LINES: dict[str, Any] = {
    "twin-drake": {"summary": "What a utility knows of a twin Drake under 12 mm of glaze", "value": KNOWN_LINE}
}
KNOWN_REQUESTS: dict[str, Any] = {
    "known-twin-drake": {
        "summary": "A line as an engineer knows it, with 64 samples of what is assumed",
        "value": {
            "line": KNOWN_LINE,
            "analysis": {
                "models": ["hybrid"],
                "wind_speeds_m_per_s": [4.0, 10.0],
                "uncertainty": {"samples": 64, "seed": 1},
            },
        },
    }
}
RESOLVED: dict[str, Any] = example_of(ResolvedLine)
