"""Tokens of an issuer on the loopback: what identifies a caller, what is refused, and what an absent issuer means."""

import base64
import contextlib
import hashlib
import hmac
import json
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from typing import Any

import jwt
import pytest
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import ec, rsa
from jwt.algorithms import ECAlgorithm, RSAAlgorithm
from pydantic import ValidationError

from app.runtime.settings import Settings
from app.security.caller import Caller, Scope
from app.security.tokens import IssuerKeys, IssuerUnavailable, NotAccepted, Tokens, fetched_keys, is_token, tokens_of
from tests.app import service
from tests.documents import short_request

AUDIENCE = "galloping"
RSA_KEY = rsa.generate_private_key(65537, 2048)
OTHER_RSA_KEY = rsa.generate_private_key(65537, 2048)
EC_KEY = ec.generate_private_key(ec.SECP256R1())


@dataclass
class Issuer:
    """A server that publishes keys; `up` false lets it answer 503."""

    address: str = ""
    keys: list[dict[str, Any]] = field(default_factory=list)
    up: bool = True
    fetches: int = 0

    def publish(self, **keys: rsa.RSAPrivateKey | ec.EllipticCurvePrivateKey) -> None:
        self.keys = [{**_public(key), "kid": name, "use": "sig"} for name, key in keys.items()]

    def token(self, kid: str | None = "first", key: Any = RSA_KEY, algorithm: str = "RS256", **changes: Any) -> str:
        claims = {
            "iss": self.address,
            "aud": AUDIENCE,
            "sub": "north-grid",
            "exp": time.time() + 300,
            "scope": "openid galloping:read galloping:submit",
            **changes,
        }
        given = {name: value for name, value in claims.items() if value is not None}
        return jwt.encode(given, key, algorithm=algorithm, headers={"kid": kid} if kid else None)


def _public(key: rsa.RSAPrivateKey | ec.EllipticCurvePrivateKey) -> dict[str, Any]:
    if isinstance(key, rsa.RSAPrivateKey):
        return dict(RSAAlgorithm.to_jwk(key.public_key(), as_dict=True))
    return dict(ECAlgorithm.to_jwk(key.public_key(), as_dict=True))


@pytest.fixture
def issuer() -> Iterator[Issuer]:
    found = Issuer()

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            described = {"issuer": found.address, "jwks_uri": f"{found.address}/keys"}
            found.fetches += self.path == "/keys"
            body = json.dumps({"keys": found.keys} if self.path == "/keys" else described).encode()
            self.send_response(200 if found.up else 503)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - the name that the base class gives
            pass

    with HTTPServer(("127.0.0.1", 0), Handler) as server:
        found.address = f"http://127.0.0.1:{server.server_address[1]}"
        found.publish(first=RSA_KEY)
        thread = threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True)
        thread.start()
        try:
            yield found
        finally:
            server.shutdown()
            thread.join()


class Clock:
    """A clock that a test moves on."""

    now = 1000.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def settings(issuer: Issuer, tmp_path: Path) -> Settings:
    return service.sqlite_settings(tmp_path, oidc_issuer=issuer.address, oidc_audience=AUDIENCE)


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def tokens(settings: Settings, clock: Clock) -> Tokens:
    return Tokens(settings, IssuerKeys(lambda: fetched_keys(settings), 300.0, clock))


def test_owner_and_scopes_come_from_claims(issuer: Issuer, tokens: Tokens) -> None:
    expected = Caller("north-grid", frozenset({Scope.READ, Scope.SUBMIT}))
    assert tokens.caller(issuer.token()) == expected
    assert tokens.caller(issuer.token(kid=None)) == expected  # the issuer has one key
    assert tokens.caller(issuer.token(algorithm="PS384", aud=["other", AUDIENCE])) == expected
    assert tokens.caller(issuer.token(scope=None)).scopes == frozenset()
    assert issuer.fetches == 1


def test_claims_may_be_lists_inside_objects(issuer: Issuer, settings: Settings) -> None:
    changes = {"oidc_owner_claim": "grid", "oidc_scope_claim": "realm_access.roles", "oidc_scope_prefix": "g-"}
    found = tokens_of(settings.model_copy(update=changes))
    assert found is not None
    token = issuer.token(grid="south", realm_access={"roles": ["g-cancel", "read", "galloping:submit"]})
    assert found.caller(token) == Caller("south", frozenset({Scope.CANCEL}))


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"exp": 1}, "expired"),
        ({"exp": None}, "exp"),
        ({"aud": "another"}, "[Aa]udience"),
        ({"aud": None}, "aud"),
        ({"iss": "http://127.0.0.1:1"}, "[Ii]ssuer"),
        ({"nbf": 4e9}, "not yet valid"),
        ({"sub": None}, "its claim sub is no name of an owner"),
        ({"sub": "../north"}, "its claim sub is no name of an owner"),
        ({"kid": "invented"}, "its key is none of the issuer's"),
        ({"key": OTHER_RSA_KEY}, "[Ss]ignature"),
    ],
)
def test_whatever_is_wrong_is_refused_with_its_reason(
    issuer: Issuer, tokens: Tokens, changes: dict[str, Any], reason: str
) -> None:
    with pytest.raises(NotAccepted, match=reason):
        tokens.caller(issuer.token(**changes))


