import csv
import io
from collections.abc import Iterator
from typing import Any
from uuid import UUID

import httpx
import pyarrow.parquet as pq
import pytest

from app.answers.results import ResultDocument
from app.export.formats import PARQUET
from app.jobs import leases
from app.runtime.settings import Settings
from app.schemas import JobRequest
from app.storage.database import make_engine, session_factory
from app.tables import FailureKind
from tests.app import service
from tests.documents import point_result, short_request

TABLES = {
    "frequencies": "frequencies",
    "internal-resonances": "internal_resonances",
    "critical-wind-speeds": "critical_wind_speeds",
    "limit-cycles": "limit_cycles",
}
STUDY = {"axes": [{"parameter": "span.horizontal_tension_n", "values": [24000.0, 30000.0]}]}


@pytest.fixture(scope="module")
def address(shared_client: httpx.Client, shared_settings: Settings) -> str:
    """Give the address of a finished job of the twin line."""
    return service.finished(shared_client, shared_settings)


@pytest.fixture(scope="module")
def study_address(shared_client: httpx.Client, shared_settings: Settings) -> str:
    """Give the address of a finished study of two tensions."""
    return service.finished(shared_client, shared_settings, {**short_request(), "study": STUDY})


def table(answer: httpx.Response) -> list[dict[str, str]]:
    assert answer.headers["content-type"].startswith("text/csv")
    return list(csv.DictReader(io.StringIO(answer.text, newline="")))


def test_the_result_is_the_document_of_the_contract(shared_client: httpx.Client, address: str) -> None:
    result = ResultDocument.model_validate_json(shared_client.get(f"{address}/results").content)
    assert result.failure is None
    assert result.critical_wind_speeds[0].wind_speed_m_per_s == pytest.approx(2.403, rel=0.005)
    amplitudes = [row.vertical_m for row in result.limit_cycles if row.kind == "periodic"]
    assert amplitudes[0] == pytest.approx(0.1568, rel=0.01)
    assert amplitudes[-1] == pytest.approx(0.2884, rel=0.01)
    document = shared_client.get(f"{address}/results").json()
    assert document["static"]["horizontal_tension_n"] == 30000.0
    assert document["den_hartog"] == {"coefficient": -0.1667, "unstable": True}


def test_the_result_gives_back_what_was_asked_with_the_defaults(shared_client: httpx.Client, address: str) -> None:
    taken = shared_client.get(f"{address}/results").json()["input"]
    request = JobRequest.model_validate(short_request())
    absent = {"study", "webhook_url", "placement", "remedies", "known"}
    assert taken == request.model_dump(mode="json", by_alias=True, exclude=absent)
    assert taken["analysis"]["harmonics"] == 5
    assert taken["line"]["supports"]["left"]["dead_end"] is False


@pytest.mark.parametrize(("path", "name"), TABLES.items())
def test_json_and_csv_hold_the_same_rows(shared_client: httpx.Client, address: str, path: str, name: str) -> None:
    rows = shared_client.get(f"{address}/results/{path}").json()[name]
    cells = table(shared_client.get(f"{address}/results/{path}", headers={"Accept": "text/csv"}))
    assert rows
    assert [{key: "" if value is None else str(value) for key, value in row.items()} for row in rows] == cells
    assert rows == shared_client.get(f"{address}/results").json()[name]


def parquet(answer: httpx.Response) -> Any:
    assert answer.status_code == 200
    assert answer.headers["content-type"] == PARQUET
    return pq.read_table(io.BytesIO(answer.content))


@pytest.mark.parametrize(("path", "name"), TABLES.items())
def test_parquet_holds_the_same_rows(shared_client: httpx.Client, address: str, path: str, name: str) -> None:
    found = parquet(shared_client.get(f"{address}/results/{path}", headers={"Accept": PARQUET}))
    assert found.to_pylist() == shared_client.get(f"{address}/results/{path}").json()[name]


def test_parquet_of_a_study_begins_with_its_axes_and_knows_units(
    shared_client: httpx.Client, study_address: str
) -> None:
    found = parquet(shared_client.get(f"{study_address}/results/limit-cycles?format=parquet"))
    axis, speed = found.schema.field(0), found.schema.field("wind_speed_m_per_s")
    assert axis.name == "span.horizontal_tension_n"
    assert (axis.metadata[b"unit"], speed.metadata[b"unit"]) == (b"N", b"m/s")
    assert set(found.column(0).to_pylist()) == {24000.0, 30000.0}


