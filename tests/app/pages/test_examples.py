import pytest

from app import convert, schemas
from app.pages import examples


@pytest.mark.parametrize("name", examples.NAMES)
def test_every_example_is_a_request_without_faults(name: str) -> None:
    document = {"line": examples.line(name), "analysis": examples.ANALYSIS}
    request = schemas.JobRequest.model_validate(convert.explicit_request(document))
    assert convert.request_faults(request) == []


def test_an_example_may_be_changed_without_changing_the_next_one() -> None:
    examples.line(examples.DRAKE)["span"]["length_m"] = 1.0
    assert examples.line(examples.DRAKE)["span"]["length_m"] == 300.0
