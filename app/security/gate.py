"""Authentication, authorization and quotas for every request. Addresses not listed as open need a key or a token."""

from collections.abc import Mapping
from contextlib import suppress
from functools import partial
from urllib.parse import urlsplit

from fastapi import Request
from sqlalchemy.exc import OperationalError, SQLAlchemyError
from sqlalchemy.orm import Session, sessionmaker
from starlette import types

from app.coalescing.expiring_cache import ExpiringCache
from app.http import problems
from app.http.prefix import path_of
from app.http.problems import ProblemError, ProblemKind
from app.runtime.loopback import is_loopback
from app.runtime.settings import Settings
from app.security import keys, sessions
from app.security.caller import LOCAL, Caller, Scope
from app.security.quotas import Meter, Quota, Standing
from app.security.tokens import IssuerUnavailable, NotAccepted, is_token, tokens_of

_OPEN = ("/docs", "/health", "/openapi.json", "/pages/assets", "/pages/sign-in", "/problems")
_PAGES = "/pages"
_FORWARDED = (b"forwarded", b"via", b"x-forwarded-for", b"x-forwarded-host", b"x-forwarded-proto", b"x-real-ip")
_NEEDED = {"GET": Scope.READ, "POST": Scope.SUBMIT, "PUT": Scope.SUBMIT, "PATCH": Scope.SUBMIT, "DELETE": Scope.CANCEL}

Headers = Mapping[bytes, bytes]


class Gate:
    """ASGI middleware that admits requests with a valid key, the right scope and remaining quota.

    While no key exists, the service answers its own machine only, without quotas. A browser may show a session in place
    of a key to read, and to send the forms of pages, which have marks of their own against forgery. The gate stores the
    caller in the request's state as `caller`.
    """

    def __init__(
        self,
        app: types.ASGIApp,
        settings: Settings,
        readers: sessionmaker[Session],
        writers: sessionmaker[Session],
        meter: Meter,
    ) -> None:
        """Wrap an application."""
        self.app = app
        self._settings = settings
        self._meter = meter
        self._callers = ExpiringCache(partial(_look_up, readers, writers), settings.key_cache_seconds)
        tokens = tokens_of(settings)
        self._bearers = ExpiringCache(tokens.caller, settings.key_cache_seconds) if tokens else None
        self._unguarded: ExpiringCache[str, bool] = ExpiringCache(
            lambda _: tokens is None and _is_unguarded(readers), settings.key_cache_seconds
        )
        self._reads = Quota("reads", settings.reads_per_minute)
        self._changes = Quota("changes", settings.changes_per_minute)
        self._strangers = Quota("strangers", settings.strangers_per_minute)

    async def __call__(self, scope: types.Scope, receive: types.Receive, send: types.Send) -> None:
        """Serve one request."""
        if scope["type"] != "http" or is_open(path_of(scope)):
            await self.app(scope, receive, send)
            return
        try:
            caller, standing = await self._admit(scope)
        except ProblemError as problem:
            answer = await problems.answer(Request(scope), problem)
            await answer(scope, receive, send)
            return
        scope.setdefault("state", {})["caller"] = caller
        await self.app(scope, receive, _with_quota_fields(standing, send) if standing is not None else send)

    async def _admit(self, scope: types.Scope) -> tuple[Caller, Standing | None]:
        """Return the caller, and what is left of the caller's quota if there is one.

        Raises
        ------
        ProblemError
            401, 403 or 429 if the request is not allowed; 503 if the database does not answer.
        """
        try:
            caller = await self._caller(scope, dict(scope["headers"]))
        except OperationalError as error:
            raise problems.database_fault(error) from error
        needed = _needed(scope)
        if needed is not None and needed not in caller.scopes:
            detail = f"The key lacks the scope {needed}."
            raise _refused(ProblemKind.FORBIDDEN, detail, error="insufficient_scope", scope=needed)
        if caller is LOCAL:
            return caller, None
        return caller, await self._take(self._reads if needed is Scope.READ else self._changes, caller.owner)

    async def _caller(self, scope: types.Scope, headers: Headers) -> Caller:
        token = _bearer(headers)
        if self._bearers is not None and token is not None and is_token(token):
            return await self._caller_of_token(self._bearers, scope, token)
        digest = self._digest(scope, headers)
        if digest is None:
            if _is_from_this_machine(scope, headers) and await self._unguarded.get(""):
                return LOCAL
            detail = "Send a key as Authorization: Bearer; a service without keys answers its own machine only."
            raise _refused(ProblemKind.UNAUTHENTICATED, detail)
        if not self._callers.holds(digest):
            await self._count_stranger(scope)
        caller = await self._callers.get(digest)
        if caller is None:
            detail = "The key is unknown, revoked or expired."
            raise _refused(ProblemKind.UNAUTHENTICATED, detail, error="invalid_token")
        return caller

    async def _caller_of_token(self, bearers: ExpiringCache[str, Caller], scope: types.Scope, token: str) -> Caller:
        if not bearers.holds(token):
            await self._count_stranger(scope)
        try:
            return await bearers.get(token)
        except NotAccepted as error:
            detail = f"The token is not accepted: {error}."
            raise _refused(ProblemKind.UNAUTHENTICATED, detail, error="invalid_token") from error
        except IssuerUnavailable as error:
            detail = "The issuer of tokens does not give its keys, so the token cannot be checked."
            raise ProblemError(ProblemKind.UNAVAILABLE, detail, headers={"Retry-After": "5"}) from error

    async def _count_stranger(self, scope: types.Scope) -> None:
        """Limit how many unfamiliar keys and tokens one client address may try: each costs a query or a signature."""
        await self._take(self._strangers, str((scope.get("client") or ("",))[0]))

    def _digest(self, scope: types.Scope, headers: Headers) -> str | None:
        """Return the digest of the key that a request shows, itself or by its session."""
        text = _bearer(headers)
        if text is not None:
            return keys.digest_of(text)
        path = path_of(scope)
        if b"cookie" in headers and (scope["method"] in {"GET", "HEAD"} or path.startswith(f"{_PAGES}/")):
            return sessions.digest_of(self._settings, headers[b"cookie"].decode("latin-1"))
        return None

    async def _take(self, quota: Quota, client: str) -> Standing:
        standing = await self._meter.take(quota, client)
        if standing.left is None:
            detail = (
                f"{quota.most} requests of this kind a minute are allowed; try again in {standing.reset_seconds} s."
            )
            headers = {"Retry-After": str(standing.reset_seconds), **standing.fields}
            raise ProblemError(ProblemKind.TOO_MANY_REQUESTS, detail, headers=headers)
        return standing


