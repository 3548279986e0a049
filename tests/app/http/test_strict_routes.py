"""Routes take what they know: query parameters of the API, and of forms of pages. Bodies are in test_problems."""

import httpx
import pytest

from tests.documents import short_request


@pytest.mark.parametrize(
    ("method", "address", "known"),
    [
        ("POST", "/v1/jobs?validate-only=true", "known are validate_only"),
        (
            "POST",
            "/v1/batches?atomik=true&atomic=true",
            "known are analysis, atomic, defaults, validate_only, webhook_url",
        ),
        ("POST", "/v1/lines/resolve?x=1", "there are none here"),
        ("POST", "/v1/remedies?x=1", "there are none here"),
        ("POST", "/v1/jobs/estimate?x=1", "there are none here"),
        ("PATCH", "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e?x=1", "there are none here"),
        ("GET", "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e?x=1", "there are none here"),
        ("GET", "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e/results?x=1", "there are none here"),
        ("GET", "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e/results/frequencies?x=1", "known are dialect, format"),
        ("GET", "/v1/conductors?x=1", "known are search"),
        ("POST", "/pages/examples/drake?x=1", "there are none here"),
        ("DELETE", "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e?x=1", ""),
        ("DELETE", "/v1/batches/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e?x=1", ""),
    ],
)
def test_unknown_query_parameters_are_refused(
    shared_client: httpx.Client, method: str, address: str, known: str
) -> None:
    answer = shared_client.request(method, address, json=short_request())
    assert answer.status_code == 400, answer.text
    (fault,) = answer.json()["errors"]
    assert fault["code"] == "unknown_field"
    assert fault["pointer"] in {"/query/validate-only", "/query/atomik", "/query/x"}
    assert known in fault["detail"]
    assert shared_client.get("/v1/jobs").json()["jobs"] == []


def test_a_page_is_read_with_whatever_a_link_adds(shared_client: httpx.Client) -> None:
    assert shared_client.get("/pages/jobs?utm_source=mail", headers={"Accept": "text/html"}).status_code == 200


@pytest.mark.parametrize(
    ("method", "address", "name"),
    [
        ("GET", "/v1/jobs?status=running&status=failed", "status"),
        ("GET", "/v1/jobs?limit=1&limit=1", "limit"),
        ("GET", "/v1/batches?cursor=a&limit=1&cursor=b", "cursor"),
        ("GET", "/v1/conductors?search=a&search=b", "search"),
        ("GET", "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e/results/frequencies?format=csv&format=json", "format"),
        ("GET", "/ogc/jobs?limit=1&limit=2", "limit"),
        ("GET", "/pages/jobs?cursor=a&cursor=b", "cursor"),
        ("POST", "/v1/jobs?validate_only=true&validate_only=false", "validate_only"),
        ("POST", "/v1/batches?atomic=true&atomic=false", "atomic"),
    ],
)
def test_a_parameter_that_takes_one_value_is_refused_twice(
    shared_client: httpx.Client, method: str, address: str, name: str
) -> None:
    answer = shared_client.request(method, address, json=short_request())
    assert answer.status_code == 400, answer.text
    (fault,) = answer.json()["errors"]
    assert (fault["pointer"], fault["code"]) == (f"/query/{name}", "repeated")
    assert "once" in fault["detail"]


@pytest.mark.parametrize(
    "address", ["/v1/jobs?tag=region:north&tag=crew:a", "/ogc/jobs?status=failed&status=running&type=process"]
)
def test_a_parameter_that_takes_a_list_may_be_repeated(shared_client: httpx.Client, address: str) -> None:
    assert shared_client.get(address).json()["jobs"] == []
