"""Authentication, authorization and quotas for every request. Addresses not listed as open need a key or a token."""

import logging
from contextlib import suppress
from functools import partial

from fastapi import Request
from sqlalchemy.exc import OperationalError, SQLAlchemyError
from sqlalchemy.orm import Session, sessionmaker
from starlette import types

from app.coalescing.expiring_cache import ExpiringCache
from app.http import problems
from app.http.prefix import path_of
from app.http.problems import ProblemError, ProblemKind
from app.runtime.settings import Settings
from app.runtime.signing import SecretUnavailable
from app.security import keys, sessions
from app.security.caller import LOCAL, Caller, Scope
from app.security.origins import Headers, is_from_this_machine, is_of_another_site, is_told_of_another_site
from app.security.quotas import Meter, Quota, Standing
from app.security.sessions import Shown
from app.security.strangers import Strangers
from app.security.tokens import IssuerUnavailable, NotAccepted, is_token, tokens_of
from app.security.under_way import while_admitted

_OPEN = ("/docs", "/health", "/openapi.json", "/pages/assets", "/pages/sign-in", "/problems")
_PAGES = "/pages"
_NEEDED = {"GET": Scope.READ, "POST": Scope.SUBMIT, "PUT": Scope.SUBMIT, "PATCH": Scope.SUBMIT, "DELETE": Scope.CANCEL}

_logger = logging.getLogger(__name__)


class Gate:
    """ASGI middleware that admits requests with a valid key, the right scope and remaining quota.

    While no key exists, the service answers its own machine only, without quotas, and no page of another site in a
    browser there. A browser may show a session in place of a key to read, and to send the forms of pages, which have
    marks of their own against forgery. The gate stores the caller in the request's state as `caller`, and ends a
    request under way whose caller is no longer admitted.
    """

    def __init__(
        self,
        app: types.ASGIApp,
        settings: Settings,
        readers: sessionmaker[Session],
        callers: ExpiringCache[Shown, Caller | None],
        meter: Meter,
        strangers: Strangers,
    ) -> None:
        """Wrap an application."""
        self.app = app
        self._settings = settings
        self._meter = meter
        self._strangers = strangers
        self._callers = callers
        self._tokens = tokens_of(settings)
        self._bearers = ExpiringCache(self._tokens.caller, settings.key_cache_seconds) if self._tokens else None
        self._unguarded: ExpiringCache[str, bool] = ExpiringCache(
            lambda _: self._tokens is None and _is_unguarded(readers), settings.key_cache_seconds
        )
        self._reads = Quota("reads", settings.reads_per_minute)
        self._changes = Quota("changes", settings.changes_per_minute)

    async def __call__(self, scope: types.Scope, receive: types.Receive, send: types.Send) -> None:
        """Serve one request."""
        if scope["type"] != "http" or is_open(path_of(scope)):
            await self.app(scope, receive, send)
            return
        headers = dict(scope["headers"])
        try:
            caller, standing = await self._admit(scope, headers)
        except ProblemError as problem:
            await _answer(problem, scope, receive, send)
            return
        scope.setdefault("state", {})["caller"] = caller
        answering = _Answering(standing, send)
        look = partial(self._caller, scope, headers, counted=False)
        ended = await while_admitted(
            lambda admitted: self.app(scope, admitted, answering.send), receive, look, self._settings.key_cache_seconds
        )
        if ended is None:
            return
        _logger.warning("a request of %s is ended: %s", caller.owner, ended.detail)
        if not answering.has_begun:  # otherwise the answer stays without its end, so that nobody takes it for whole
            ended.headers = {**(ended.headers or {}), "Connection": "close"}  # the body may be under way, too
            await _answer(ended, scope, receive, send)

    async def _admit(self, scope: types.Scope, headers: Headers) -> tuple[Caller, Standing | None]:
        """Return the caller, and what is left of the caller's quota if there is one.

        Raises
        ------
        ProblemError
            401, 403 or 429 if the request is not allowed; 503 if the database does not answer.
        """
        try:
            caller = await self._caller(scope, headers)
        except OperationalError as error:
            raise problems.database_fault(error) from error
        except SecretUnavailable as error:
            raise problems.secret_fault(error) from error
        needed = _needed(scope)
        if needed is not None and needed not in caller.scopes:
            detail = f"The key lacks the scope {needed}."
            raise _refused(ProblemKind.FORBIDDEN, detail, error="insufficient_scope", scope=needed)
        if caller is LOCAL:
            return caller, None
        quota = self._reads if needed is Scope.READ else self._changes
        return caller, _within(await self._meter.take(quota, caller.owner))

    async def _caller(self, scope: types.Scope, headers: Headers, *, counted: bool = True) -> Caller:
        """Return the caller whom a request shows; count its try of an unfamiliar key or token."""
        token = _bearer(headers)
        if self._bearers is not None and token is not None and is_token(token):
            return await self._caller_of_token(self._bearers, scope, token)
        shown = self._shown(scope, headers)
        if shown is None:
            return await self._local(scope, headers)
        if counted and not self._callers.holds(shown):
            _within(await self._strangers.try_key(scope, shown.digest))
        caller = await self._callers.get(shown)
        if caller is None:
            detail = "The key is unknown, revoked or expired."
            raise _refused(ProblemKind.UNAUTHENTICATED, detail, error="invalid_token")
        return caller

    async def _local(self, scope: types.Scope, headers: Headers) -> Caller:
        """Return the caller of a service without keys."""
        if not (is_from_this_machine(scope, headers) and await self._unguarded.get("")):
            detail = "Send a key as Authorization: Bearer; a service without keys answers its own machine only."
            raise _refused(ProblemKind.UNAUTHENTICATED, detail)
        if is_of_another_site(scope, headers, self._settings.cors_origins):
            raise ProblemError(ProblemKind.FORBIDDEN, "A page of another site may not use a service without keys.")
        return LOCAL

    async def _caller_of_token(self, bearers: ExpiringCache[str, Caller], scope: types.Scope, token: str) -> Caller:
        if not bearers.holds(token) and self._tokens is not None and not self._tokens.may_accept(token):
            _within(await self._strangers.count(scope))
        try:
            return await bearers.get(token)
        except NotAccepted as error:
            detail = f"The token is not accepted: {error}."
            raise _refused(ProblemKind.UNAUTHENTICATED, detail, error="invalid_token") from error
        except IssuerUnavailable as error:
            detail = "The issuer of tokens does not give its keys, so the token cannot be checked."
            raise ProblemError(ProblemKind.UNAVAILABLE, detail, headers={"Retry-After": "5"}) from error

    def _shown(self, scope: types.Scope, headers: Headers) -> Shown | None:
        """Return the key that a request shows, itself or by its session."""
        text = _bearer(headers)
        if text is not None:
            return Shown(keys.digest_of(text))
        path = path_of(scope)
        if is_told_of_another_site(scope, headers):
            return None
        if b"cookie" in headers and (scope["method"] in {"GET", "HEAD"} or path.startswith(f"{_PAGES}/")):
            return sessions.shown_by(self._settings, headers[b"cookie"].decode("latin-1"))
        return None


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


