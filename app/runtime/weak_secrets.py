"""Find secrets that are easy to guess: missing, short, or copied from an example."""

from collections.abc import Iterator
from urllib.parse import SplitResult, urlsplit

from app.runtime.loopback import is_loopback

_SHORTEST = 16
_EXAMPLES = frozenset(
    {"admin", "change-me", "change_me", "changeme", "default", "example", "galloping", "guest"}
    | {"password", "postgres", "redis", "root", "secret", "test"}
)


def weak_secrets(database_url: str, broker_url: str, signing_secret: str | None) -> list[str]:
    """Return a sentence for each weak secret; none if database and broker are on this machine.

    A service on one machine generates its own secret, and stays private to that machine until it has keys.
    """
    addresses = {"GALLOPING_DATABASE_URL": database_url, "GALLOPING_BROKER_URL": broker_url}
    remote = {name: parts for name, url in addresses.items() if (parts := _elsewhere(url)) is not None}
    return [*_weak_passwords(remote), *_weak_signing_secret(signing_secret)] if remote else []


def _elsewhere(url: str) -> SplitResult | None:
    """Return the parts of an address on another machine; None for a local, file or malformed address."""
    try:
        parts = urlsplit(url)
    except ValueError:
        return None
    in_files = parts.scheme in {"sqlite", "filesystem"}
    return None if in_files or not parts.hostname or is_loopback(parts.hostname) else parts


def _weak_passwords(remote: dict[str, SplitResult]) -> Iterator[str]:
    for name, parts in remote.items():
        password = parts.password
        # Without a password in the address, a file, a certificate or the network must grant access.
        if password is not None and (password.lower() in _EXAMPLES or password == parts.username or not password):
            yield f"{name} has a password that is easy to guess"


def _weak_signing_secret(secret: str | None) -> Iterator[str]:
    if secret is None:
        yield "GALLOPING_SIGNING_SECRET must be set when the database or the broker is on another machine"
    elif len(secret) < _SHORTEST or secret.lower() in _EXAMPLES:
        yield f"GALLOPING_SIGNING_SECRET must be a random text of at least {_SHORTEST} characters"
