"""Answers about what an owner keeps: conductors and aerodynamic tables."""

from uuid import UUID

from app.answers.reference import ConductorRow
from app.schemas.fields import Answer, described, example_of

_ID = "01890a5d-ac96-774b-bcce-b302099a8057"


class OwnConductorRow(Answer):
    """A conductor of the owner, with what its figures contradict."""

    id: UUID = described("Identity, for removing it", _ID)
    created_at: str = described("When it was stored", "2026-07-01T09:30:00+00:00")
    conductor: ConductorRow = described("The row, in SI", example_of(ConductorRow))
    doubts: list[str] = described("Figures that the row's other figures contradict; it is kept all the same", [])


class OwnConductorList(Answer):
    """The owner's conductors, by name."""

    conductors: list[OwnConductorRow] = described("The rows", [example_of(OwnConductorRow)])


class StoredConductors(OwnConductorList):
    """The conductors that a sheet stored, and how it was read."""

    notes: list[str] = described("How the text was read", ["read as UTF-8, cells apart by semicolons"])
