from collections.abc import Iterator
from dataclasses import asdict, replace
from datetime import UTC, datetime
from uuid import uuid4

import pytest
from sqlalchemy.orm import Session, sessionmaker

from app.owned import records
from app.reference.conductors import named
from app.runtime.settings import Settings
from app.storage.database import make_engine, session_factory
from app.storage.migration import migrate
from app.tables import OwnAerodynamics, OwnConductor

(DRAKE,) = named("795 kcmil 26/7")
NOW = datetime(2026, 11, 1, tzinfo=UTC)


@pytest.fixture
def sessions(settings: Settings) -> Iterator[sessionmaker[Session]]:
    migrate(settings)
    engine = make_engine(settings)
    yield session_factory(engine)
    engine.dispose()


def test_owners_see_and_change_their_own_rows_only(sessions: sessionmaker[Session]) -> None:
    mine, theirs = replace(DRAKE, diameter_m=0.027), replace(DRAKE, diameter_m=0.029)
    with sessions.begin() as session:
        records.put_conductors(session, "me", [mine])
        (row,) = records.put_conductors(session, "they", [theirs])
        row_id = row.id
    with sessions.begin() as session:
        assert records.conductor_rows(session, "me") == [mine]
        assert not records.remove(session, OwnConductor, "me", row_id)
        assert not records.remove(session, OwnConductor, "they", uuid4())
        assert records.conductor_rows(session, "they") == [theirs]


def test_a_row_takes_the_place_of_the_one_with_its_name(sessions: sessionmaker[Session]) -> None:
    with sessions.begin() as session:
        records.put_conductors(session, "me", [DRAKE])
        records.put_conductors(session, "me", [replace(DRAKE, name=" drake ", mass_kg_per_m=1.7)])
        assert [row.mass_kg_per_m for row in records.conductor_rows(session, "me")] == [1.7]
        records.put_aerodynamics(session, "me", "D", {"a": 1})
        records.put_aerodynamics(session, "me", "d", {"a": 2})
        assert [row.document for row in records.kept(session, OwnAerodynamics, "me")] == [{"a": 2}]


def test_a_name_is_the_same_in_either_form_of_its_accents(sessions: sessionmaker[Session]) -> None:
    with sessions.begin() as session:
        session.add(
            OwnConductor(
                id=uuid4(), created_at=NOW, owner="me", key="a\u030ase", name="A\u030ase", figures=asdict(DRAKE)
            )
        )  # as an earlier version stored it
        records.put_conductors(session, "me", [replace(DRAKE, name="\u00c5se", mass_kg_per_m=1.7)])
        records.put_conductors(session, "me", [replace(DRAKE, name="A\u030ase", mass_kg_per_m=1.8)])
        assert [row.mass_kg_per_m for row in records.conductor_rows(session, "me")] == [1.8]


def test_an_owner_keeps_a_limited_number(sessions: sessionmaker[Session], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(records, "MOST_KEPT", 2)
    with sessions.begin() as session:
        records.put_conductors(session, "me", [DRAKE, replace(DRAKE, name="B")])
        records.put_conductors(session, "me", [replace(DRAKE, name="b")])
        with pytest.raises(records.TooMany):
            records.put_conductors(session, "me", [replace(DRAKE, name="C")])
