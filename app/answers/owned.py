"""Answers about what an owner keeps: conductors and aerodynamic tables."""

from uuid import UUID

from app.answers.reference import ConductorRow
from app.schemas.fields import Answer, described, example_of
from app.schemas.measured import OwnTable

_TABLE = {
    "name": "Our D",
    "table": [{"angle_deg": 10.0 * i, "lift": 0.1 * i, "drag": 1.2, "moment": -0.02 * i} for i in range(5)],
    "static_angle_deg": 20.0,
    "half_range_deg": 20.0,
    "reference_diameter_m": 0.0286,
    "source": "wind tunnel, report 12",
}
_ID = "01890a5d-ac96-774b-bcce-b302099a8057"


class OwnConductorRow(Answer):
    """A conductor of the owner, with what its figures contradict."""

    id: UUID = described("Identity, for removing it", _ID)
    created_at: str = described("When it was stored", "2026-07-01T09:30:00+00:00")
    conductor: ConductorRow = described("The row, in SI", example_of(ConductorRow))
    doubts: list[str] = described("Figures that the row's other figures contradict; it is kept all the same", [])


class OwnTableRow(Answer):
    """A table of measured coefficients of the owner, with the slips that it shows."""

    id: UUID = described("Identity, for removing it", _ID)
    created_at: str = described("When it was stored", "2026-07-01T09:30:00+00:00")
    table: OwnTable = described("The table, as a line's `aerodynamics` takes it", _TABLE)
    doubts: list[str] = described("Slips that the table shows; it is kept all the same", [])
    ice_direction_deg: float | None = described(
        "Where the moments have the ice point at angle 0, clockwise from straight up; null if they do not tell [deg]",
        None,
    )


class OwnTableList(Answer):
    """The owner's tables, by name."""

    tables: list[OwnTableRow] = described("The tables", [example_of(OwnTableRow)])


class OwnConductorList(Answer):
    """The owner's conductors, by name."""

    conductors: list[OwnConductorRow] = described("The rows", [example_of(OwnConductorRow)])


class StoredConductors(OwnConductorList):
    """The conductors that a sheet stored, and how it was read."""

    notes: list[str] = described("How the text was read", ["Cells are separated by semicolons."])
