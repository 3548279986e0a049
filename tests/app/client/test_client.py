import csv
import gzip
import io
import json
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from uuid import UUID

import httpx
import pandas as pd
import pytest

from app.client import Client, JobFailed, Refused, ServiceError
from app.client.uploads import opened
from app.reference.source_lines import example
from app.runtime.settings import Settings
from app.schemas import Analysis, Line
from tests.app import service
from tests.app.lines import changed
from tests.documents import short_request
from tests.in_process import run_job
from tests.servers import wait_until

ANALYSIS = short_request()["analysis"]


@pytest.fixture
def client(own_client: httpx.Client) -> Iterator[Client]:
    """Give a client of a service of this test's own, whose jobs nobody works on."""
    with Client(str(own_client.base_url)) as made:
        yield made


def lines(count: int) -> list[dict[str, Any]]:
    return [
        {**example("c11-twin"), "reference": f"r{number}", "span": {**example("c11-twin")["span"], "length_m": 90.0}}
        for number in range(count)
    ]


def test_a_job_is_followed_to_its_result(client: Client, own_client: httpx.Client, own_settings: Settings) -> None:
    job = client.job(service.finished(own_client, own_settings).rpartition("/")[2])
    shown: list[tuple[float, str]] = []
    ended = client.wait(job, lambda fraction, step: shown.append((fraction, step)))
    assert (ended.status, shown[-1][0]) == ("successful", 1.0)
    assert client.results(ended).frequencies[0].loops == 1
    assert client.download(ended, "results/frequencies?format=csv").startswith(b"model,loops,")
    rows = client.rows(ended, "limit-cycles")
    frame = client.frame(ended, "limit-cycles")
    assert len(rows) == len(frame) > 3
    assert frame["wind_speed_m_per_s"].tolist() == [row["wind_speed_m_per_s"] for row in rows]
    assert b"<svg" in client.plot(ended)
    client.remove(ended)
    with pytest.raises(ServiceError, match="404"):
        client.job(ended.id)


def test_models_are_sent_as_mappings_are(client: Client) -> None:
    line = Line.model_validate(example("c11-twin"))
    ids = {client.submit(line, Analysis(loops=[1])).id, client.submit(example("c11-twin"), {"loops": [1]}).id}
    assert {job.id for job in client.jobs(limit=1)} == ids
    assert [job.status for job in client.jobs(status="accepted", limit=10)] == ["accepted"] * 2


def test_a_cancelled_job_is_an_error_of_its_own(client: Client) -> None:
    job = client.submit(example("c11-twin"))
    client.cancel(job)
    assert client.wait(job).status == "dismissed"
    assert str(JobFailed(client.wait(job))) == "the job was cancelled"


def test_waiting_has_an_end(client: Client) -> None:
    with pytest.raises(TimeoutError, match="is accepted, 0% done"):
        client.wait(client.submit(example("c11-twin")), seconds=0.0)


def test_a_refused_document_tells_its_faults(client: Client) -> None:
    with pytest.raises(Refused) as caught:
        client.submit(changed("span.length_m", -1.0))
    assert [fault.pointer for fault in caught.value.faults] == ["/line/span/length_m"]


def test_results_before_the_end_are_an_error_with_the_services_words(client: Client) -> None:
    with pytest.raises(ServiceError, match="409: The job is accepted"):
        client.results(client.submit(example("c11-twin")))


def test_lines_are_sent_from_an_iterable_a_frame_or_a_file(client: Client, tmp_path: Path) -> None:
    ndjson = "".join(json.dumps(part) + "\n" for part in ({"analysis": ANALYSIS}, *lines(3)))
    (tmp_path / "lines.ndjson").write_text(ndjson)
    (tmp_path / "lines.ndjson.gz").write_bytes(gzip.compress(ndjson.encode()))
    (tmp_path / "lines.json").write_text(json.dumps({"lines": lines(3), "analysis": ANALYSIS}))
    frame = pd.json_normalize(lines(3))
    frame.to_csv(tmp_path / "lines.csv", index=False)
    frame.map(lambda cell: json.dumps(cell) if isinstance(cell, list) else cell).to_excel(
        tmp_path / "lines.xlsx", index=False
    )
    batches = [
        client.submit_batch((line for line in lines(3)), ANALYSIS),
        client.submit_batch(frame, ANALYSIS),
        client.submit_batch(tmp_path / "lines.csv", ANALYSIS),
        client.submit_batch(tmp_path / "lines.xlsx", ANALYSIS),
        *(client.submit_batch(tmp_path / f"lines.{kind}") for kind in ("ndjson", "ndjson.gz", "json")),
    ]
    assert [(batch.lines.accepted, batch.errors) for batch in batches] == [(3, [])] * 7
    assert client.batch(batches[0].id).lines.total == 3
    with pytest.raises(ValueError, match="contains its analysis"):
        client.submit_batch(tmp_path / "lines.ndjson", ANALYSIS)
    with pytest.raises(ValueError, match="must end in one of"):
        client.submit_batch(tmp_path / "lines.ods")


def test_a_frame_may_have_booleans_lists_gaps_and_an_index(client: Client) -> None:
    first, second, third = lines(3)  # only one of them has devices, only two a bundle
    first["wind"]["profile"] = [{"position_m": 0.0, "factor": 0.9}]
    third = {**{name: part for name, part in example("c11-single").items() if name != "bundle"}, "reference": "c"}
    first["supports"] = {"left": {"dead_end": True}, "right": {"dead_end": False}}
    second["devices"] = [{"type": "detuning_pendulum", "position_m": 40.0, "mass_kg": 12.0, "arm_m": 0.3}]
    frame = pd.json_normalize([first, second, third])
    frame["reference"] = ["a", "b", "c"]
    with opened(frame.set_index("reference"), ANALYSIS) as upload:
        upload.file.seek(0)
        first_row, *_ = csv.DictReader(io.TextIOWrapper(upload.file, newline=""))
    assert (first_row["reference"], first_row["supports.left.dead_end"]) == ("a", "True")
    batch = client.submit_batch(frame.set_index("reference"), ANALYSIS)
    assert (batch.lines.accepted, batch.errors) == (3, [])


def test_an_atomic_batch_is_refused_whole(client: Client) -> None:
    with pytest.raises(Refused):
        client.submit_batch([*lines(1), changed("span.length_m", -1.0)], atomic=True)


def test_another_service_is_told_from_ours(client: Client) -> None:
    with pytest.raises(ServiceError, match="404"):
        client.job("../health/nothing")
    with pytest.raises(ServiceError, match="is not a galloping service"):
        client.job("../../health/live")


def test_the_environment_holds_what_is_not_given(own_client: httpx.Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GALLOPING_URL", str(own_client.base_url))
    with Client() as made:
        assert list(made.jobs()) == []


def test_remedies_are_compared(client: Client, own_client: httpx.Client, own_settings: Settings) -> None:
    def work() -> None:
        wait_until(lambda: bool(own_client.get("/v1/jobs").json()["jobs"]), what="a job")
        run_job(own_settings, UUID(own_client.get("/v1/jobs").json()["jobs"][0]["id"]))

    worker = threading.Thread(target=work)
    worker.start()
    tried = {"tried": [{"type": "tension", "factor": 1.2}]}
    rows = client.compare_remedies(example("c11-twin"), {"loops": [1], "wind_speeds_m_per_s": []}, tried)
    worker.join()
    assert [row["kind"] for row in rows] == ["none", "tension"]
