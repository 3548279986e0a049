"""Secrets that anybody could guess: left out, short, or as an example has them. None of them may guard a deployment."""

from collections.abc import Iterator
from urllib.parse import SplitResult, urlsplit

from app.runtime.loopback import is_loopback

_SHORTEST = 16
_EXAMPLES = frozenset(
    {"admin", "change-me", "change_me", "changeme", "default", "example", "galloping", "guest"}
    | {"password", "postgres", "redis", "root", "secret", "test"}
)


def weak_secrets(database_url: str, broker_url: str, signing_secret: str | None) -> list[str]:
    """Return in sentences what is weak; nothing for a service whose database and broker are on its own machine.

    That one is its operator's alone until it has keys, and makes its secret itself.
    """
    addresses = {"GALLOPING_DATABASE_URL": database_url, "GALLOPING_BROKER_URL": broker_url}
    remote = {name: parts for name, url in addresses.items() if (parts := _elsewhere(url)) is not None}
    return [*_weak_passwords(remote), *_weak_signing_secret(signing_secret)] if remote else []


def _elsewhere(url: str) -> SplitResult | None:
    """Return the parts of an address on another machine; None for one on this, or in a file, or that is none."""
    try:
        parts = urlsplit(url)
    except ValueError:
        return None
    in_files = parts.scheme in {"sqlite", "filesystem"}
    return None if in_files or not parts.hostname or is_loopback(parts.hostname) else parts


def _weak_passwords(remote: dict[str, SplitResult]) -> Iterator[str]:
    for name, parts in remote.items():
        password = parts.password
        # An address without a password leaves it to files, certificates or the network.
        if password is not None and (password.lower() in _EXAMPLES or password == parts.username or not password):
            yield f"{name} has a password that anybody could guess"


def _weak_signing_secret(secret: str | None) -> Iterator[str]:
    if secret is None:
        yield "GALLOPING_SIGNING_SECRET must be set where database or broker are on another machine"
    elif len(secret) < _SHORTEST or secret.lower() in _EXAMPLES:
        yield f"GALLOPING_SIGNING_SECRET must be a random text of at least {_SHORTEST} characters"
