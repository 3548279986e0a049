import asyncio
import socket
import threading
from ipaddress import ip_address
from typing import Any

import pytest

from app.security.webhook_addresses import RefusedAddress, Target, is_open, vet


@pytest.mark.parametrize("address", ["8.8.8.8", "2606:4700:4700::1111", "::ffff:8.8.8.8", "64:ff9b::808:808"])
def test_public_addresses_are_open(address: str) -> None:
    assert is_open(ip_address(address), private=False)


PRIVATE = ["127.0.0.1", "10.1.2.3", "172.16.0.1", "192.168.1.1", "100.64.0.1", "::1", "fd12::1", "::ffff:127.0.0.1"]
PRIVATE += ["64:ff9b::7f00:1", "2002:7f00:1::", "::ffff:10.0.0.1"]


@pytest.mark.parametrize("address", PRIVATE)
def test_private_networks_are_open_only_if_the_operator_says_so(address: str) -> None:
    assert not is_open(ip_address(address), private=False)
    assert is_open(ip_address(address), private=True)


NEVER = ["169.254.169.254", "fe80::1", "::ffff:169.254.169.254", "64:ff9b::a9fe:a9fe", "168.63.129.16", "fd00:ec2::254"]
NEVER += ["0.0.0.0", "::", "224.0.0.1", "ff02::1", "240.0.0.1", "100.100.100.200", "255.255.255.255"]


@pytest.mark.parametrize("address", NEVER)
def test_metadata_and_what_is_no_host_are_never_open(address: str) -> None:
    assert not is_open(ip_address(address), private=True)


@pytest.mark.parametrize(
    "url",
    [
        "http://8.8.8.8/",
        "ftp://8.8.8.8/",
        "https://",
        "https://user:word@8.8.8.8/",
        "https://8.8.8.8/#part",
        "https://8.8.8.8/" + "a" * 2000,
        "https://127.0.0.1/",
        "https://localhost/",
        "https://2130706433/",
        "https://0177.0.0.1/",
        "https://[::ffff:7f00:1]/",
        "https://[::1]:443/",
        "nonsense",
        "https://a b/",
    ],
)
def test_other_addresses_are_refused(url: str) -> None:
    with pytest.raises(RefusedAddress):
        asyncio.run(vet(url, private=False))


def test_what_was_vetted_is_pinned_and_the_name_kept() -> None:
    target = asyncio.run(vet("https://localhost:8443/hook?a=b", private=True))
    assert str(target.pinned) in {"https://127.0.0.1:8443/hook?a=b", "https://[::1]:8443/hook?a=b"}
    assert target.url.host == "localhost"


def test_names_that_nobody_resolves_hold_up_no_others(monkeypatch: pytest.MonkeyPatch) -> None:
    """As many look-ups hang as would fill the loop's pool of threads, which has at most 32."""
    real, go_on = socket.getaddrinfo, threading.Event()

    def hanging(host: str, *arguments: Any, **named: Any) -> Any:
        if host.endswith(".silent"):
            go_on.wait(60.0)
        return real(host, *arguments, **named)

    async def main() -> list[Target | BaseException]:
        silent = [asyncio.create_task(vet(f"https://n{number}.silent/", private=True)) for number in range(40)]
        await asyncio.sleep(0.0)
        assert (await vet("https://localhost/", private=True)).url.host == "localhost"
        assert not any(task.done() for task in silent)
        return await asyncio.gather(*silent, return_exceptions=True)

    monkeypatch.setattr(socket, "getaddrinfo", hanging)
    try:
        given_up = asyncio.run(main())
    finally:
        go_on.set()
    assert all(str(error).endswith(".silent' cannot be resolved") for error in given_up)
    assert len(given_up) == 40