def test_the_format_parameter_wins_over_the_header(shared_client: httpx.Client, address: str) -> None:
    url = f"{address}/results/frequencies"
    assert len(table(shared_client.get(f"{url}?format=csv", headers={"Accept": "application/json"}))) == 1
    answer = shared_client.get(f"{url}?format=json", headers={"Accept": "text/csv"})
    assert answer.headers["content-type"] == "application/json"
    assert answer.headers["vary"] == "Accept, Authorization, Accept-Encoding"


@pytest.mark.parametrize(
    ("query", "accept", "status"), [("?format=ods", "*/*", 400), ("", "text/html", 406), ("?format=csv", "a/b", 200)]
)
def test_other_formats_are_refused(
    shared_client: httpx.Client, address: str, query: str, accept: str, status: int
) -> None:
    answer = shared_client.get(f"{address}/results/frequencies{query}", headers={"Accept": accept})
    assert answer.status_code == status


def test_rows_of_a_study_begin_with_its_axes(shared_client: httpx.Client, study_address: str) -> None:
    result = shared_client.get(f"{study_address}/results").json()
    ResultDocument.model_validate(result)
    axis = "span.horizontal_tension_n"
    assert [(row[axis], row["horizontal_tension_n"]) for row in result["static"]] == [
        (24000.0, 24000.0),
        (30000.0, 30000.0),
    ]
    assert [row[axis] for row in result["den_hartog"]] == [24000.0, 30000.0]
    for name in TABLES.values():
        assert {row[axis] for row in result[name]} == {24000.0, 30000.0}
    cells = table(shared_client.get(f"{study_address}/results/limit-cycles?format=csv"))
    assert next(iter(cells[0])) == axis
    assert {row[axis] for row in cells} == {"24000.0", "30000.0"}


PARTS = ["results", "results/frequencies", "results/limit-cycles?format=csv", "plots/orbit.svg"]


@pytest.mark.parametrize("part", PARTS)
def test_results_of_a_job_that_has_not_ended_are_409_with_the_way_to_its_status(
    shared_client: httpx.Client, part: str
) -> None:
    job = service.submit(shared_client)
    answer = shared_client.get(f"/v1/jobs/{job['id']}/{part}")
    assert answer.status_code == 409
    assert answer.json()["links"] == [{"rel": "status", "href": f"/v1/jobs/{job['id']}"}]
    assert "retry-after" in answer.headers


@pytest.mark.parametrize("part", PARTS)
def test_results_of_a_cancelled_job_are_410(shared_client: httpx.Client, part: str) -> None:
    job = service.submit(shared_client)
    shared_client.delete(f"/v1/jobs/{job['id']}")
    answer = shared_client.get(f"/v1/jobs/{job['id']}/{part}")
    assert answer.status_code == 410
    assert answer.headers["content-type"] == "application/problem+json"


@pytest.fixture
def failed(shared_client: httpx.Client, shared_settings: Settings) -> Iterator[str]:
    """Give the address of a study that failed at its end, with one sound and one failed point."""
    job = service.submit(shared_client, {**short_request(), "study": STUDY})
    engine = make_engine(shared_settings)
    with session_factory(engine).begin() as session:
        held = leases.claim(session, UUID(job["id"]), "test", 30.0)
        assert held is not None
        points = [point_result(0, tension=24000.0), point_result(1, tension=30000.0, failure="no start converged")]
        failure = leases.Failure(FailureKind.NO_CONVERGENCE, "half of it failed")
        assert leases.fail(session, held, failure, points)
    engine.dispose()
    yield f"/v1/jobs/{job['id']}"


def test_a_failed_job_answers_with_its_rows_and_its_failure(shared_client: httpx.Client, failed: str) -> None:
    answer = shared_client.get(f"{failed}/results")
    assert answer.status_code == 200
    result: dict[str, Any] = answer.json()
    ResultDocument.model_validate(result)
    assert result["failure"] == {"kind": "no_convergence", "detail": "half of it failed"}
    assert [row["span.horizontal_tension_n"] for row in result["frequencies"]] == [24000.0]
    assert result["failures"] == [{"span.horizontal_tension_n": 30000.0, "failure": "no start converged"}]
    assert len(result["static"]) == 1
    assert shared_client.get(failed).json()["failure"]["detail"] == "half of it failed"
    assert len(table(shared_client.get(f"{failed}/results/frequencies?format=csv"))) == 1
