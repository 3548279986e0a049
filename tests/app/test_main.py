import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from pydantic import BaseModel

from app import convert, schemas
from app.export.formats import PARQUET, XLSX
from app.main import create_app
from app.schemas import batch, known
from tests.app import service
from tests.app.answer_modules import ANSWER_MODULES
from tests.app.lines import faults


@pytest.fixture(scope="module")
def document(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Give the OpenAPI document."""
    made: dict[str, Any] = create_app(service.sqlite_settings(tmp_path_factory.mktemp("openapi"))).openapi()
    return made


def bodies(document: dict[str, Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield place, media type and content of every body of every operation."""
    for path, operations in document["paths"].items():
        for method, operation in operations.items():
            named = {"request": operation["requestBody"]} if "requestBody" in operation else {}
            for name, body in {**named, **operation["responses"]}.items():
                for media_type, content in body.get("content", {}).items():
                    yield f"{method} {path} {name}", media_type, content


TABLES = re.compile(r"\{table\}|/batches/\{batch_id\}/results ")


def model_of(content: dict[str, Any]) -> type[BaseModel] | None:
    name = content.get("schema", {}).get("$ref", "").rpartition("/")[2]
    found = next(
        (getattr(module, name) for module in (schemas, batch, known, *ANSWER_MODULES) if hasattr(module, name)), None
    )
    return found if isinstance(found, type) and issubclass(found, BaseModel) else None


def examples(content: dict[str, Any]) -> list[Any]:
    several = [item["value"] for item in content.get("examples", {}).values()]
    return several + ([content["example"]] if "example" in content else [])


def test_the_document_is_openapi_3_1(document: dict[str, Any]) -> None:
    assert document["openapi"].startswith("3.1")
    assert "/v1/jobs/{job_id}/results/{table}" in document["paths"]


def test_every_body_of_text_has_an_example(document: dict[str, Any]) -> None:
    binary = {"image/png", "application/pdf", PARQUET, XLSX}
    missing = [
        place for place, media_type, content in bodies(document) if not examples(content) and media_type not in binary
    ]
    assert missing == []


def test_every_example_is_valid_by_its_own_schema(document: dict[str, Any]) -> None:
    checked = 0
    for place, media_type, content in bodies(document):
        model = model_of(content)
        if media_type in {"application/json", "application/problem+json"} and model is not None:
            for value in examples(content):
                model.model_validate(convert.explicit_request(value) if model is schemas.JobRequest else value)
                checked += 1
        elif media_type in {"application/json", "application/problem+json"} and not TABLES.search(place):
            # An address of tables has an example for each, which tests/app/test_result_tables.py holds.
            pytest.fail(f"{place} has no schema that its example could be held against")
    assert checked >= 50


def test_every_request_example_can_be_run(document: dict[str, Any]) -> None:
    (content,) = document["paths"]["/v1/jobs"]["post"]["requestBody"]["content"].values()
    assert len(examples(content)) >= 6
    for value in examples(content):
        assert faults(convert.explicit_request(value)) == []


def test_jobs_and_batches_take_a_line_in_either_form(document: dict[str, Any]) -> None:
    components = document["components"]["schemas"]
    forms = components["JobRequest"]["properties"]["line"]["anyOf"]
    assert [form["$ref"].rpartition("/")[2] for form in forms] == ["Line", "KnownLine"]
    spelled, engineers = components["JobRequest"]["properties"]["line"]["examples"]
    assert schemas.Line.model_validate(spelled)
    assert known.KnownLine.model_validate(engineers)
    spelled, engineers = components["BatchRequest"]["properties"]["lines"]["items"]["anyOf"]
    assert spelled["title"] != engineers["title"]
    assert all("reference" in components[form]["properties"] for form in ("BatchLine", "KnownBatchLine"))
    assert "everyday" in components["KnownSpan"]["properties"]
    assert {"section", "design_wind_m_per_s"} <= components["KnownBatchLine"]["properties"].keys()


def test_every_problem_that_an_operation_can_answer_is_named(document: dict[str, Any]) -> None:
    def statuses(method: str, path: str) -> set[str]:
        return set(document["paths"][path][method]["responses"])

    assert statuses("post", "/v1/jobs") >= {"202", "413", "415", "422", "500", "503"}
    assert statuses("get", "/v1/jobs/{job_id}/results") >= {"200", "404", "409", "410"}
    assert statuses("get", "/v1/jobs/{job_id}/results/{table}") >= {"200", "400", "404", "406", "409", "410"}
    assert statuses("delete", "/v1/jobs/{job_id}") >= {"200", "202", "204", "404"}
    assert "HTTPValidationError" not in document["components"]["schemas"]


def test_units_stand_in_the_schema(document: dict[str, Any]) -> None:
    length = document["components"]["schemas"]["Span"]["properties"]["length_m"]
    assert (length["x-unit"], length["minimum"], length["maximum"]) == ("m", 1.0, 5000.0)
    assert length["description"].endswith("[m]")


def test_every_field_has_a_description_and_an_example(document: dict[str, Any]) -> None:
    fields = [
        (f"{schema}.{name}", field)
        for schema, content in document["components"]["schemas"].items()
        for name, field in content.get("properties", {}).items()
    ]
    assert len(fields) > 200
    assert [place for place, field in fields if not field.get("description")] == []
    # What can have one value only shows it.
    assert [place for place, field in fields if not field.get("examples") and "const" not in field] == []


def test_the_interactive_documentation_is_there(tmp_path: Path) -> None:
    with service.running(service.sqlite_settings(tmp_path)) as client:
        page = client.get("/docs")
        assert page.status_code == 200
        files = re.findall(r'(?:src|href)="([^"]*)"', page.text)
        assert {name.rpartition("/")[2] for name in files} == {"swagger-ui-bundle.js", "swagger-ui.css", "data:,"}
        for name in files:
            if not name.startswith("data:"):
                answer = client.get(name)
                assert answer.status_code == 200, name
                assert answer.headers["Content-Type"].startswith(("text/javascript", "text/css")), name
                assert len(answer.content) > 100_000, name
        assert "http" not in page.headers["Content-Security-Policy"], "a stranger's script may run"
        assert client.get("/docs/assets/../conductors.csv").status_code == 404
        assert client.get("/docs/assets/%2e%2e/%2e%2e/data/conductors.csv").status_code == 404
        assert client.get("/openapi.json").json()["info"]["version"] == convert.ENGINE_VERSION


def test_every_post_takes_an_idempotency_key(document: dict[str, Any]) -> None:
    posts = {path: methods["post"] for path, methods in document["paths"].items() if "post" in methods}
    for address in ("/v1/previews", "/v1/jobs/estimate", "/v1/batches/estimate"):
        del posts[address]  # it changes nothing
    assert len(posts) >= 6
    for path, operation in posts.items():
        assert "idempotency-key" in {parameter["name"].lower() for parameter in operation["parameters"]}, path
        assert {"409", "422"} <= operation["responses"].keys(), path
