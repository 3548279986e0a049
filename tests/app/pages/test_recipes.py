import ast
import json

from app.pages.recipes import recipes, said, without_nulls
from app.tables import Job
from tests.app.pages.known_jobs import known_request


def job() -> Job:
    request = known_request()
    known = {"line": request["line"]}
    return Job(document={"line": {"name": "explicit"}, "analysis": request["analysis"], "known": known})


def test_a_request_is_repeated_as_it_was_said() -> None:
    assert said(job().document) == known_request()
    assert without_nulls({"a": None, "b": [{"c": None, "d": 0}]}) == {"b": [{"d": 0}]}


def test_curl_sends_the_document_with_a_key_where_one_is_needed() -> None:
    made = recipes(job(), "http://127.0.0.1:8000", with_key=True)
    head, _, rest = made.curl.partition("<<'END'\n")
    assert "http://127.0.0.1:8000/v1/jobs" in head
    assert "Bearer $GALLOPING_KEY" in head
    assert json.loads(rest.removesuffix("\nEND")) == known_request()
    assert "Bearer" not in recipes(job(), "http://127.0.0.1:8000", with_key=False).curl


def test_the_python_form_is_a_program_with_the_same_request() -> None:
    tree = ast.parse(recipes(job(), "http://127.0.0.1:8000", with_key=False).python)
    (assigned,) = (node.value for node in tree.body if isinstance(node, ast.Assign))
    assert ast.literal_eval(assigned) == known_request()
