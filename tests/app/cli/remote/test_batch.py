"""`galloping batch` against a real service with a real worker's work done in this process."""

import json
import threading
from pathlib import Path

import httpx
import pandas as pd

from app.reference.source_lines import example
from app.runtime.settings import Settings
from tests.app import service
from tests.app.command_line import on_a_terminal, refused, run
from tests.app.lines import SHORT
from tests.servers import wait_until


def written(directory: Path, *lengths: float) -> tuple[str, ...]:
    line = example("c11-twin")
    rows = [{**line, "reference": f"L{x:g}", "span": {**line["span"], "length_m": x}} for x in lengths]
    frame = pd.json_normalize(rows)
    cells = frame.map(lambda cell: json.dumps(cell) if isinstance(cell, list) else cell)
    cells.to_csv(directory / "lines.csv", index=False)
    (directory / "analysis.json").write_text(json.dumps(SHORT))
    return (str(directory / "lines.csv"), "--analysis", str(directory / "analysis.json"))


def work_off_when_sent(client: httpx.Client, settings: Settings) -> threading.Thread:
    def work() -> None:
        wait_until(lambda: client.get("/v1/batches").json()["batches"], what="a batch")
        (batch,) = client.get("/v1/batches").json()["batches"]
        service.work_off(client, settings, f"/v1/batches/{batch['id']}")

    thread = threading.Thread(target=work)
    thread.start()
    return thread


def test_a_file_of_lines_is_sent_and_its_rows_printed(
    own_client: httpx.Client, own_settings: Settings, tmp_path: Path
) -> None:
    at = ("--url", str(own_client.base_url))
    worker = work_off_when_sent(own_client, own_settings)
    ended = run("batch", *written(tmp_path, 100.0, 120.0, -5.0), *at)
    worker.join()
    assert ended.returncode == 1
    assert "row 4: /span/length_m: input should be greater than or equal to 1, got -5" in ended.stderr
    assert "2 of 3 lines have results: 0 failed, 1 rejected, 0 cancelled" in ended.stderr
    rows = json.loads(ended.stdout)["summary"]
    assert [(row["reference"], row["status"]) for row in rows] == [
        ("L100", "successful"),
        ("L120", "successful"),
        ("L-5", "rejected"),
    ]
    (batch,) = own_client.get("/v1/batches").json()["batches"]
    shown = on_a_terminal("jobs", "results", batch["id"], *at)
    assert "L120" in shown and "rejected" in shown
    onsets = ("jobs", "results", batch["id"], "--table", "critical-wind-speeds", "--format", "csv")
    assert len(run(*onsets, *at).stdout.splitlines()) == 3
    assert json.loads(run("jobs", "show", batch["id"], *at).stdout)["lines"]["total"] == 3


def test_a_batch_need_not_be_waited_for(own_client: httpx.Client, tmp_path: Path) -> None:
    at = ("--url", str(own_client.base_url))
    sent = json.loads(run("batch", *written(tmp_path, 100.0), "--no-wait", *at).stdout)
    assert (sent["status"], sent["lines"]["accepted"]) == ("accepted", 1)
    assert f"{sent['id']} is cancelled" in run("jobs", "cancel", sent["id"], *at).stdout


def test_a_file_that_cannot_be_sent_is_refused(own_client: httpx.Client, tmp_path: Path) -> None:
    at = ("--url", str(own_client.base_url))
    assert "No such file" in refused("batch", str(tmp_path / "none.csv"), *at)
    assert "must end in one of" in refused("batch", str(tmp_path / "lines.ods"), *at)
    assert "/span/length_m" in refused("batch", *written(tmp_path, -5.0), "--atomic", *at)
