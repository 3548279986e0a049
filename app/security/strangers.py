"""Count how many unfamiliar keys one address tries, without making the good keys of the same address wait."""

from ipaddress import IPv6Address, ip_address, ip_network

from sqlalchemy.orm import Session, sessionmaker
from starlette.types import Scope

from app.coalescing.expiring_cache import ExpiringCache
from app.runtime.settings import Settings
from app.security import keys
from app.security.quotas import Meter, Quota, Standing

_NETWORK_BITS = 64  # of an IPv6 address: who has one usually has all that share them


class Strangers:
    """Meters what is no valid key by the address of its client; each costs a query or a signature.

    Behind one address, that of a proxy or a gateway, there may be an attacker and good keys. A valid key is therefore
    not counted here, whatever else comes from its address.
    """

    def __init__(self, settings: Settings, readers: sessionmaker[Session], meter: Meter) -> None:
        """Take the settings, the database with the keys, and what counts."""
        self._quota = Quota("strangers", settings.strangers_per_minute)
        self._meter = meter

        def valid(_: str) -> frozenset[str]:
            with readers() as session:
                return keys.valid_digests(session) | {""}  # never empty, since the cache keeps nothing empty

        self._valid = ExpiringCache(valid, settings.key_cache_seconds)

    async def try_key(self, scope: Scope, digest: str) -> Standing | None:
        """Count a try of a key and return where its address stands; None for a valid key.

        Raises
        ------
        sqlalchemy.exc.OperationalError
            If the database does not answer.
        """
        return None if digest in await self._valid.get("") else await self.count(scope)

    async def count(self, scope: Scope) -> Standing:
        """Count a try of something unfamiliar and return where its address stands."""
        return await self._meter.take(self._quota, _network(scope))


def _network(scope: Scope) -> str:
    """Return the address of a request's client, or the network of one who has many."""
    text = str((scope.get("client") or ("",))[0])
    try:
        address = ip_address(text)
    except ValueError:  # a socket of this machine
        return text
    if not isinstance(address, IPv6Address):
        return text
    return str(address.ipv4_mapped or ip_network((address, _NETWORK_BITS), strict=False))
