import json

import httpx

from app.pages import examples
from tests.app.pages.reading import BROWSER, read, send

FORM = "/pages/lines/new"


def document_in(client: httpx.Client, path: str) -> dict[str, object]:
    text = client.get(path, headers=BROWSER).text
    inside = text.partition('class="code">')[2].partition("</textarea>")[0]
    found: dict[str, object] = json.loads(inside.replace("&#34;", '"'))
    return found


def test_the_form_begins_with_an_example_or_an_earlier_line(shared_client: httpx.Client, known_job: str) -> None:
    assert document_in(shared_client, FORM)["line"] == examples.line(examples.DRAKE)
    assert document_in(shared_client, f"{FORM}?example=c11-quad")["line"] == examples.line("c11-quad")
    line = document_in(shared_client, f"{FORM}?job={known_job}")["line"]
    assert isinstance(line, dict)
    assert line["conductor"] == {"catalogue": "Drake"}


def test_a_line_is_submitted(shared_client: httpx.Client) -> None:
    text = json.dumps({"line": examples.line("c11-twin"), "analysis": examples.ANALYSIS})
    assert send(shared_client, FORM, {"document": text}).headers["location"].startswith("/pages/jobs/")


def test_faults_are_shown_and_what_was_typed_is_kept(shared_client: httpx.Client) -> None:
    line = examples.line("c11-twin")
    line["span"]["length_m"] = -5
    answer = send(shared_client, FORM, {"document": json.dumps({"line": line})})
    assert answer.status_code == 422
    assert "/line/span/length_m" in answer.text
    assert "&#34;length_m&#34;: -5" in answer.text
    assert "not valid JSON" in send(shared_client, FORM, {"document": "{"}).text
    assert read(shared_client, FORM).status == 200
