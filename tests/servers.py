"""Private servers for tests: real redis-server and PostgreSQL on free loopback ports, ended by their own process id."""

import contextlib
import os
import pwd
import shutil
import socket
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from signal import Signals
from uuid import uuid4

import psycopg
import pytest
import redis

_POSTGRES_HOMES = Path("/usr/lib/postgresql")
_ACCOUNTS = ("postgres", "nobody")


def free_port() -> int:
    """Return a loopback port that nobody listens on just now."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


def binary(name: str) -> str:
    """Return the path of a server's binary; without one the test is skipped, and under CI it fails."""
    versions = sorted(_POSTGRES_HOMES.glob(f"*/bin/{name}"), reverse=True)
    found = shutil.which(name) or (str(versions[0]) if versions else None)
    if found is None:
        reason = f"the binary {name} is not installed"
        if os.environ.get("CI") == "true":
            pytest.fail(reason)
        pytest.skip(reason)
    return found


def wait_until(condition: Callable[[], object], seconds: float = 30.0, what: str = "the condition") -> None:
    """Look every 50 ms until the condition holds, and fail the test if it does not in time."""
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            pytest.fail(f"{what} did not come about within {seconds:g} s")
        time.sleep(0.05)


@contextlib.contextmanager
def redis_server(port: int | None = None, ending: Signals = Signals.SIGINT) -> Iterator[str]:
    """Run a Redis without persistence and give its address; it is ended by a signal."""
    at = port or free_port()
    arguments = ["--port", str(at), "--bind", "127.0.0.1", "--save", "", "--appendonly", "no", "--daemonize", "no"]
    with _directory() as directory, _process([binary("redis-server"), *arguments], directory, ending) as alive:
        client = redis.Redis(port=at)
        with contextlib.closing(client):
            wait_until(lambda: alive() and _answers(client.ping, redis.ConnectionError), what="Redis")
        yield f"redis://127.0.0.1:{at}/0"


@contextlib.contextmanager
def postgres_server() -> Iterator[str]:
    """Run a PostgreSQL with a superuser `galloping` that needs no password, and give the address of its database."""
    with postgres_directory() as directory, postgres_running(directory, free_port()) as address:
        yield address


@contextlib.contextmanager
def postgres_directory() -> Iterator[Path]:
    """Make the files of a PostgreSQL, which can be started on them again and again."""
    with _directory() as directory:
        data = str(directory / "data")
        initialize = [binary("initdb"), "-D", data, "-U", "galloping", "-A", "trust", "-E", "UTF8", "--no-sync"]
        subprocess.run(initialize, check=True, capture_output=True, cwd=directory, **_account())  # type: ignore[call-overload]
        yield directory


@contextlib.contextmanager
def postgres_running(
    directory: Path, port: int, ending: Signals = Signals.SIGINT, extra: Mapping[str, str] | None = None
) -> Iterator[str]:
    """Run a PostgreSQL on its files, and end it by a signal: SIGINT closes its connections, SIGQUIT is a crash."""
    quick = ["-c", "fsync=off", "-c", "full_page_writes=off", "-c", "unix_socket_directories="]
    where = ["-D", str(directory / "data"), "-p", str(port), "-c", "listen_addresses=127.0.0.1"]
    address = f"postgresql://galloping@127.0.0.1:{port}/postgres"
    with _process([binary("postgres"), *where, *quick], directory, ending, extra) as alive:
        wait_until(lambda: alive() and _answers(lambda: _connect(address), psycopg.Error), what="PostgreSQL")
        yield address


@contextlib.contextmanager
def postgres_database(server: str) -> Iterator[str]:
    """Make an empty database on a server for one test, give its address, and drop it."""
    name = f"test_{uuid4().hex}"
    _execute(server, f"CREATE DATABASE {name}")
    try:
        yield f"{server.rsplit('/', 1)[0]}/{name}"
    finally:
        _execute(server, f"DROP DATABASE {name} WITH (FORCE)")


def _execute(server: str, statement: str) -> None:
    with contextlib.closing(psycopg.connect(server, autocommit=True)) as connection:
        connection.execute(statement.encode())


def _connect(address: str) -> None:
    psycopg.connect(address, connect_timeout=2).close()


def _answers(question: Callable[[], object], no_answer: type[Exception]) -> bool:
    try:
        question()
    except no_answer:
        return False
    return True


def _account() -> dict[str, str]:
    """Return the account for servers that refuse to run as root: none for other users, who run them as themselves."""
    if os.geteuid() != 0:
        return {}
    known = {entry.pw_name for entry in pwd.getpwall()}
    return {"user": next(name for name in _ACCOUNTS if name in known)}


@contextlib.contextmanager
def _directory() -> Iterator[Path]:
    """Make a directory that the servers' account can use; pytest's own are closed to others."""
    with tempfile.TemporaryDirectory(prefix="galloping-test-", ignore_cleanup_errors=True) as name:
        if account := _account():
            shutil.chown(name, account["user"])
        yield Path(name)


@contextlib.contextmanager
def _process(
    command: Sequence[str],
    directory: Path,
    ending: Signals = Signals.SIGINT,
    extra: Mapping[str, str] | None = None,
) -> Iterator[Callable[[], bool]]:
    """Run a server with its output in a file, give a check that it still runs, and end it by its own id."""
    log = directory / "log"
    with log.open("ab") as output:
        process = subprocess.Popen(  # type: ignore[call-overload]
            command, stdout=output, stderr=output, cwd=directory, env={**os.environ, **(extra or {})}, **_account()
        )

    def alive() -> bool:
        if process.poll() is not None:
            pytest.fail(f"{command[0]} ended with code {process.returncode}: {log.read_text()}")
        return True

    try:
        yield alive
    finally:
        process.send_signal(ending)
        try:
            process.wait(10.0)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
