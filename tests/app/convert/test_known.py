import pytest

from app import convert
from app.reference.source_lines import example
from app.schemas.faults import BadInput
from tests.app.known_documents import CONTRACT, LINES, changed

EXPLICIT = {"explicit", "explicit without what can be assumed"}


@pytest.mark.parametrize("name", LINES)
def test_forms_beyond_the_explicit_line_are_told(name: str) -> None:
    assert convert.is_known_form(LINES[name]) is (name not in EXPLICIT)


def test_an_explicit_line_stays_the_object_that_it_is() -> None:
    line = example("c11-twin")
    assert convert.explicit_line(line) is line
    assert convert.explicit_request({"line": line})["line"] is line
    assert convert.explicit_request([1]) == [1]


def test_the_line_of_a_request_is_resolved_and_the_rest_is_kept() -> None:
    found = convert.explicit_request({"line": CONTRACT, "analysis": {"loops": [1]}})
    assert found == {"line": convert.resolve_document(CONTRACT)["line"], "analysis": {"loops": [1]}}
    assert convert.read(found).line.conductor.diameter == 0.02814


def test_faults_of_the_line_of_a_request_begin_at_its_root() -> None:
    with pytest.raises(BadInput) as caught:
        convert.explicit_request({"line": changed(conductor={"catalogue": "x"})})
    assert [fault.pointer for fault in caught.value.faults] == ["/line/conductor/catalogue"]
