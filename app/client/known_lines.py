"""What lines as engineers know them may name, and what follows from them: the addresses of catalogues and resolving."""

import json
from collections.abc import Mapping
from typing import Any, Literal, TypeVar
from uuid import UUID

import httpx
from pydantic import BaseModel

from app.answers.aerodynamics import FitAnswer
from app.answers.lines import ResolvedLine
from app.answers.owned import OwnConductorList, OwnConductorRow, OwnTableList, OwnTableRow, StoredConductors
from app.answers.reference import ConductorList, ConductorRow, IceShapeList, IceShapeRow
from app.client.connection import Connection
from app.client.uploads import as_json
from app.schemas.known import KnownLine
from app.schemas.measured import OwnTable

Model = TypeVar("Model", bound=BaseModel)
Kept = Literal["conductors", "aerodynamics"]


class KnownLines:
    """The part of the client that knows catalogues; `Client` has all of its methods."""

    _connection: Connection

    def resolve(self, line: KnownLine | Mapping[str, Any]) -> ResolvedLine:
        """Return the explicit line of what is known, and where each of its values came from."""
        return self._answered(ResolvedLine, "/v1/lines/resolve", as_json(line))

    def conductors(self, search: str = "") -> list[ConductorRow]:
        """Return the conductors whose name, designation, type or stranding contain all words: own ones first."""
        address = str(httpx.URL("/v1/conductors", params={"search": search}))
        return self._read(ConductorList, address).conductors

    def ice_shapes(self) -> list[IceShapeRow]:
        """Return the ice shapes whose coefficients were read in a named source."""
        return self._read(IceShapeList, "/v1/ice-shapes").ice_shapes

    def fit(self, table: Mapping[str, Any]) -> FitAnswer:
        """Return the coefficients of a measured table, as `POST /v1/aerodynamics/fit` takes it."""
        return self._answered(FitAnswer, "/v1/aerodynamics/fit", table)

    def own_conductors(self) -> list[OwnConductorRow]:
        """Return the conductors that the owner keeps."""
        return self._read(OwnConductorList, "/v1/conductors/own").conductors

    def store_conductors(self, sheet: str | bytes) -> StoredConductors:
        """Store the conductors of a CSV with declared units, all of them or, with a fault, none."""
        raw = sheet.encode() if isinstance(sheet, str) else sheet
        answer = self._connection.post("/v1/conductors/own", lambda: raw, {"Content-Type": "text/csv"})
        return self._connection.read(StoredConductors, answer)

    def own_tables(self) -> list[OwnTableRow]:
        """Return the tables of measured coefficients that the owner keeps."""
        return self._read(OwnTableList, "/v1/aerodynamics/own").tables

    def store_table(self, table: OwnTable | Mapping[str, Any]) -> OwnTableRow:
        """Store a table of measured coefficients, in place of the owner's one of the same name."""
        return self._answered(OwnTableRow, "/v1/aerodynamics/own", as_json(table))

    def remove_own(self, kind: Kept, row_id: UUID | str) -> None:
        """Remove a conductor or a table that the owner keeps."""
        self._connection.delete(f"/v1/{kind}/own/{row_id}")

    def _read(self, model: type[Model], address: str) -> Model:
        return self._connection.read(model, self._connection.get(address))

    def _answered(self, model: type[Model], address: str, document: Mapping[str, Any]) -> Model:
        text = json.dumps(document).encode()
        return self._connection.read(
            model, self._connection.post(address, lambda: text, {"Content-Type": "application/json"})
        )