def test_public_key_is_no_shared_secret_and_unsigned_is_no_signature(issuer: Issuer, tokens: Tokens) -> None:
    public = RSA_KEY.public_key().public_bytes(
        serialization.Encoding.PEM, serialization.PublicFormat.SubjectPublicKeyInfo
    )
    body = issuer.token().split(".")[1]
    head = _encoded(json.dumps({"alg": "HS256", "kid": "first"}).encode())
    forged = hmac.new(public, f"{head}.{body}".encode(), hashlib.sha256).digest()
    for token in (f"{head}.{body}.{_encoded(forged)}", issuer.token(key=None, algorithm="none")):
        with pytest.raises(NotAccepted, match="alg"):
            tokens.caller(token)
    with pytest.raises(NotAccepted):
        tokens.caller("not.a.token")


def test_algorithm_is_that_of_the_key(issuer: Issuer, tokens: Tokens) -> None:
    issuer.publish(first=RSA_KEY, curve=EC_KEY)
    assert tokens.caller(issuer.token(kid="curve", key=EC_KEY, algorithm="ES256")).owner == "north-grid"
    with pytest.raises(NotAccepted, match="alg"):
        tokens.caller(issuer.token(kid="curve"))
    issuer.keys = [{**issuer.keys[0], "alg": "RS512"}, {"kty": "oct", "k": "c2VjcmV0", "kid": "shared"}]
    fresh = tokens_of(tokens._settings)
    assert fresh is not None
    with pytest.raises(NotAccepted, match="alg"):
        fresh.caller(issuer.token())
    with pytest.raises(NotAccepted, match="none of the issuer's"):
        fresh.caller(issuer.token(kid="shared", key=b"secret" * 6, algorithm="HS256"))


def _encoded(part: bytes) -> str:
    return base64.urlsafe_b64encode(part).rstrip(b"=").decode()


def test_keys_rotate_and_unknown_ids_do_not_burden_the_issuer(issuer: Issuer, tokens: Tokens, clock: Clock) -> None:
    tokens.caller(issuer.token())
    issuer.publish(second=OTHER_RSA_KEY)
    clock.now += 6.0
    assert tokens.caller(issuer.token("second", OTHER_RSA_KEY)).owner == "north-grid"
    with pytest.raises(NotAccepted, match="none of the issuer's"):
        tokens.caller(issuer.token())  # withdrawn
    for number in range(20):
        with pytest.raises(NotAccepted):
            tokens.caller(issuer.token(f"invented-{number}"))
    assert issuer.fetches == 2


def test_known_keys_go_on_for_a_day_while_the_issuer_is_down(issuer: Issuer, tokens: Tokens, clock: Clock) -> None:
    tokens.caller(issuer.token())
    issuer.up = False
    clock.now += 3_600.0
    assert tokens.caller(issuer.token()).owner == "north-grid"
    with pytest.raises(IssuerUnavailable):
        tokens.caller(issuer.token("second", OTHER_RSA_KEY))
    clock.now += 86_400.0
    with pytest.raises(IssuerUnavailable):
        tokens.caller(issuer.token())
    issuer.up = True
    clock.now += 6.0
    assert tokens.caller(issuer.token()).owner == "north-grid"


def test_service_takes_tokens_beside_keys(issuer: Issuer, settings: Settings) -> None:
    with service.running(settings) as client:
        assert client.get("/v1/jobs").status_code == 401  # with an issuer nobody is let in without
        mine = {"Authorization": f"Bearer {issuer.token()}"}
        posted = client.post("/v1/jobs", json=short_request(), headers=mine)
        assert posted.status_code == 202 and "RateLimit" in posted.headers
        assert len(client.get("/v1/jobs", headers=mine).json()["jobs"]) == 1
        others = {"Authorization": f"Bearer {issuer.token(sub='south-grid')}"}
        assert client.get("/v1/jobs", headers=others).json()["jobs"] == []
        assert client.get(posted.headers["Location"], headers=others).status_code == 404
        lacking = client.delete(posted.headers["Location"], headers=mine)
        assert lacking.status_code == 403 and 'scope="cancel"' in lacking.headers["WWW-Authenticate"]
        expired = client.get("/v1/jobs", headers={"Authorization": f"Bearer {issuer.token(exp=1)}"})
        assert expired.status_code == 401 and "expired" in expired.json()["detail"]
        assert 'error="invalid_token"' in expired.headers["WWW-Authenticate"]


def test_service_says_when_the_issuer_is_down(issuer: Issuer, settings: Settings) -> None:
    issuer.up = False
    with service.running(settings) as client:
        answer = client.get("/v1/jobs", headers={"Authorization": f"Bearer {issuer.token()}"})
    assert answer.status_code == 503 and answer.headers["Retry-After"] == "5"
    assert "issuer" in answer.json()["detail"]


def test_settings_name_an_audience_and_a_private_way(tmp_path: Path) -> None:
    with pytest.raises(ValidationError, match="oidc_audience must be set"):
        service.sqlite_settings(tmp_path, oidc_issuer="https://issuer.example")
    with pytest.raises(ValidationError, match="must begin with https"):
        service.sqlite_settings(tmp_path, oidc_issuer="http://issuer.example", oidc_audience="a")
    assert tokens_of(service.sqlite_settings(tmp_path)) is None
    assert is_token("a.b.c") and not is_token("galloping_0123456789abcdef")


@contextlib.contextmanager
def _describing(issuer: Issuer, name: str) -> Iterator[None]:
    kept, issuer.address = issuer.address, name
    try:
        yield
    finally:
        issuer.address = kept


def test_description_of_another_issuer_is_not_followed(issuer: Issuer, settings: Settings) -> None:
    with _describing(issuer, "https://another.example"), pytest.raises(ValueError, match="calls itself"):
        fetched_keys(settings)
