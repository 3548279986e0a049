from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

import pytest
from sqlalchemy import select, text
from sqlalchemy.orm import Session, sessionmaker

from app.runtime.settings import Settings
from app.security import keys
from app.security.caller import Scope
from app.security.keys import NotOneKey
from app.tables import ApiKey, AuditAction, AuditEvent
from tests.app import service
from tests.statements import counted


def make(sessions: sessionmaker[Session], owner: str = "acme", expires_at: datetime | None = None) -> str:
    with sessions.begin() as session:
        return keys.create(session, owner, [Scope.SUBMIT, Scope.READ], "SCADA", expires_at)[1]


def test_only_the_hash_of_a_key_is_kept(sessions: sessionmaker[Session]) -> None:
    key = make(sessions)
    assert len(key.removeprefix("galloping_")) == 48  # hexadecimal digits of 192 bits
    with sessions() as session:
        row = session.execute(text("SELECT * FROM api_keys")).mappings().one()
    assert not any(key in str(value) for value in row.values())
    assert row["prefix"] == key[:18]  # 160 bits stay unknown
    assert row["digest"] == keys.digest_of(key)
    assert len({make(sessions) for _ in range(20)}) == 20


def test_a_key_is_looked_up_by_an_index_on_its_hash(sessions: sessionmaker[Session]) -> None:
    make(sessions)
    asked = str(select(ApiKey).where(ApiKey.digest == "x").compile(compile_kwargs={"literal_binds": True}))
    with sessions() as session:
        if session.get_bind().dialect.name == "sqlite":
            plan = " ".join(row.detail for row in session.execute(text(f"EXPLAIN QUERY PLAN {asked}")))
            assert "USING INDEX" in plan
        else:
            session.execute(text("SET enable_seqscan = off"))
            assert "uq_api_keys_digest" in " ".join(session.scalars(text(f"EXPLAIN {asked}")))


def test_a_good_key_says_whose_it_is(sessions: sessionmaker[Session]) -> None:
    key = make(sessions)
    with sessions() as session:
        caller, use_to_record = keys.look_up(session, keys.digest_of(key))
        assert caller is not None
        assert (caller.owner, caller.scopes) == ("acme", frozenset({Scope.READ, Scope.SUBMIT}))
        assert use_to_record
        assert keys.look_up(session, keys.digest_of(key + "0")) == (None, False)


@dataclass(frozen=True)
class Kinds:
    """Texts of keys by what they are."""

    good: str
    revoked: str
    expired: str
    unknown: str = "galloping_" + "0" * 48
    none: str = "x"

    @property
    def near(self) -> str:
        """Return the good key but for its last character."""
        return self.good[:-1] + ("0" if self.good[-1] != "0" else "1")

    def refused(self) -> list[str]:
        """Return all that are not good."""
        return [self.revoked, self.expired, self.unknown, self.none, self.near]


def kinds(sessions: sessionmaker[Session]) -> Kinds:
    """Make keys whose use was recorded just now."""
    made = Kinds(make(sessions), make(sessions), make(sessions, expires_at=datetime.now(UTC) - timedelta(seconds=1)))
    with sessions.begin() as session:
        keys.revoke(session, made.revoked)
        for key in (made.good, made.revoked, made.expired):
            keys.record_use(session, keys.digest_of(key))
    return made


def test_a_key_is_looked_up_in_the_same_way_whatever_it_is(sessions: sessionmaker[Session]) -> None:
    made = kinds(sessions)
    asked: dict[str, list[str]] = {}
    for key in (made.good, *made.refused()):
        with sessions() as session, counted() as statements:
            caller, use_to_record = keys.look_up(session, keys.digest_of(key))
        asked[key] = statements
        assert (caller is not None, use_to_record) == (key == made.good, False)
    assert {tuple(statements) for statements in asked.values()} == {tuple(asked[made.good])}
    assert sum("WHERE api_keys.digest = " in statement for statement in asked[made.good]) == 1


def test_refusals_take_the_same_way_and_say_the_same(settings: Settings, sessions: sessionmaker[Session]) -> None:
    made = kinds(sessions)
    with service.running(settings) as client:
        client.get("/v1/fields", headers={"Authorization": f"Bearer {made.good}"}).raise_for_status()
        seen = set()
        for key in [*made.refused(), *made.refused()]:
            with counted() as statements:
                answer = client.get("/v1/fields", headers={"Authorization": f"Bearer {key}"})
            told = {name: value for name, value in answer.headers.items() if name not in {"date", "x-request-id"}}
            seen.add((answer.status_code, answer.content, str(told), tuple(statements)))
    ((status, _, _, statements_of_all),) = seen
    assert status == 401
    assert statements_of_all


def test_use_is_recorded_now_and_then(sessions: sessionmaker[Session]) -> None:
    digest = keys.digest_of(make(sessions))
    with sessions.begin() as session:
        keys.record_use(session, digest)
    with sessions.begin() as session:
        assert keys.look_up(session, digest)[1] is False
        session.execute(text("UPDATE api_keys SET used_at = NULL"))
        assert keys.look_up(session, digest)[1] is True


def test_expired_and_revoked_keys_are_nobodys(sessions: sessionmaker[Session]) -> None:
    expired = make(sessions, expires_at=datetime.now(UTC) - timedelta(seconds=1))
    revoked = make(sessions)
    with sessions.begin() as session:
        assert keys.revoke(session, revoked[:18]).revoked_at is not None
    with sessions() as session:
        assert [keys.look_up(session, keys.digest_of(key))[0] for key in (expired, revoked)] == [None, None]
        assert keys.any_exist(session)


def test_a_key_is_revoked_by_id_by_what_is_shown_or_by_itself(sessions: sessionmaker[Session]) -> None:
    made = [make(sessions) for _ in range(3)]
    with sessions.begin() as session:
        first = keys.listed(session)[0]
        for said in (str(first.id), made[1][:18], made[2], made[2]):
            keys.revoke(session, said)
    with sessions() as session:
        assert all(key.revoked_at is not None for key in keys.listed(session, "acme"))
        events = session.scalars(select(AuditEvent).where(AuditEvent.action == AuditAction.KEY_REVOKED)).all()
    assert len(events) == 3  # one for each key, though one was revoked twice
    assert not any(key in (event.detail or "") for event in events for key in made)


@pytest.mark.parametrize(
    "said", ["galloping_", "", "g", "galloping_zzzz", "148ea9e0-ed07-416f-8e9b-b39aa87cd110", "%", "galloping_%"]
)
def test_what_fits_none_or_several_revokes_none(sessions: sessionmaker[Session], said: str) -> None:
    make(sessions)
    make(sessions)
    with sessions.begin() as session, pytest.raises(NotOneKey):
        keys.revoke(session, said)
    with sessions() as session:
        assert [key.revoked_at for key in keys.listed(session)] == [None, None]
