"""docker-compose.yml and Dockerfile: what they promise, and their very commands run as processes."""

import contextlib
import os
import re
import shutil
import socket
import subprocess
import sys
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import httpx
import pytest
import redis
import yaml

from tests.documents import short_request
from tests.servers import binary, free_port, postgres_database, wait_until

ROOT = Path(__file__).parents[2]
SECRETS = {
    "POSTGRES_PASSWORD": "pw1",
    "REDIS_PASSWORD": "pw2",
    "GALLOPING_SIGNING_SECRET": "pw3-and-more-random-characters",
}
NEEDED = re.compile(r"\$\{(\w+):\?[^}]+\}")
OURS = ("api", "worker", "migrations")


@pytest.fixture(scope="module")
def compose() -> dict[str, Any]:
    document: dict[str, Any] = yaml.safe_load((ROOT / "docker-compose.yml").read_text())
    return document


@pytest.fixture(scope="module")
def services(compose: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = compose["services"]
    return found


def filled(value: Any) -> Any:
    """Put the secrets in, as compose does with the variables of its environment."""
    if isinstance(value, dict):
        return {name: filled(item) for name, item in value.items()}
    if isinstance(value, list):
        return [filled(item) for item in value]
    return NEEDED.sub(lambda found: SECRETS[found[1]], value) if isinstance(value, str) else value


def code(command: list[str], environment: dict[str, str]) -> int:
    return subprocess.run(command, env=environment, check=False, capture_output=True, timeout=30.0).returncode


def test_services_wait_for_each_other_and_show_their_health(services: dict[str, Any]) -> None:
    assert set(services) == {*OURS, "postgres", "redis"}
    assert {name for name, service in services.items() if "healthcheck" in service} == set(services) - {"migrations"}
    for name in ("api", "worker"):
        waits = {other: how["condition"] for other, how in services[name]["depends_on"].items()}
        assert waits == {"migrations": "service_completed_successfully", "redis": "service_healthy"}
    assert services["migrations"]["depends_on"] == {"postgres": {"condition": "service_healthy"}}
    assert services["migrations"]["restart"] == "on-failure"  # a one-shot: started again only if it failed


def test_workers_can_be_scaled_and_only_loopback_is_published(services: dict[str, Any]) -> None:
    assert not {"ports", "container_name", "hostname", "volumes"} & set(services["worker"])
    published = {name: service["ports"] for name, service in services.items() if "ports" in service}
    assert published == {"api": ["127.0.0.1:8000:8000"]}


def test_secrets_have_no_defaults(compose: dict[str, Any]) -> None:
    text = (ROOT / "docker-compose.yml").read_text()
    assert set(NEEDED.findall(text)) == set(SECRETS)
    assert re.findall(r"\$\{\w+\}|\$\{\w+:?[-+]|\$\w", text) == []
    for service in compose["services"].values():
        for name, value in service.get("environment", {}).items():
            if re.search("PASSWORD|SECRET|AUTH", name):
                assert NEEDED.fullmatch(value), name
            if "@" in value:
                assert re.search(r"://\w*:\$\{\w+:\?[^}]+\}@", value), name


def test_our_processes_have_one_blas_thread_and_no_privileges(services: dict[str, Any]) -> None:
    image = (ROOT / "Dockerfile").read_text()
    for name in OURS:
        service = services[name]
        for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
            assert service["environment"][variable] == "1"
            assert f"{variable}=1" in image
        assert service["cap_drop"] == ["ALL"]
        assert service["security_opt"] == ["no-new-privileges:true"]
        assert service["read_only"] is True
        assert {place.partition(":")[0] for place in service["tmpfs"]} == {"/tmp", "/data"}
    for service in services.values():
        assert set(service["logging"]["options"]) == {"max-size", "max-file"}
    assert all("mem_limit" in services[name] for name in services if name != "migrations")
    assert re.search(r"^HEALTHCHECK .*--timeout=", image, re.MULTILINE)
    labelled = re.search(r'image\.version="([^"]+)"', image)
    assert labelled and labelled[1] == tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    users = re.findall(r"^USER (\S+)$", image, re.MULTILINE)
    assert users and users[-1] not in ("root", "0")
    assert "--constraint constraints.txt" in image
    copied = {word for line in re.findall(r"^COPY (?!--from)(.+) \S+$", image, re.MULTILINE) for word in line.split()}
    assert {"pyproject.toml", "constraints.txt", "README.md", "app", "engine", "worker", "migrations"} <= copied
    assert all((ROOT / name).exists() for name in copied)


def compose_command() -> list[str]:
    """Return the compose of this machine: Docker's plugin, else the program of its own; without both the test skips."""
    docker = shutil.which("docker")
    if docker is not None and code([docker, "compose", "version"], dict(os.environ)) == 0:
        return [docker, "compose"]
    return [binary("docker-compose")]


def test_compose_itself_takes_the_file() -> None:
    command = [*compose_command(), "--file", str(ROOT / "docker-compose.yml"), "config", "--quiet"]
    bare = {name: value for name, value in os.environ.items() if name not in SECRETS}
    assert code(command, {**bare, **SECRETS}) == 0
    assert code(command, bare) != 0


class Deployment:
    """The compose file's commands on this machine: other addresses in place of its host names, nothing else."""

    def __init__(self, services: Mapping[str, Any], database: str, folder: Path) -> None:
        self.ports = {"redis": free_port(), "api": free_port()}
        self.services = filled(services)
        self.folder = folder
        self.database = database

    def local(self, text: str) -> str:
        text = text.replace("postgresql://galloping:pw1@postgres:5432/galloping", self.database)
        text = text.replace("@redis:6379", f"@127.0.0.1:{self.ports['redis']}")
        text = text.replace("0.0.0.0", "127.0.0.1")
        return re.sub(r"\b8000\b", str(self.ports["api"]), text)

    def environment(self, name: str) -> dict[str, str]:
        ours = {variable: self.local(value) for variable, value in self.services[name]["environment"].items()}
        path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
        return {"PATH": path, "GALLOPING_DATA_DIR": str(self.folder), **ours}

    @contextlib.contextmanager
    def started(self, name: str, *more: str) -> Iterator[subprocess.Popen[bytes]]:
        command = [self.local(word) for word in self.services[name]["command"]]
        environment = self.environment(name)
        program = shutil.which(command[0], path=environment["PATH"]) or binary(command[0])
        with (self.folder / f"{name}.log").open("ab") as log:
            process = subprocess.Popen(
                [program, *command[1:], *more], env=environment, cwd=self.folder, stdout=log, stderr=log
            )
        try:
            yield process
        finally:
            process.terminate()
            process.wait(30.0)

    def is_healthy(self, name: str) -> bool:
        kind, *test = (self.local(word) for word in self.services[name]["healthcheck"]["test"])
        command = ["sh", "-c", *test] if kind == "CMD-SHELL" else test
        return code(command, self.environment(name)) == 0


def test_very_commands_of_the_file_run_a_job(services: dict[str, Any], postgres_address: str, tmp_path: Path) -> None:
    with contextlib.ExitStack() as stack:
        database = stack.enter_context(postgres_database(postgres_address))
        deployment = Deployment(services, database, tmp_path)
        assert not deployment.is_healthy("worker")
        stack.enter_context(deployment.started("redis", "--port", str(deployment.ports["redis"])))
        wait_until(lambda: redis_answers(deployment.ports["redis"]), what="Redis with its password")
        with deployment.started("migrations") as migrations:
            assert migrations.wait(60.0) == 0
        stack.enter_context(deployment.started("api"))
        wait_until(lambda: answers(deployment.ports["api"]), what="the API")
        assert deployment.is_healthy("api")
        stack.enter_context(deployment.started("worker"))
        stack.enter_context(deployment.started("worker"))
        wait_until((tmp_path / "worker-alive").exists, what="a worker's sign of life")
        assert deployment.is_healthy("worker")
        run_a_job(f"http://127.0.0.1:{deployment.ports['api']}")


def run_a_job(address: str) -> None:
    with httpx.Client(base_url=address, timeout=30.0) as client:
        location = client.post("/v1/jobs", json=short_request()).raise_for_status().headers["Location"]
        wait_until(lambda: client.get(location).json()["status"] == "successful", 60.0, "the end of the job")
        assert client.get(f"{location}/results/limit-cycles").raise_for_status().json()


def answers(port: int) -> bool:
    with socket.socket() as knock:
        return knock.connect_ex(("127.0.0.1", port)) == 0


def redis_answers(port: int) -> bool:
    """Tell whether the server is up with the password, and assert that it refuses to talk without."""
    with redis.Redis(port=port, password=SECRETS["REDIS_PASSWORD"]) as client:
        try:
            client.ping()
        except redis.ConnectionError:
            return False
    with redis.Redis(port=port) as stranger, pytest.raises(redis.AuthenticationError):
        stranger.ping()
    return True
