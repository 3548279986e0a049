import html
import json
import re
import subprocess
import sys
from uuid import UUID

import httpx
import pytest
from sqlalchemy import update

from app.reference.source_lines import example
from app.runtime.settings import Settings
from app.storage.database import make_engine, session_factory
from app.tables import FailureKind, Job, JobStatus
from tests.app import service
from tests.app.pages.reading import BROWSER, read, send
from tests.documents import short_request


def test_the_page_of_a_result_begins_with_the_verdict(shared_client: httpx.Client, known_job: str) -> None:
    page = read(shared_client, f"/pages/jobs/{known_job}")
    row = shared_client.get(f"/v1/jobs/{known_job}/results/verdict").json()["verdict"][0]
    assert row["sentence"] in page.text
    assert page.text.index("It gallops") < page.text.index("Amplitude over wind speed") < page.text.index("Assumptions")
    for part in ("What decides", "Critical wind speeds", "Clearances", "Tensions", "Downloads", "curl"):
        assert part in page.text


def test_every_download_of_the_page_is_there(shared_client: httpx.Client, known_job: str) -> None:
    addresses = read(shared_client, f"/pages/jobs/{known_job}").addresses
    files = [address for address in addresses if address.startswith(f"/v1/jobs/{known_job}/")]
    assert len(files) > 40
    for address in [files[0], *(file for file in files if "/verdict" in file)]:
        assert shared_client.get(address).status_code == 200, address


def test_the_request_runs_as_curl_and_as_python(shared_client: httpx.Client, known_job: str) -> None:
    text = shared_client.get(f"/pages/jobs/{known_job}", headers=BROWSER).text
    curl, python, document = (html.unescape(block) for block in re.findall(r"<pre[^>]*>(.*?)</pre>", text, re.DOTALL))
    answer = subprocess.run(["/bin/sh", "-c", curl], capture_output=True, check=True, timeout=60.0)
    status = json.loads(answer.stdout)
    assert (status["status"], status["reused_from"]) == ("successful", known_job)
    printed = subprocess.run([sys.executable, "-c", python], capture_output=True, text=True, check=True, timeout=60.0)
    verdict = shared_client.get(f"/v1/jobs/{known_job}/results/verdict").json()["verdict"][0]
    assert verdict["sentence"] in printed.stdout
    assert json.loads(document)["line"]["conductor"] == {"catalogue": "Drake"}


def test_curves_are_those_of_the_job(shared_client: httpx.Client, known_job: str) -> None:
    drawn = shared_client.get(f"/pages/jobs/{known_job}/curves").json()
    assert drawn["pieces"]
    assert drawn["note"] is None
    assert shared_client.get(f"/pages/jobs/{known_job}/curves?point=9").status_code == 404


def test_curves_of_a_job_that_asked_for_none_begin_at_the_onset(
    shared_client: httpx.Client, shared_settings: Settings
) -> None:
    address = service.finished(shared_client, shared_settings, short_request())
    drawn = shared_client.get(f"{address.replace('/v1/', '/pages/')}/curves").json()
    assert shared_client.get(f"{address}/results/amplitude-curves").json()["amplitude_curves"] == []
    assert min(min(piece["wind"]) for piece in drawn["pieces"]) == pytest.approx(drawn["onset"])


def test_a_waiting_job_shows_its_progress_and_can_be_cancelled(shared_client: httpx.Client) -> None:
    job = service.submit(shared_client)["id"]
    page = read(shared_client, f"/pages/jobs/{job}")
    assert "waits for a worker" in page.text
    answer = send(shared_client, f"/pages/jobs/{job}/cancel", {})
    assert answer.headers["location"] == f"/pages/jobs/{job}"
    assert "was cancelled" in read(shared_client, f"/pages/jobs/{job}").text
    kept = send(shared_client, f"/pages/jobs/{job}/cancel", {})  # it has ended meanwhile, and nobody asked to remove it
    assert kept.headers["location"] == f"/pages/jobs/{job}"
    assert send(shared_client, f"/pages/jobs/{job}/cancel", {"remove": "yes"}).headers["location"] == "/pages/jobs"


@pytest.mark.parametrize("kind", list(FailureKind))
def test_a_failed_job_says_why_and_what_to_try(
    shared_client: httpx.Client, shared_settings: Settings, kind: FailureKind
) -> None:
    job = service.submit(shared_client)["id"]
    engine = make_engine(shared_settings)
    with session_factory(engine).begin() as session:
        failed = {"status": JobStatus.FAILED, "failure_kind": kind, "failure_detail": "The reason."}
        session.execute(update(Job).where(Job.id == UUID(job)).values(**failed))
    engine.dispose()
    page = read(shared_client, f"/pages/jobs/{job}")
    assert "The reason." in page.text
    assert "What to try" in page.text


def test_a_job_is_computed_anew_on_request(shared_client: httpx.Client, known_job: str) -> None:
    answer = send(shared_client, f"/pages/jobs/{known_job}/again", {})
    assert answer.status_code == 303
    assert "waits for a worker" in shared_client.get(answer.headers["location"], headers=BROWSER).text


def test_a_motion_is_shown_in_its_course(shared_client: httpx.Client, known_job: str) -> None:
    text = shared_client.get(f"/pages/jobs/{known_job}/motion", headers=BROWSER).text
    assert "data-motion=" in text
    assert "style=" not in text
    assert shared_client.get(f"/pages/jobs/{known_job}/motion?cycle=9999").status_code == 404


@pytest.mark.parametrize("name", ["c11-single", "c11-quad"])
def test_a_line_of_the_source_has_its_page(shared_client: httpx.Client, shared_settings: Settings, name: str) -> None:
    request = {**short_request(), "line": example(name)}
    address = service.finished(shared_client, shared_settings, request)
    page = read(shared_client, address.replace("/v1/", "/pages/"))
    assert page.status == 200
    assert "Aerodynamic model" in page.text
    assert "Assumptions" not in page.text
    assert shared_client.get(address.replace("/v1/", "/pages/") + "/motion").status_code == 200


def test_a_study_shows_each_of_its_points(shared_client: httpx.Client, shared_settings: Settings) -> None:
    axes = [{"parameter": "span.length_m", "values": [110.0, 125.88]}]
    address = service.finished(shared_client, shared_settings, {**short_request(), "study": {"axes": axes}})
    path = address.replace("/v1/", "/pages/")
    sags = [re.search(r"Sag (\S+) m", read(shared_client, f"{path}?point={point}").text) for point in (0, 1)]
    assert all(sags)
    assert len({found[1] for found in sags if found}) == 2
    assert "span.length_m = 110" in read(shared_client, path).text
    assert read(shared_client, f"{path}?point=7").status == 404


def test_a_line_that_stays_at_rest_has_its_page_and_its_report(
    shared_client: httpx.Client, shared_settings: Settings
) -> None:
    twin = example("c11-twin")
    damping = {**twin["damping"], "vertical_ratio": 0.5, "horizontal_ratio": 0.5}
    request = {**short_request(), "line": {**twin, "damping": damping}}
    path = service.finished(shared_client, shared_settings, request).replace("/v1/", "/pages/")
    for address in (path, f"{path}/report"):
        page = read(shared_client, address)
        assert page.status == 200
        assert "It does not gallop" in page.text
    assert shared_client.get(f"{path}/curves").json()["pieces"] == []
