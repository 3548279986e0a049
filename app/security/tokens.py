"""Bearer tokens of an OpenID Connect issuer: whose they are and what they allow, by the issuer's published keys.

A token is a JWT with an asymmetric signature. Issuer, audience and times are checked, and claims name owner and scopes.
"""

import logging
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlsplit

import httpx
import jwt

from app.runtime.loopback import is_loopback
from app.runtime.settings import Settings
from app.security.caller import OWNER_PATTERN, Caller, Scope

# By the type of a key. No symmetric algorithm: its secret would be the public key that anybody can read.
_ALGORITHMS: Mapping[str, tuple[str, ...]] = {
    "RSA": ("RS256", "RS384", "RS512", "PS256", "PS384", "PS512"),
    "EC": ("ES256", "ES384", "ES512"),
    "OKP": ("EdDSA",),
}
_LEEWAY_SECONDS = 30.0
_FETCH_SECONDS = 3.0
_PAUSE_SECONDS = 5.0  # between two fetches, so that tokens with invented key ids do not burden the issuer
_LONGEST_KEPT_SECONDS = 86_400.0  # for which keys serve while the issuer does not answer

_logger = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class SigningKey:
    """A public key of the issuer, and the algorithms that it may verify."""

    key: Any
    algorithms: tuple[str, ...]


Keys = Mapping[str | None, SigningKey]


class NotAccepted(Exception):
    """Raised for a token that does not identify a caller; the text says why."""


class IssuerUnavailable(Exception):
    """Raised when a token cannot be checked because its issuer does not give its keys."""


class IssuerKeys:
    """The issuer's keys by their ids, fetched anew when they are old or an id is unknown.

    While the issuer does not answer, keys that were fetched within a day go on.
    """

    def __init__(self, fetch: Callable[[], Keys], seconds: float, clock: Callable[[], float] = time.monotonic) -> None:
        """Take the function that fetches keys, after how long they are old, and a clock [s]."""
        self._fetch = fetch
        self._seconds = seconds
        self._clock = clock
        self._fetching = threading.Lock()
        self._keys: Keys = {}
        self._fetched_at = self._tried_at = float("-inf")
        self._answers = True

    def key(self, key_id: str | None) -> SigningKey | None:
        """Return a key by its id, or the only one if a token names none; None if the issuer has no such key.

        Raises
        ------
        IssuerUnavailable
            If it cannot be told, because the issuer does not answer.
        """
        found = self._kept(key_id)
        if found is None or self._clock() - self._fetched_at > self._seconds:
            # Who has a key does not wait for the fetch of another request.
            if self._fetching.acquire(blocking=found is None):
                try:
                    self._fetch_anew()
                finally:
                    self._fetching.release()
            found = self._kept(key_id)
        if found is None and not self._answers:
            raise IssuerUnavailable
        return found

    def holds(self, key_id: str | None) -> bool:
        """Tell whether a key is at hand without a question to the issuer."""
        return self._kept(key_id) is not None

    def _kept(self, key_id: str | None) -> SigningKey | None:
        if self._clock() - self._fetched_at > _LONGEST_KEPT_SECONDS:
            return None
        if key_id is None and len(self._keys) == 1:
            return next(iter(self._keys.values()))
        return self._keys.get(key_id)

    def _fetch_anew(self) -> None:
        if self._clock() - self._tried_at < _PAUSE_SECONDS:
            return
        self._tried_at = self._clock()
        try:
            self._keys, self._fetched_at, self._answers = self._fetch(), self._clock(), True
        except (httpx.HTTPError, jwt.PyJWTError, ValueError, LookupError, TypeError) as error:
            self._answers = False
            _logger.warning("the issuer of tokens does not give its keys: %s", error)