def _refused(kind: ProblemKind, detail: str, **parameters: str) -> ProblemError:
    """Return the problem for a request that is not allowed, with the challenge of RFC 6750."""
    challenge = ", ".join(f'{name}="{value}"' for name, value in {"realm": "galloping", **parameters}.items())
    return ProblemError(kind, detail, headers={"WWW-Authenticate": f"Bearer {challenge}"})


def _within(standing: Standing | None) -> Standing | None:
    """Return where a client stands with a quota; raise 429 if it is used up."""
    if standing is not None and standing.left is None:
        most, seconds = standing.quota.most, standing.reset_seconds
        detail = f"{most} requests of this kind a minute are allowed; try again in {seconds} s."
        headers = {"Retry-After": str(seconds), **standing.fields}
        raise ProblemError(ProblemKind.TOO_MANY_REQUESTS, detail, headers=headers)
    return standing


async def _answer(problem: ProblemError, scope: types.Scope, receive: types.Receive, send: types.Send) -> None:
    answer = await problems.answer(Request(scope), problem)
    await answer(scope, receive, send)


class _Answering:
    """Sends an answer with the fields of the caller's quota, and knows whether it has begun."""

    def __init__(self, standing: Standing | None, send: types.Send) -> None:
        fields = standing.fields if standing is not None else {}
        self._fields = [(name.lower().encode(), value.encode()) for name, value in fields.items()]
        self._send = send
        self.has_begun = False

    async def send(self, message: types.Message) -> None:
        if message["type"] == "http.response.start":
            self.has_begun = True
            message["headers"] = [*message["headers"], *self._fields]
        await self._send(message)


def known_callers(
    readers: sessionmaker[Session], writers: sessionmaker[Session], seconds: float
) -> ExpiringCache[Shown, Caller | None]:
    """Return the callers of keys and sessions, looked up every so many seconds; None for what admits nobody."""
    return ExpiringCache(partial(_look_up, readers, writers), seconds)


def _look_up(readers: sessionmaker[Session], writers: sessionmaker[Session], shown: Shown) -> Caller | None:
    with readers() as session:
        caller, use_to_record = keys.look_up(session, shown.digest)
        if shown.session is not None and sessions.is_ended(session, shown.session):
            return None
    if use_to_record:
        with suppress(SQLAlchemyError), writers.begin() as session:  # callers may read even if the database is full
            keys.record_use(session, shown.digest)
    return caller


def _is_unguarded(readers: sessionmaker[Session]) -> bool:
    with readers() as session:
        return not keys.any_exist(session)
