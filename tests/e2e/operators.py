"""What an operator does with a service in tests: commands of docs/deployment.md, and work that must survive them."""

import re
import shlex
from pathlib import Path
from typing import Any

import httpx

from tests.documents import long_request, short_request
from tests.embedded import submit, wait_for

PAGE = (Path(__file__).parents[2] / "docs" / "deployment.md").read_text()


def documented(program: str, **values: str) -> list[str]:
    """Return the words of the page's command, with values in place of its variables."""
    (line,) = re.findall(rf"^{program} [^#\n]*", PAGE, re.MULTILINE)
    for name, value in values.items():
        line = line.replace(f"${name}", value)
    return shlex.split(line)


def work(client: httpx.Client) -> tuple[str, str, dict[str, Any]]:
    """Have one job done and one in progress; return their addresses, and the results of the first."""
    done = submit(client, short_request())
    wait_for(client, done, "successful")
    waiting = submit(client, long_request(2))
    wait_for(client, waiting, "running")
    return done, waiting, client.get(f"{done}/results").raise_for_status().json()


def all_is_there(client: httpx.Client, done: str, waiting: str, results: dict[str, Any]) -> None:
    """Check that the results are what they were, that no job is missing, and that the one in progress ends well."""
    assert client.get(f"{done}/results").raise_for_status().json() == results
    assert {job["id"] for job in client.get("/v1/jobs").json()["jobs"]} == {
        x.rpartition("/")[2] for x in (done, waiting)
    }
    wait_for(client, waiting, "successful")
