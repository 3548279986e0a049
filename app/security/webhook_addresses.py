"""Where webhooks may go: https addresses whose every IP address is public, or of a private network if that is open.

A name is resolved here and the connection is made to what was vetted, so that it cannot resolve to something else
between the look and the use.
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
    """Raised for an address to which nothing is sent; the text says why."""


@dataclass(frozen=True, slots=True)
class Target:
    """A vetted address: where to connect, and the name that the other side must prove to have."""

    url: httpx.URL
    address: Address

    @property
    def pinned(self) -> httpx.URL:
        """Return the address with the vetted IP address in the place of the name."""
        return self.url.copy_with(host=str(self.address))


async def vet(text: str, *, private: bool) -> Target:
    """Return where to send something, resolved now; with `private` also in private networks.

    Raises
    ------
    RefusedAddress
        If it is no https address, has no IP address in time, or any that nothing is sent to.
    """
    url = _parsed(text)
    try:
        with anyio.fail_after(_RESOLVE_SECONDS):
            addresses = await _resolved(url.host, url.port or 443)
    except (OSError, UnicodeError, TimeoutError) as error:
        raise RefusedAddress(f"the host {url.host!r} cannot be resolved") from error
    if not addresses:
        raise RefusedAddress(f"the host {url.host!r} has no address")
    for address in addresses:
        if not is_open(address, private=private):
            raise RefusedAddress(f"the host {url.host!r} is at an address to which nothing is sent")
    return Target(url, addresses[0])


def is_open(address: Address, *, private: bool) -> bool:
    """Tell whether something may be sent to an IP address, or to the one that it stands for."""
    if isinstance(address, IPv6Address) and (inner := _inner(address)) is not None:
        return is_open(inner, private=private)
    if address in _METADATA or address.is_link_local or address.is_multicast or address.is_unspecified:
        return False
    if address.is_loopback or address in _SHARED or (address.is_private and not address.is_reserved):
        return private
    return address.is_global and not address.is_reserved


async def _resolved(host: str, port: int) -> list[Address]:
    """Return the addresses of a host.

    Each look-up has a thread of its own: it cannot be cut off, so that a few which hang would fill a pool for all, and
    hold up the end of the process.

    Raises
    ------
    OSError, UnicodeError
        If it has none.
    """
    loop = asyncio.get_running_loop()
    answer: asyncio.Future[list[Address]] = loop.create_future()

    def settle(found: list[Address] | Exception) -> None:
        if answer.done():  # who asked waits no longer
            return
        if isinstance(found, Exception):
            answer.set_exception(found)
        else:
            answer.set_result(found)

    def look_up() -> None:
        found: list[Address] | Exception
        try:
            found = [ip_address(entry[4][0]) for entry in socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)]
        except (OSError, UnicodeError) as error:
            found = error
        with suppress(RuntimeError):  # the loop has ended meanwhile
            loop.call_soon_threadsafe(settle, found)

    threading.Thread(target=look_up, name="resolver", daemon=True).start()
    return await answer


def _inner(address: IPv6Address) -> IPv4Address | None:
    """Return the IPv4 address that an address of IPv6 carries: mapped, translated or tunnelled."""
    if address.is_loopback or address.is_unspecified:
        return None
    if any(address in network for network in _TRANSLATED):
        return IPv4Address(int(address) & 0xFFFFFFFF)
    return address.ipv4_mapped or address.sixtofour or (address.teredo[1] if address.teredo else None)


def _parsed(text: str) -> httpx.URL:
    try:
        url = httpx.URL(text)
    except (httpx.InvalidURL, ValueError) as error:
        raise RefusedAddress("is no address") from error
    if url.scheme != "https" or not url.host or len(text) > LONGEST:
        raise RefusedAddress(f"must be an https:// address of at most {LONGEST} characters")
    if url.userinfo or url.fragment:
        raise RefusedAddress("must have neither a user nor a fragment")
    return url