def is_open(path: str) -> bool:
    """Tell whether an address needs no key."""
    return any(path == open_path or path.startswith(f"{open_path}/") for open_path in _OPEN)


def _bearer(headers: Headers) -> str | None:
    kind, _, text = headers.get(b"authorization", b"").decode("latin-1").partition(" ")
    return text.strip() if kind.lower() == "bearer" else None


def _needed(scope: types.Scope) -> Scope | None:
    """Return the scope that a request needs: that of its method, but a POST that cancels needs what a DELETE needs."""
    path = path_of(scope)
    cancels = scope["method"] == "POST" and path.startswith("/v1/") and path.endswith("/cancel")
    return Scope.CANCEL if cancels else _NEEDED.get(scope["method"])


def _is_from_this_machine(scope: types.Scope, headers: Headers) -> bool:
    """Tell whether a request comes from this machine and addresses it by a loopback name.

    A proxy on this machine must not forward requests from elsewhere. A page in a local browser must not reach the
    service through a name that resolves to this machine (DNS rebinding).
    """
    server, client = (str((scope.get(end) or ("",))[0]) for end in ("server", "client"))
    # Older nginx speaks HTTP/1.0 to what it forwards to, and adds no field, unless it is told to.
    forwarded = scope.get("http_version") == "1.0" or any(name in headers for name in _FORWARDED)
    return is_loopback(server) and is_loopback(client) and is_loopback(_host(headers)) and not forwarded


def _host(headers: Headers) -> str:
    try:
        return urlsplit(f"//{headers.get(b'host', b'').decode('latin-1')}").hostname or ""
    except ValueError:
        return ""


def _refused(kind: ProblemKind, detail: str, **parameters: str) -> ProblemError:
    """Return the problem for a request that is not allowed, with the challenge of RFC 6750."""
    challenge = ", ".join(f'{name}="{value}"' for name, value in {"realm": "galloping", **parameters}.items())
    return ProblemError(kind, detail, headers={"WWW-Authenticate": f"Bearer {challenge}"})


def _with_quota_fields(standing: Standing, send: types.Send) -> types.Send:
    """Return a `send` that adds the quota's header fields to the answer."""
    fields = [(name.lower().encode(), value.encode()) for name, value in standing.fields.items()]

    async def send_with_quota(message: types.Message) -> None:
        if message["type"] == "http.response.start":
            message["headers"] = [*message["headers"], *fields]
        await send(message)

    return send_with_quota


def _look_up(readers: sessionmaker[Session], writers: sessionmaker[Session], digest: str) -> Caller | None:
    with readers() as session:
        caller, use_to_record = keys.look_up(session, digest)
    if use_to_record:
        with suppress(SQLAlchemyError), writers.begin() as session:  # callers may read even if the database is full
            keys.record_use(session, digest)
    return caller


def _is_unguarded(readers: sessionmaker[Session]) -> bool:
    with readers() as session:
        return not keys.any_exist(session)
