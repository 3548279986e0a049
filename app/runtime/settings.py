"""The operator's settings: one typed object, read from `GALLOPING_...` environment variables."""

import os
import re
from functools import cache
from ipaddress import ip_network
from pathlib import Path
from typing import Annotated, Any, Literal
from urllib.parse import urlsplit

from pydantic import AliasChoices, Field, FilePath, SecretStr, field_validator, model_validator
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict

from app.runtime.loopback import is_loopback
from app.runtime.weak_secrets import weak_secrets

_PREFIX = "GALLOPING_"
_SECRETS = ("database_url", "broker_url", "signing_secret")  # the addresses hold passwords

_SECRET_NAMES = AliasChoices("GALLOPING_SIGNING_SECRET", "GALLOPING_CURSOR_SECRET")  # the second is deprecated

_EMBEDDED_BYTES, _SERVER_BYTES = 10_000_000_000, 100_000_000_000

_ORIGIN = re.compile(r"https?://[^/\s?#]+")

Seconds = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Count = Annotated[int, Field(ge=1)]
Bound = Annotated[int, Field(ge=0)]  # zero is no bound


def _default_database(data: dict[str, object]) -> str:
    return f"sqlite:///{data['data_dir']}/galloping.sqlite3"


def _default_broker(_: dict[str, object]) -> str:
    return "filesystem://localhost"


def _default_stored_bytes(data: dict[str, object]) -> int:
    return _EMBEDDED_BYTES if str(data.get("database_url")).startswith("sqlite") else _SERVER_BYTES


