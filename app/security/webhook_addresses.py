"""Check where webhooks may go: https addresses on the public internet and, if allowed, in private networks.

The service resolves a host name once and connects to the checked IP address. The name therefore cannot resolve to
another address between the check and the connection.
"""

import asyncio
import socket
import threading
from contextlib import suppress
from dataclasses import dataclass
from ipaddress import IPv4Address, IPv6Address, IPv6Network, ip_address, ip_network

import anyio
import httpx

LONGEST = 2000
_RESOLVE_SECONDS = 3.0
_TRANSLATED = (IPv6Network("64:ff9b::/96"), IPv6Network("::/96"))
_METADATA = frozenset({ip_address("168.63.129.16"), ip_address("fd00:ec2::254"), ip_address("100.100.100.200")})
_SHARED = ip_network("100.64.0.0/10")

Address = IPv4Address | IPv6Address


class RefusedAddress(ValueError):
    """Raised for an address to which the service sends nothing; the text says why."""


@dataclass(frozen=True, slots=True)
class Target:
    """A checked address: where to connect, and the host name that the server must prove in its certificate."""

    url: httpx.URL
    address: Address

    @property
    def pinned(self) -> httpx.URL:
        """Return the URL with the checked IP address in place of the host name."""
        return self.url.copy_with(host=str(self.address))


async def vet(text: str, *, private: bool) -> Target:
    """Resolve an address now and return where to connect; `private` also allows private networks.

    Raises
    ------
    RefusedAddress
        If it is not an https address, does not resolve in time, or resolves to an address that is not allowed.
    """
    url = _parsed(text)
    try:
        with anyio.fail_after(_RESOLVE_SECONDS):
            addresses = await _resolved(url.host, url.port or 443)
    except (OSError, UnicodeError, TimeoutError) as error:
        raise RefusedAddress(f"the host {url.host!r} cannot be resolved") from error
    if not addresses:
        raise RefusedAddress(f"the host {url.host!r} has no IP address")
    for address in addresses:
        if not is_open(address, private=private):
            raise RefusedAddress(f"the host {url.host!r} has an IP address to which webhooks are not sent")
    return Target(url, addresses[0])


def is_open(address: Address, *, private: bool) -> bool:
    """Tell whether webhooks may go to an IP address, or to the IPv4 address embedded in it."""
    if isinstance(address, IPv6Address) and (inner := _inner(address)) is not None:
        return is_open(inner, private=private)
    if address in _METADATA or address.is_link_local or address.is_multicast or address.is_unspecified:
        return False
    if address.is_loopback or address in _SHARED or (address.is_private and not address.is_reserved):
        return private
    return address.is_global and not address.is_reserved


async def _resolved(host: str, port: int) -> list[Address]:
    """Return the IP addresses of a host.

    Each lookup runs in a thread of its own. A lookup cannot be cancelled, so a few that hang would fill a shared pool
    and delay the end of the process.

    Raises
    ------
    OSError, UnicodeError
        If the host cannot be resolved.
    """
    loop = asyncio.get_running_loop()
    answer: asyncio.Future[list[Address]] = loop.create_future()

    def settle(found: list[Address] | Exception) -> None:
        if answer.done():  # the caller no longer waits
            return
        if isinstance(found, Exception):
            answer.set_exception(found)
        else:
            answer.set_result(found)

    def resolve() -> None:
        found: list[Address] | Exception
        try:
            found = [ip_address(entry[4][0]) for entry in socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)]
        except (OSError, UnicodeError) as error:
            found = error
        with suppress(RuntimeError):  # the loop has ended
            loop.call_soon_threadsafe(settle, found)

    threading.Thread(target=resolve, name="resolver", daemon=True).start()
    return await answer


def _inner(address: IPv6Address) -> IPv4Address | None:
    """Return the IPv4 address embedded in an IPv6 address (mapped, translated or tunnelled), otherwise None."""
    if address.is_loopback or address.is_unspecified:
        return None
    if any(address in network for network in _TRANSLATED):
        return IPv4Address(int(address) & 0xFFFFFFFF)
    return address.ipv4_mapped or address.sixtofour or (address.teredo[1] if address.teredo else None)


def _parsed(text: str) -> httpx.URL:
    try:
        url = httpx.URL(text)
    except (httpx.InvalidURL, ValueError) as error:
        raise RefusedAddress("must be a valid address") from error
    if url.scheme != "https" or not url.host or len(text) > LONGEST:
        raise RefusedAddress(f"must be an https:// address of at most {LONGEST} characters")
    if url.userinfo or url.fragment:
        raise RefusedAddress("must contain neither a user nor a fragment")
    return url
