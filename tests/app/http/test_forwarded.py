import logging
from pathlib import Path
from typing import Any

import pytest
from pydantic import ValidationError

from app.http.forwarded import is_encrypted, own_address
from app.runtime.settings import Settings
from tests.app import service

FORWARDED = {"X-Forwarded-For": "10.9.9.9, 203.0.113.7", "X-Forwarded-Proto": "https"}


def client_seen(settings: Settings, caplog: pytest.LogCaptureFixture) -> Any:
    """Return whom the service takes for the client of a forwarded request, by its log."""
    caplog.set_level(logging.INFO, logger="app.http.request_log")
    with service.running(settings) as client:
        client.get("/v1/jobs", headers=FORWARDED)
    (seen,) = [vars(record)["client"] for record in caplog.records if record.message == "request"]
    return seen


def test_nobody_is_believed_unless_the_operator_says_so(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    assert client_seen(service.sqlite_settings(tmp_path), caplog) == "127.0.0.1"


def test_other_proxies_than_the_trusted_ones_are_not_believed(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    settings = service.sqlite_settings(tmp_path, trusted_proxies="192.0.2.1,198.51.100.0/24")
    assert client_seen(settings, caplog) == "127.0.0.1"


def test_trusted_proxy_names_its_client_and_not_what_the_client_claims(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    settings = service.sqlite_settings(tmp_path, trusted_proxies="127.0.0.0/8")
    assert client_seen(settings, caplog) == "203.0.113.7"


def test_a_forwarded_loopback_address_is_not_this_machine(tmp_path: Path) -> None:
    with service.running(service.sqlite_settings(tmp_path, trusted_proxies="127.0.0.1")) as client:
        assert client.get("/v1/jobs").status_code == 200
        assert client.get("/v1/jobs", headers={"X-Forwarded-For": "127.0.0.1"}).status_code == 401


def test_careful_headers_follow_any_proxy(tmp_path: Path) -> None:
    with service.running(service.sqlite_settings(tmp_path)) as client:
        told = client.get("/health/live", headers=FORWARDED).headers
        assert told["strict-transport-security"] == "max-age=31536000"
        assert "strict-transport-security" not in client.get("/health/live").headers
    assert is_encrypted({"scheme": "https", "headers": []})
    assert not is_encrypted({"scheme": "http", "headers": [(b"x-forwarded-proto", b"http")]})


def test_the_own_address_is_the_one_that_the_client_used() -> None:
    host = (b"host", b"grid.example:8443")
    scope = {"type": "http", "scheme": "http", "server": ("127.0.0.1", 8000), "path": "/gal/v1/jobs", "headers": [host]}
    assert own_address(scope) == "http://grid.example:8443"
    behind = {
        **scope,
        "root_path": "/gal/",
        "query_string": b"a=b",
        "headers": [host, (b"x-forwarded-proto", b"https")],
    }
    assert own_address(behind) == "https://grid.example:8443/gal"
    assert own_address({**scope, "headers": []}) == "http://127.0.0.1:8000"


def test_what_is_no_address_is_refused(tmp_path: Path) -> None:
    for text in ("*", "proxy.example", "10.0.0.1/8", "10.0.0.1, nginx"):
        with pytest.raises(ValidationError, match="is no address or network"):
            service.sqlite_settings(tmp_path, trusted_proxies=text)
