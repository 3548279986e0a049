"""OpenAPI examples and bodies of what an owner keeps."""

from typing import Any

from app.answers.owned import OwnConductorRow
from app.answers.reference import ConductorRow
from app.schemas.fields import example_of

_CONDUCTOR = example_of(ConductorRow) | {"source": "own row", "source_address": None, "licence": None, "own": True}
_ROW = example_of(OwnConductorRow) | {"conductor": _CONDUCTOR}

LISTED: dict[str, Any] = {"conductors": [_ROW]}
STORED: dict[str, Any] = {"conductors": [_ROW], "notes": ["read as UTF-8, cells apart by semicolons"]}
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
