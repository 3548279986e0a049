"""The embedded service on a disk of its own that is full for a while; a tmpfs of 32 MB, which only root can mount."""

import contextlib
import errno
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from tests.documents import hasty_settings, long_request, short_request
from tests.faults import figures
from tests.processes import running
from tests.servers import free_port, wait_until

MEGABYTES = 32
MOST_POSTS = 200
LONGEST_SECONDS = 120.0


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """Give a small disk that is empty."""
    place = tmp_path / "disk"
    place.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", f"size={MEGABYTES}m", "galloping-test", str(place)]
    if subprocess.run(command, capture_output=True, check=False).returncode != 0:
        pytest.skip("mounting a small disk takes more rights than there are")
    try:
        yield place
    finally:
        subprocess.run(["umount", str(place)], check=True)


@contextlib.contextmanager
def filled(disk: Path) -> Iterator[None]:
    """Leave no byte of the disk free."""
    ballast = disk / "ballast"
    with contextlib.suppress(OSError), ballast.open("wb", buffering=0) as file:
        while True:
            file.write(bytes(4096))
    with pytest.raises(OSError, match="No space left") as refused:
        (disk / "more").write_bytes(bytes(4096))
    assert refused.value.errno == errno.ENOSPC
    try:
        yield
    finally:
        ballast.unlink()
        (disk / "more").unlink()


def state(client: httpx.Client, location: str) -> str:
    found: str = client.get(location).raise_for_status().json()["status"]
    return found


def is_ready(client: httpx.Client) -> bool:
    try:
        return client.get("/health/ready").is_success
    except httpx.TransportError:
        return False


def test_a_full_disk_refuses_work_and_loses_none(small_disk: Path) -> None:
    settings, port = hasty_settings(small_disk), free_port()
    arguments = ["serve", "--port", str(port), "--data-dir", str(small_disk)]
    with (
        httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=60.0) as client,
        running(settings, "-m", "app.cli", *arguments),
    ):
        wait_until(lambda: is_ready(client), 60.0, "readiness")
        first = client.post("/v1/jobs", json=long_request(6)).raise_for_status().headers["Location"]
        wait_until(lambda: state(client, first) == "running", 60.0, "a running job")
        accepted, refused = [first], 0
        with filled(small_disk):
            for number in range(MOST_POSTS):
                answer = client.post(
                    "/v1/jobs", json=short_request() | {"line": {**short_request()["line"], "name": str(number)}}
                )
                assert answer.status_code in (202, 503), answer.text
                if answer.status_code == 503:
                    refused += 1
                    break
                accepted.append(answer.headers["Location"])
            assert state(client, first) in ("running", "accepted", "successful")  # reads go on
            assert client.get("/v1/jobs?limit=1").is_success  # the first list, whose cursor is signed
            ready = client.get("/health/ready")
            assert (ready.status_code, ready.json()["checks"]["database"]) == (503, "its disk is full")
            time.sleep(2.0 * settings.lease_seconds)  # the job's end cannot be stored, and its lease runs out
        freed = time.monotonic()
        accepted.append(client.post("/v1/jobs", json=short_request()).raise_for_status().headers["Location"])
        for location in accepted:
            wait_until(lambda location=location: state(client, location) == "successful", LONGEST_SECONDS, location)  # type: ignore[misc]
        seconds = time.monotonic() - freed
    assert refused == 1
    figures.note(
        "full disk",
        {
            "size of the disk, MB": MEGABYTES,
            "posts accepted before one was refused by 503": len(accepted) - 2,
            "jobs accepted, all successful": len(accepted),
            "from room on the disk to the last end, s": round(seconds, 1),
        },
    )
