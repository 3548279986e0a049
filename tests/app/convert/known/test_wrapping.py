import httpx
import pytest

from app.convert.known.wrapping import without_wrapper
from app.reference.source_lines import example
from app.routes.own_documentation import KNOWN_LINE
from tests.documents import short_request

LINE = example("c11-twin")


@pytest.mark.parametrize("bare", [LINE, KNOWN_LINE, {**LINE, "colour": "red"}, [LINE, KNOWN_LINE]])
def test_a_line_by_itself_is_told_how_to_wrap_it(bare: object) -> None:
    found = without_wrapper(bare, '{"line": <the line>}')
    assert found is not None
    assert (found.pointer, found.code) == ("", "missing_wrapper")
    assert found.detail.endswith('post {"line": <the line>}')


@pytest.mark.parametrize("other", [{"line": LINE}, {"lines": [LINE]}, {}, [], [1], None, {"span": {}}, "line"])
def test_what_is_no_line_has_other_faults(other: object) -> None:
    assert without_wrapper(other, "") is None


@pytest.mark.parametrize("address", ["jobs", "jobs/estimate", "remedies", "previews", "batches", "batches/estimate"])
def test_every_address_that_takes_lines_tells_it(shared_client: httpx.Client, address: str) -> None:
    for bare in (LINE, KNOWN_LINE, [LINE]):
        answer = shared_client.post(f"/v1/{address}", json=bare)
        (fault,) = answer.json()["errors"]
        assert (answer.status_code, fault["code"]) == (422, "missing_wrapper"), answer.text
        assert ('"lines": [' if "batches" in address else '"line": <') in fault["detail"]
    assert shared_client.post("/v1/jobs/estimate", json=short_request()).status_code == 200
