"""How often an owner may ask: quotas of a minute, counted together by all processes that share a Redis.

Reads are metered apart from changes, so that watching a batch never stops the next one from being posted. The broker's
Redis keeps the counts where there is one. Without one the service has a single API process, and its memory is the
whole truth; that is also what counts while Redis does not answer, since a limit must not take the service down.

A process draws a hundredth of a quota at once and spends it by itself: one look at Redis in a hundred requests.
"""

import asyncio
import logging
import time
from dataclasses import dataclass, field
from math import ceil
from typing import Any

from limits.aio.storage import MemoryStorage, RedisStorage
from redis.asyncio import ConnectionPool
from redis.exceptions import RedisError

from app.runtime.settings import Settings

WINDOW_SECONDS = 60
_DRAWS = 100
_SILENT_SECONDS = 5.0

_logger = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Quota:
    """So many requests of a kind in every minute."""

    name: str
    most: int


@dataclass(frozen=True, slots=True)
class Standing:
    """What is left of a quota after a request, None if it was exceeded; and in how many seconds it is whole again."""

    quota: Quota
    left: int | None
    reset_seconds: int

    @property
    def fields(self) -> dict[str, str]:
        """Return the header fields that tell it (draft-ietf-httpapi-ratelimit-headers-10)."""
        policy = f'"{self.quota.name}";q={self.quota.most};w={WINDOW_SECONDS}'
        return {
            "RateLimit-Policy": policy,
            "RateLimit": f'"{self.quota.name}";r={self.left or 0};t={self.reset_seconds}',
        }


@dataclass(slots=True)
class _Purse:
    """What this process has drawn of a quota and not spent, and what was left for all when it drew last, if it has."""

    drawn: int = 0
    elsewhere: int | None = None
    drawing: asyncio.Lock = field(default_factory=asyncio.Lock)


class Meter:
    """Counts requests in windows of a minute by the clock."""

    def __init__(self, settings: Settings) -> None:
        """Take where the processes count together, if anywhere; no connection is opened before it is needed."""
        self._own = MemoryStorage()
        self._pool = _pool(settings)
        self._shared = _storage(settings, self._pool) if self._pool is not None else None
        self._shared_from = 0.0
        self._window = 0
        self._purses: dict[tuple[str, str], _Purse] = {}

    async def take(self, quota: Quota, client: str) -> Standing:
        """Count one request of a client."""
        window, passed = divmod(time.time(), WINDOW_SECONDS)
        if window != self._window:
            self._window = int(window)
            self._purses.clear()
        purse = self._purses.setdefault((quota.name, client), _Purse())
        if purse.drawn == 0:
            async with purse.drawing:  # one draws for all who wait
                if purse.drawn == 0 and purse.elsewhere != 0:
                    await self._draw(purse, quota, f"{quota.name}/{client}/{window:.0f}")
        reset_seconds = ceil(WINDOW_SECONDS - passed)
        if purse.drawn == 0:
            return Standing(quota, None, reset_seconds)
        purse.drawn -= 1
        return Standing(quota, purse.drawn + (purse.elsewhere or 0), reset_seconds)

    async def close(self) -> None:
        """Close the connections."""
        if self._pool is not None:
            await self._pool.aclose()

    async def _draw(self, purse: _Purse, quota: Quota, key: str) -> None:
        block = max(1, quota.most // _DRAWS)
        after = await self._count(key, block)
        purse.drawn += min(block, max(0, quota.most - after + block))
        purse.elsewhere = max(0, quota.most - after)

    async def _count(self, key: str, amount: int) -> int:
        """Add to a count and return it."""
        if self._shared is not None and time.monotonic() >= self._shared_from:
            try:
                return await self._shared.incr(key, 2 * WINDOW_SECONDS, amount)
            except (RedisError, OSError) as error:
                self._shared_from = time.monotonic() + _SILENT_SECONDS
                _logger.warning("Redis does not count requests, so each process does by itself: %s", error)
        return await self._own.incr(key, 2 * WINDOW_SECONDS, amount)


def _storage(settings: Settings, pool: ConnectionPool) -> RedisStorage:
    given: Any = pool  # the storage hands it on as it is, though it is typed for what an address can say
    return RedisStorage(settings.broker_url, implementation="redispy", connection_pool=given)


def _pool(settings: Settings) -> ConnectionPool | None:
    if not settings.broker_url.startswith(("redis://", "rediss://")):
        return None
    wait = settings.broker_timeout_seconds
    return ConnectionPool.from_url(settings.broker_url, socket_timeout=wait, socket_connect_timeout=wait)
