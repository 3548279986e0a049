"""Quotas of requests per minute, counted together by all processes that share a Redis.

Reads are metered apart from changes, so that watching a batch never stops the next one from being posted. The broker's
Redis keeps the counts where there is one. Without Redis the service has a single API process, which counts in its own
memory. A process also counts in memory while Redis does not answer, since a limit must not take the service down.
"""

import logging
import time
from dataclasses import dataclass
from math import ceil
from typing import Any

from limits.aio.storage import MemoryStorage, RedisStorage
from redis.asyncio import ConnectionPool
from redis.exceptions import RedisError

from app.runtime.settings import Settings

WINDOW_SECONDS = 60
_SILENT_SECONDS = 5.0

_logger = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Quota:
    """The most requests of one kind in a minute."""

    name: str
    most: int


@dataclass(frozen=True, slots=True)
class Standing:
    """What is left of a quota after a request, None if it was exceeded, and the seconds until the quota resets."""

    quota: Quota
    left: int | None
    reset_seconds: int

    @property
    def fields(self) -> dict[str, str]:
        """Return the quota's header fields (draft-ietf-httpapi-ratelimit-headers-10)."""
        policy = f'"{self.quota.name}";q={self.quota.most};w={WINDOW_SECONDS}'
        return {
            "RateLimit-Policy": policy,
            "RateLimit": f'"{self.quota.name}";r={self.left or 0};t={self.reset_seconds}',
        }


class Meter:
    """Counts requests in one-minute windows of the clock."""

    def __init__(self, settings: Settings) -> None:
        """Take the settings, which name the shared Redis if there is one; open no connection yet."""
        self._own = MemoryStorage()
        self._pool = _pool(settings)
        self._shared = _storage(settings, self._pool) if self._pool is not None else None
        self._shared_from = 0.0

    async def take(self, quota: Quota, client: str) -> Standing:
        """Count one request of a client."""
        window, passed = divmod(time.time(), WINDOW_SECONDS)
        left = quota.most - await self._count(f"{quota.name}/{client}/{window:.0f}")
        return Standing(quota, left if left >= 0 else None, ceil(WINDOW_SECONDS - passed))

    async def close(self) -> None:
        """Close the connections."""
        if self._pool is not None:
            await self._pool.aclose()

    async def _count(self, key: str) -> int:
        """Add one to a count and return it."""
        if self._shared is not None and time.monotonic() >= self._shared_from:
            try:
                return await self._shared.incr(key, 2 * WINDOW_SECONDS)
            except (RedisError, OSError) as error:
                self._shared_from = time.monotonic() + _SILENT_SECONDS
                _logger.warning("Redis does not count requests, so each process counts its own: %s", error)
        return await self._own.incr(key, 2 * WINDOW_SECONDS)


def _storage(settings: Settings, pool: ConnectionPool) -> RedisStorage:
    given: Any = pool  # the storage hands it on as it is, though it is typed for what an address can say
    return RedisStorage(settings.broker_url, implementation="redispy", connection_pool=given)


def _pool(settings: Settings) -> ConnectionPool | None:
    if not settings.broker_url.startswith(("redis://", "rediss://")):
        return None
    wait = settings.broker_timeout_seconds
    return ConnectionPool.from_url(settings.broker_url, socket_timeout=wait, socket_connect_timeout=wait)
