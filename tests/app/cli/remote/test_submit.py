"""`galloping submit`: Ctrl-C while it waits, and where the key comes from."""

import json
import logging
import re
import signal
import subprocess
import sys
from pathlib import Path
from uuid import UUID

import httpx
import pytest

from app.runtime.settings import Settings
from tests.app.command_line import refused, run
from tests.documents import short_request
from tests.in_process import run_job
from tests.servers import wait_until

# A shell starts what runs in the background so that it ignores Ctrl-C, and so would we if the tests run there.
HEEDING_CTRL_C = (
    sys.executable,
    "-c",
    "import os, signal, sys; signal.signal(signal.SIGINT, signal.SIG_DFL); os.execv(sys.argv[1], sys.argv[1:])",
)


def written(directory: Path) -> str:
    path = directory / "line.json"
    path.write_text(json.dumps(short_request()))
    return str(path)


def test_ctrl_c_says_the_job_and_how_to_go_on(
    own_client: httpx.Client, own_settings: Settings, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    url = str(own_client.base_url).rstrip("/")
    command = [sys.executable, "-m", "app.cli", "submit", written(tmp_path), "--wait", "--url", url]
    with (
        caplog.at_level(logging.DEBUG, "app.http.request_log"),
        subprocess.Popen(
            [*HEEDING_CTRL_C, *command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        ) as waiting,
    ):
        wait_until(lambda: any(getattr(record, "method", "") == "GET" for record in caplog.records), what="a poll")
        waiting.send_signal(signal.SIGINT)
        out, told = waiting.communicate(timeout=30.0)
    assert (waiting.returncode, out) == (130, "")
    (job,) = own_client.get("/v1/jobs").json()["jobs"]
    assert f"job {job['id']} goes on; its results will be at {url}/v1/jobs/{job['id']}/results" in told
    commands = [text.split()[1:] for text in re.findall(r"`(galloping .*?)`", told)]
    assert [command[:2] for command in commands] == [["jobs", "wait"], ["jobs", "results"], ["jobs", "cancel"]]
    run_job(own_settings, UUID(job["id"]))
    ended, results, cancelled = (run(*command).stdout for command in commands)
    assert json.loads(ended)["status"] == "successful"
    assert json.loads(results)["limit_cycles"]
    assert "its results are kept" in cancelled


def test_the_key_is_read_from_a_file(own_client: httpx.Client, own_settings: Settings, tmp_path: Path) -> None:
    place = ("--data-dir", str(own_settings.data_dir))
    key = run("keys", "create", "--owner", "acme", *place).stdout
    file, line, url = tmp_path / "key", written(tmp_path), str(own_client.base_url)
    file.write_text(key)
    assert "401" in run("submit", line, "--url", url).stderr
    assert json.loads(run("submit", line, "--url", url, "--key-file", str(file)).stdout)["status"] == "accepted"
    assert "nothing cannot be read" in refused("submit", line, "--url", url, "--key-file", str(tmp_path / "nothing"))


def test_an_output_that_cannot_be_written_sends_nothing(own_client: httpx.Client, tmp_path: Path) -> None:
    nowhere = str(tmp_path / "none" / "result.json")
    told = refused("submit", written(tmp_path), "--url", str(own_client.base_url), "--output", nowhere)
    assert f"{nowhere} cannot be written" in told
    assert own_client.get("/v1/jobs").json()["jobs"] == []