def _usable_processors() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Settings(BaseSettings):
    """Settings of the service, its workers and the command line; the defaults need no other server.

    Raises
    ------
    pydantic.ValidationError
        If a value is out of bounds, two settings conflict, or a secret is easy to guess.
    """

    model_config = SettingsConfigDict(
        env_prefix=_PREFIX, frozen=True, extra="ignore", hide_input_in_errors=True, populate_by_name=True
    )

    data_dir: Path = Field(default=Path("data"), description="Directory for all files of the embedded service")
    database_url: str = Field(default_factory=_default_database, description="SQLAlchemy address; SQLite or PostgreSQL")
    broker_url: str = Field(default_factory=_default_broker, description="Celery broker; redis:// or filesystem://")
    signing_secret: SecretStr | None = Field(
        default=None,
        validation_alias=_SECRET_NAMES,
        description="Secret that signs cursors and webhooks; without one the service makes one in data_dir",
    )
    key_cache_seconds: Seconds = Field(default=5.0, description="Longest time that a revoked key still works")
    oidc_issuer: str | None = Field(default=None, description="OpenID Connect issuer whose tokens identify callers")
    oidc_audience: str | None = Field(
        default=None, description="Audience that a token must name; needed with an issuer"
    )
    oidc_jwks_url: str | None = Field(default=None, description="Address of the issuer's keys; it is asked if absent")
    oidc_owner_claim: str = Field(default="sub", description="Claim that names the owner; dots lead into objects")
    oidc_scope_claim: str = Field(default="scope", description="Claim with the scopes, a text with blanks or a list")
    oidc_scope_prefix: str = Field(default="galloping:", description="What precedes read, submit, cancel in the claim")
    oidc_keys_seconds: Seconds = Field(default=300.0, description="After this long the issuer's keys are fetched anew")
    reads_per_minute: Count = Field(default=60_000, description="Most GETs a minute with one owner's keys")
    changes_per_minute: Count = Field(default=6_000, description="Most other requests a minute with one owner's keys")
    strangers_per_minute: Count = Field(default=300, description="Most unfamiliar keys a minute from one address")
    running_jobs_per_owner: Bound = Field(
        default=0, description="Most jobs and chunks of one owner that run at once; 0 for no bound"
    )
    waiting_jobs_per_owner: Bound = Field(
        default=200_000, description="Most jobs and chunks of one owner that wait; 0 for no bound"
    )
    stored_bytes_per_owner: Bound = Field(
        default_factory=_default_stored_bytes,
        description="Most bytes of one owner's requests and results; 0 for no bound",
    )
    max_body_bytes: Count = Field(default=20_000_000, description="Largest request body")
    max_batch_bytes: Count = Field(default=512_000_000, description="Largest NDJSON or CSV batch, decompressed")
    max_batch_line_bytes: Count = Field(default=1_000_000, description="Longest line of text in an NDJSON or CSV batch")
    max_batch_lines: Count = Field(default=100_000, description="Most lines in a batch")
    batches_at_once: Count = Field(default=4, description="Batches that one process reads at once; others wait")
    senders_at_once: Count = Field(default=64, description="Batches that come in to one process; half of one owner")
    silent_body_seconds: Seconds = Field(default=15.0, description="Longest pause of a body that comes in")
    least_body_bytes_per_second: Count = Field(default=4000, description="Slowest body over a longer time")
    key_lease_seconds: Seconds = Field(default=15.0, description="Time until a key is free if its request died")
    chunk_seconds: Seconds = Field(default=2.0, description="Estimated work in one chunk of a batch")
    most_chunk_lines: Count = Field(default=256, description="Most lines in one chunk of a batch")

    longest_wait_seconds: Seconds = Field(default=30.0, description="Longest wait granted to `Prefer: wait`")
    stream_seconds: Seconds = Field(default=3600.0, description="Longest life of a stream of events")
    watch_seconds: Seconds = Field(default=0.3, description="Longest pause between queries for what clients wait for")
    preview_seconds: Seconds = Field(default=3.0, description="Longest computation of a line that is not stored")

    lease_seconds: Seconds = Field(default=30.0, description="A worker silent for this long loses its job")
    heartbeat_seconds: Seconds = Field(default=1.0, description="Time between a worker's two reports on its job")
    stop_seconds: Seconds = Field(
        default=5.0, description="A cancelled or lost job that does not stop within this time ends with its process"
    )
    max_attempts: Count = Field(default=3, description="Attempts before a job fails because its workers were lost")
    soft_time_limit_seconds: Seconds = Field(default=3600.0, description="A job that runs longer fails")
    hard_time_limit_seconds: Seconds = Field(default=3660.0, description="A process that runs a job longer is killed")

    webhook_private_networks: bool = Field(default=False, description="Whether webhooks may go to private networks")
    webhook_ca_file: FilePath | None = Field(default=None, description="Certificate authorities for webhook receivers")
    webhook_timeout_seconds: Seconds = Field(default=10.0, description="Longest time for one attempt to send a webhook")
    webhook_retry_seconds: Seconds = Field(default=5.0, description="First pause between attempts; later ones grow")
    webhook_attempts: Count = Field(default=8, description="Attempts to send a webhook, over some 27 hours")

    root_path: str = Field(
        default="",
        pattern=r"^(/[A-Za-z0-9._~-]+)*/?$",
        description="Prefix under which a proxy serves this service, such as /gal",
    )
    trusted_proxies: Annotated[tuple[str, ...], NoDecode] = Field(
        default=(), description="Addresses or networks of proxies whose X-Forwarded-For and -Proto count, with commas"
    )
    cors_origins: Annotated[tuple[str, ...], NoDecode] = Field(
        default=(), description="Origins of pages that may call the API, separated by commas; * for every one"
    )
    contact_name: str = Field(default="The operator of this service", description="Whom the OpenAPI document names")
    contact_email: str | None = Field(
        default=None,
        pattern=r"^[^@\s]+@[^@\s]+$",
        description="E-mail address of the operator, for the same",
    )

    log_level: Literal["debug", "info", "warning", "error"] = Field(default="info", description="Lowest level to log")
    log_format: Literal["json", "text"] = Field(default="json", description="Log format for machines or for people")

    opentelemetry: bool = Field(default=False, description="Whether to trace requests and jobs")

    api_processes: Count = Field(default=1, description="Processes that answer requests")
    drawing_processes: Count = Field(default=1, description="Pictures that one API process draws at once")
    worker_processes: Count = Field(default_factory=_usable_processors, description="Jobs that one worker runs at once")
    max_jobs_per_process: Count = Field(default=200, description="Jobs after which a worker process is replaced")
    shutdown_seconds: Seconds = Field(default=8.0, description="Time that a stopping worker gives its running jobs")
    sweep_seconds: Seconds = Field(default=2.0, description="Time between sweeps for lost leases and unsent jobs")
    redispatch_seconds: Seconds = Field(default=15.0, description="A job unclaimed for this long is sent again")
    broker_timeout_seconds: Seconds = Field(default=1.0, description="Longest wait for the broker to answer")

    @model_validator(mode="before")
    @classmethod
    def _secrets_from_files(cls, given: dict[str, Any]) -> dict[str, Any]:
        """Read a secret that is not set from the file that `GALLOPING_..._FILE` names, as containers mount them."""
        known = {name.lower().removeprefix(_PREFIX.lower()) for name in given}
        files = {name: os.environ.get(f"{_PREFIX}{name.upper()}_FILE") for name in _SECRETS if name not in known}
        return given | {name: _secret_in(name, file) for name, file in files.items() if file}

    @field_validator("data_dir")
    @classmethod
    def _absolute(cls, value: Path) -> Path:
        return value.expanduser().absolute()

    @field_validator("cors_origins", mode="before")
    @classmethod
    def _origins(cls, value: object) -> object:
        if not isinstance(value, str):
            return value
        origins = _parts(value)
        for origin in origins:
            if origin != "*" and not _ORIGIN.fullmatch(origin):
                raise ValueError(f"{origin} is no origin such as https://grid.example")
        return origins

    @field_validator("trusted_proxies", mode="before")
    @classmethod
    def _proxies(cls, value: object) -> object:
        if not isinstance(value, str):
            return value
        proxies = _parts(value)
        for proxy in proxies:
            try:
                ip_network(proxy)
            except ValueError as error:
                raise ValueError(f"{proxy} is no address or network such as 10.0.0.0/24: {error}") from error
        return proxies

    @field_validator("root_path")
    @classmethod
    def _without_last_slash(cls, value: str) -> str:
        return value.rstrip("/")

    @field_validator("database_url")
    @classmethod
    def _named_driver(cls, value: str) -> str:
        scheme, separator, rest = value.partition("://")
        drivers = {"postgresql": "postgresql+psycopg", "postgres": "postgresql+psycopg"}
        name = drivers.get(scheme, scheme)
        if name not in {"sqlite", "postgresql+psycopg"} or not separator:
            raise ValueError("must begin with sqlite:/// or postgresql://")
        return f"{name}://{rest}"

    @field_validator("broker_url")
    @classmethod
    def _known_broker(cls, value: str) -> str:
        if not value.startswith(("filesystem://", "redis://", "rediss://")):
            raise ValueError("must begin with redis://, rediss:// or filesystem://")
        return value

    @model_validator(mode="after")
    def _consistent(self) -> "Settings":
        if self.hard_time_limit_seconds <= self.soft_time_limit_seconds:
            raise ValueError("hard_time_limit_seconds must be greater than soft_time_limit_seconds")
        if self.heartbeat_seconds > self.lease_seconds / 2.0:
            raise ValueError("heartbeat_seconds must be at most half of lease_seconds")
        return self

    @model_validator(mode="after")
    def _private_issuer(self) -> "Settings":
        if self.oidc_issuer is not None and not self.oidc_audience:
            raise ValueError("oidc_audience must be set with oidc_issuer")
        for address in filter(None, (self.oidc_issuer, self.oidc_jwks_url)):
            parts = urlsplit(address)
            if parts.scheme != "https" and not (parts.scheme == "http" and is_loopback(parts.hostname or "")):
                raise ValueError(f"{address} must begin with https://")
        return self

    @model_validator(mode="after")
    def _guarded(self) -> "Settings":
        secret = self.signing_secret.get_secret_value() if self.signing_secret is not None else None
        if weak := weak_secrets(self.database_url, self.broker_url, secret):
            raise ValueError("; ".join(weak))
        return self

    @property
    def has_embedded_broker(self) -> bool:
        """Tell whether messages are files of this machine."""
        return self.broker_url.startswith("filesystem:")

    def environment(self) -> dict[str, str]:
        """Return the environment variables that pass these settings to a child process."""
        values = self.model_dump(exclude_none=True)
        plain = {k: v.get_secret_value() if isinstance(v, SecretStr) else str(v) for k, v in values.items()}
        plain |= {name: ",".join(values[name]) for name in ("cors_origins", "trusted_proxies")}
        return {_PREFIX + name.upper(): value for name, value in plain.items()}


def _parts(text: str) -> tuple[str, ...]:
    """Return the parts of a text that commas separate, without spaces and empty ones."""
    return tuple(part.strip() for part in text.split(",") if part.strip())


def _secret_in(name: str, file: str) -> str:
    try:
        return Path(file).read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise ValueError(f"{_PREFIX}{name.upper()}_FILE: {file} cannot be read: {error}") from error


@cache
def get_settings() -> Settings:
    """Return the settings of this process, read once from its environment."""
    return Settings()
