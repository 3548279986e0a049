"""TLS before the service, by the very nginx configuration of docs/deployment.md."""

import json
import re
import ssl
import subprocess
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
import trustme

from app.reference.source_lines import example
from app.runtime.settings import Settings
from app.security import keys
from app.security.caller import Scope
from app.storage.database import make_engine, session_factory
from tests.app import service
from tests.documents import short_request
from tests.servers import binary, free_port, wait_until

PAGE = (Path(__file__).parents[2] / "docs" / "deployment.md").read_text()


@pytest.fixture(scope="module")
def settings(tmp_path_factory: pytest.TempPathFactory) -> Settings:
    return service.sqlite_settings(tmp_path_factory.mktemp("tls"))


@pytest.fixture(scope="module")
def proxied(settings: Settings) -> Iterator[httpx.Client]:
    """Give a client that reaches the service through nginx by TLS, without a key."""
    folder, port = settings.data_dir.parent, free_port()
    authority = trustme.CA()
    own = authority.issue_cert("127.0.0.1")
    own.private_key_pem.write_to_path(folder / "key.pem")
    for part in own.cert_chain_pems:
        part.write_to_path(folder / "chain.pem", append=True)
    trust = ssl.create_default_context()
    authority.configure_trust(trust)
    with service.running(settings) as direct:
        (folder / "nginx.conf").write_text(_configuration(folder, port, direct.base_url.netloc.decode()))
        process = subprocess.Popen(
            [binary("nginx"), "-e", "stderr", "-p", str(folder), "-c", str(folder / "nginx.conf")]
        )
        try:
            with httpx.Client(base_url=f"https://127.0.0.1:{port}", verify=trust, timeout=30.0) as client:
                wait_until(lambda: process.poll() is not None or _answers(client), what="nginx")
                yield client
        finally:
            process.terminate()
            process.wait(10.0)


def _configuration(folder: Path, port: int, upstream: str) -> str:
    (server,) = re.findall(r"```nginx\n(.*?)```", PAGE, re.DOTALL)
    here = {
        "listen 443": f"listen 127.0.0.1:{port}",
        "127.0.0.1:8000": upstream,
        "/etc/ssl/galloping.pem": str(folder / "chain.pem"),
        "/etc/ssl/galloping.key": str(folder / "key.pem"),
    }
    for said, meant in here.items():
        assert server.count(said) == 1
        server = server.replace(said, meant)
    temporary = "".join(
        f"{kind}_temp_path {folder}/temporary;\n" for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    )
    alone = f"daemon off;\nmaster_process off;\npid {folder}/nginx.pid;\nevents {{}}\n"
    return f"{alone}http {{\naccess_log off;\n{temporary}{server}}}\n"


def _answers(client: httpx.Client) -> bool:
    try:
        return client.get("/health/live").status_code == 200
    except httpx.TransportError:
        return False


def test_keys_jobs_streams_and_batches_pass(proxied: httpx.Client, settings: Settings) -> None:
    assert proxied.get("/v1/jobs").status_code == 401  # a proxy is not this machine, though there is no key yet
    engine = make_engine(settings)
    with session_factory(engine).begin() as session:
        _, key = keys.create(session, "north-grid", tuple(Scope), None, None)
    engine.dispose()
    proxied.headers["Authorization"] = f"Bearer {key}"
    wait_until(lambda: proxied.get("/v1/jobs").status_code == 200, what="the key")

    landing = proxied.get("/ogc/").json()
    assert {link["href"].startswith(str(proxied.base_url)) for link in landing["links"]} == {True}

    accepted = proxied.post("/v1/jobs", json=short_request())
    assert accepted.status_code == 202, accepted.text
    address = accepted.headers["Location"]
    assert proxied.get(address).json()["status"] == "accepted"
    with proxied.stream("GET", f"{address}/events") as answer:
        lines = answer.iter_lines()
        assert next(lines)  # nothing more happens, so a proxy that collects an answer would hold this line
        proxied.post(f"{address}/cancel").raise_for_status()
        assert any("dismissed" in line for line in lines)

    large = [
        json.dumps({"analysis": {"loops": [1]}}),
        *(json.dumps(example("c11-twin")).ljust(100_000) for _ in "x" * 15),
    ]
    taken = proxied.post("/v1/batches", content="\n".join(large), headers={"Content-Type": "application/x-ndjson"})
    assert taken.status_code == 202, taken.text
    assert taken.json()["lines"]["total"] == 15
