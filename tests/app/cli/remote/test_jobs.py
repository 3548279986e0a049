"""`galloping jobs` against a real service, whose jobs are worked off in this process."""

import json
from pathlib import Path
from uuid import uuid4

import httpx
import pytest

from app.runtime.settings import Settings
from tests.app import service
from tests.app.command_line import on_a_terminal, refused, run
from tests.documents import short_request


def test_a_job_is_listed_shown_waited_for_and_read(
    own_client: httpx.Client, own_settings: Settings, tmp_path: Path
) -> None:
    at = ("--url", str(own_client.base_url))
    line = {**short_request()["line"], "asset_id": "L204-S017", "tags": {"region": "north"}}
    job = service.finished(own_client, own_settings, {**short_request(), "line": line}).rpartition("/")[2]
    service.submit(own_client)
    for filters in (["--status", "successful"], ["--asset-id", "L204-S017"], ["--tag", "region:north"]):
        (only,) = json.loads(run("jobs", "list", *filters, *at).stdout)["jobs"]
        assert only["id"] == job
    assert len(json.loads(run("jobs", "list", *at).stdout)["jobs"]) == 2
    assert len(json.loads(run("jobs", "list", "--limit", "1", *at).stdout)["jobs"]) == 1
    assert "100%" in on_a_terminal("jobs", "list", *at)
    assert json.loads(run("jobs", "show", job, *at).stdout)["asset_id"] == "L204-S017"
    assert "tags              region north" in on_a_terminal("jobs", "show", job, *at)
    waited = run("jobs", "wait", job, *at)
    assert (waited.returncode, json.loads(waited.stdout)["status"]) == (0, "successful")
    assert json.loads(run("jobs", "results", job, *at).stdout)["limit_cycles"]
    assert "Stable motions" in on_a_terminal("jobs", "results", job, *at)
    table = ("jobs", "results", job, "--table", "critical-wind-speeds")
    (row,) = json.loads(run(*table, *at).stdout)["critical_wind_speeds"]
    assert row["wind_speed_m_per_s"] == pytest.approx(2.40, abs=0.01)
    assert run(*table, "--format", "csv", *at).stdout.startswith("model,loops,")
    assert "2.403 " in on_a_terminal(*table, *at)
    named = tmp_path / "onsets.csv"
    assert run(*table, "--output", str(named), *at).returncode == 0
    assert named.read_text().startswith("model,loops,")  # the name says the format
    assert "name it with --table" in refused("jobs", "results", job, "--format", "csv", *at)


def test_a_job_is_cancelled(own_client: httpx.Client) -> None:
    at = ("--url", str(own_client.base_url))
    job = service.submit(own_client)["id"]
    early = run("jobs", "results", job, *at)
    assert early.returncode == 1
    assert "it is accepted, 0% done" in early.stderr and f"`galloping jobs wait {job}" in early.stderr
    assert f"{job} is cancelled" in run("jobs", "cancel", job, *at).stdout
    waited = run("jobs", "wait", job, *at)
    assert (waited.returncode, json.loads(waited.stdout)["status"]) == (1, "dismissed")


def test_what_the_service_does_not_have_is_said(own_client: httpx.Client) -> None:
    at = ("--url", str(own_client.base_url))
    for command in ("show", "results", "wait", "cancel"):
        ended = run("jobs", command, str(uuid4()), *at)
        assert (ended.returncode, ended.stdout) == (1, "")
        assert "has no job and no batch" in ended.stderr
    assert "UUID" in refused("jobs", "show", "L204", *at)
