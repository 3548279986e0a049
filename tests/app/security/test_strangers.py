import asyncio
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from sqlalchemy.orm import Session, sessionmaker

from app.runtime.settings import Settings
from app.security import keys
from app.security.caller import Scope
from app.security.quotas import Meter
from app.security.strangers import Strangers


def scope(address: str) -> dict[str, Any]:
    return {"type": "http", "client": (address, 1)}


def left(strangers: Strangers, address: str) -> int | None:
    return asyncio.run(strangers.count(scope(address))).left


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
def test_valid_keys_are_not_counted(settings: Settings, sessions: sessionmaker[Session]) -> None:
    now = datetime.now(UTC)
    with sessions.begin() as session:
        good, _ = keys.create(session, "acme", tuple(Scope), None, now + timedelta(hours=1))
        expired, _ = keys.create(session, "acme", tuple(Scope), None, now - timedelta(hours=1))
        revoked, _ = keys.create(session, "acme", tuple(Scope), None, None)
        keys.revoke(session, str(revoked.id))

    async def tried() -> list[int | None]:
        strangers = Strangers(settings, sessions, Meter(settings))
        standings = [
            await strangers.try_key(scope("192.0.2.1"), key)
            for key in (good.digest, expired.digest, revoked.digest, "unknown", good.digest)
        ]
        return [None if standing is None else standing.left for standing in standings]

    most = settings.strangers_per_minute
    assert asyncio.run(tried()) == [None, most - 1, most - 2, most - 3, None]


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
def test_addresses_are_counted_apart_and_those_of_one_network_together(
    settings: Settings, sessions: sessionmaker[Session]
) -> None:
    strangers, most = Strangers(settings, sessions, Meter(settings)), settings.strangers_per_minute
    assert [left(strangers, address) for address in ("192.0.2.1", "192.0.2.2", "::ffff:192.0.2.1")] == [
        most - 1,
        most - 1,
        most - 2,
    ]
    assert [left(strangers, address) for address in ("2001:db8::1", "2001:db8::ffff:2", "2001:db8:0:1::1")] == [
        most - 1,
        most - 2,
        most - 1,
    ]
    assert left(strangers, "") == most - 1