class Tokens:
    """Checks tokens of the issuer that the settings name."""

    def __init__(self, settings: Settings, keys: IssuerKeys) -> None:
        """Take the settings and the issuer's keys."""
        self._settings = settings
        self._keys = keys

    def caller(self, token: str) -> Caller:
        """Return the caller whom a token identifies.

        Raises
        ------
        NotAccepted
            If the token is expired, for another audience, not the issuer's, or names no owner.
        IssuerUnavailable
            If the issuer does not give its keys.
        """
        try:
            key = self._keys.key(jwt.get_unverified_header(token).get("kid"))
            if key is None:
                raise NotAccepted("its key is none of the issuer's")
            claims = jwt.decode(
                token,
                key.key,
                algorithms=list(key.algorithms),
                issuer=self._settings.oidc_issuer,
                audience=self._settings.oidc_audience,
                leeway=_LEEWAY_SECONDS,
                options={"require": ["exp", "iss", "aud"]},
            )
        except jwt.PyJWTError as error:
            raise NotAccepted(str(error)) from error
        return Caller(self._owner(claims), self._scopes(claims))

    def may_accept(self, token: str) -> bool:
        """Tell whether a token names a key of the issuer that is at hand, so that a check costs a signature only."""
        try:
            return self._keys.holds(jwt.get_unverified_header(token).get("kid"))
        except jwt.PyJWTError:
            return False

    def _owner(self, claims: Mapping[str, Any]) -> str:
        name = self._settings.oidc_owner_claim
        owner = _claim(claims, name)
        if not isinstance(owner, str) or not OWNER_PATTERN.fullmatch(owner):
            raise NotAccepted(f"its claim {name} is no name of an owner")
        return owner

    def _scopes(self, claims: Mapping[str, Any]) -> frozenset[Scope]:
        found = _claim(claims, self._settings.oidc_scope_claim)
        given = found.split() if isinstance(found, str) else found if isinstance(found, list) else []
        return frozenset(scope for scope in Scope if f"{self._settings.oidc_scope_prefix}{scope.value}" in given)


def tokens_of(settings: Settings) -> Tokens | None:
    """Return what checks tokens, or None if the settings name no issuer."""
    if settings.oidc_issuer is None:
        return None
    return Tokens(settings, IssuerKeys(lambda: fetched_keys(settings), settings.oidc_keys_seconds))


def is_token(text: str) -> bool:
    """Tell whether a bearer's text has the form of a signed token, which a key never has."""
    return text.count(".") == 2


def fetched_keys(settings: Settings) -> Keys:
    """Return the issuer's keys for signatures, from the address in the settings or in the issuer's own description.

    Raises
    ------
    httpx.HTTPError
        If the issuer does not answer.
    ValueError, LookupError, TypeError, jwt.PyJWTError
        If its answer is not what it should be.
    """
    issuer = settings.oidc_issuer or ""
    address = settings.oidc_jwks_url
    if address is None:
        described = _document(f"{issuer.rstrip('/')}/.well-known/openid-configuration")
        if described["issuer"] != issuer:
            raise ValueError(f"it calls itself {described['issuer']}")
        address = described["jwks_uri"]
        if not _is_private(address):
            raise ValueError(f"{address} must begin with https://")
    published = [one for one in _document(address)["keys"] if one.get("use") != "enc"]
    return {one.get("kid"): key for one in published if (key := _signing_key(one)) is not None}


def _is_private(address: str) -> bool:
    """Tell whether nobody on the way can change what an address answers: by https, or on this machine."""
    parts = urlsplit(address)
    return parts.scheme == "https" or (parts.scheme == "http" and is_loopback(parts.hostname or ""))


def _document(address: str) -> dict[str, Any]:
    found: dict[str, Any] = httpx.get(address, timeout=_FETCH_SECONDS).raise_for_status().json()
    return found


def _signing_key(published: Mapping[str, Any]) -> SigningKey | None:
    """Return a key with the algorithm that it declares, else those of its type; None for an unknown kind."""
    declared = published.get("alg")
    algorithms = tuple(name for name in _ALGORITHMS.get(published["kty"], ()) if declared in {None, name})
    try:
        return SigningKey(jwt.PyJWK(dict(published)).key, algorithms) if algorithms else None
    except jwt.PyJWTError as error:
        _logger.warning("a key of the issuer is not usable: %s", error)
        return None


def _claim(claims: Mapping[str, Any], path: str) -> Any:
    """Return a claim by its name, or one inside others by a path with dots, as `realm_access.roles`."""
    if path in claims:
        return claims[path]
    found: Any = claims
    for name in path.split("."):
        found = found.get(name) if isinstance(found, Mapping) else None
    return found
