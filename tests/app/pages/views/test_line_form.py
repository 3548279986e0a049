import json
import re
from typing import Any

import httpx
import pytest

from app.pages import examples
from app.pages.lines.line_documents import to_texts
from app.pages.measures import SI
from tests.app.pages.reading import BROWSER, read, send

FORM = "/pages/lines/new"
ALONE = {"form_units": "si"}


def texts_of(name: str, **changes: str) -> dict[str, str]:
    request = {"line": examples.line(name), "analysis": examples.ANALYSIS}
    return {**to_texts(request, SI), **ALONE, **changes}


def values(client: httpx.Client, path: str) -> dict[str, str]:
    return read(client, path).fields


def test_the_form_begins_with_an_example_or_an_earlier_line(shared_client: httpx.Client, known_job: str) -> None:
    assert values(shared_client, FORM)["line.conductor.catalogue"] == "Drake"
    assert values(shared_client, f"{FORM}?example=c11-quad")["line.span.length_m"] == "125.88"
    earlier = values(shared_client, f"{FORM}?job={known_job}")
    assert earlier["line.conductor.catalogue"] == "Drake"
    assert earlier["line.span.everyday.share_of_rated_strength"] == "0.2"
    assert earlier["line.required_clearance_m"] == "1.5"


@pytest.mark.parametrize("name", examples.NAMES)
def test_a_line_is_submitted(shared_client: httpx.Client, name: str) -> None:
    answer = send(shared_client, FORM, texts_of(name))
    assert answer.status_code == 303, re.findall(r'role="alert">(.*?)</div>', answer.text, re.DOTALL)
    status = shared_client.get(answer.headers["location"].replace("/pages/", "/v1/")).json()
    assert status["name"] == examples.line(name)["name"]


def test_faults_stand_beside_their_fields_and_what_was_typed_is_kept(shared_client: httpx.Client) -> None:
    typed = {"line.span.length_m": "-5", "line.bundle.spacing_m": "wide", "rest": '{"line": {"colour": "red"}}'}
    answer = send(shared_client, FORM, texts_of(examples.DRAKE, **typed))
    assert answer.status_code == 422
    beside = re.search(r'id="line-span-length_m-fault">(.*?)</p>', answer.text)
    assert beside is not None
    assert "greater than or equal to 1" in beside[1]
    assert 'value="-5" autocomplete="off" inputmode="decimal" aria-invalid="true"' in answer.text
    assert "/line/colour" in answer.text
    assert 'value="wide"' in answer.text


def test_the_preview_draws_the_line_and_lists_its_assumptions(shared_client: httpx.Client) -> None:
    text = send(shared_client, "/pages/lines/preview", texts_of(examples.DRAKE)).text
    assert 'class="drawing bundle"' in text
    assert 'class="drawing span"' in text
    assert "Vertical damping ratio" in text
    assert "style=" not in text
    assert "sag 6.29 m" in text
    wrong = send(shared_client, "/pages/lines/preview", texts_of(examples.DRAKE, **{"line.span.length_m": "x"})).text
    assert 'class="drawing' not in wrong
    assert re.search(r'id="line-span-length_m-fault" hx-swap-oob="true">[^<]*number', wrong)


def test_the_form_changes_its_units(shared_client: httpx.Client) -> None:
    text = send(shared_client, "/pages/lines/units", texts_of(examples.DRAKE)).text
    assert 'name="line.span.length_m" value="984.252"' in text
    assert 'name="line.span.temperature_c" value="23"' in text
    assert 'name="form_units" value="feet"' in text


def exported(answer: httpx.Response) -> dict[str, Any]:
    assert "attachment" in answer.headers["content-disposition"]
    document: dict[str, Any] = json.loads(answer.text)
    return document


def test_a_line_is_saved_and_opened_again(shared_client: httpx.Client) -> None:
    saved = exported(send(shared_client, "/pages/lines/export", texts_of("c11-triple")))
    assert saved["line"]["span"]["length_m"] == 125.88
    opened = send(shared_client, "/pages/lines/import", {"document": json.dumps(examples.line("c11-triple"))})
    assert 'name="line.span.length_m" value="125.88"' in opened.text
    for text in ("{", "[]"):
        assert send(shared_client, "/pages/lines/import", {"document": text}).status_code == 422


def test_conductors_are_offered_by_the_words_typed(shared_client: httpx.Client) -> None:
    address = "/pages/lines/conductors"
    text = shared_client.get(address, params={"line.conductor.catalogue": "dra"}, headers=BROWSER).text
    assert '<option value="Drake">' in text
    assert "28.1 mm" in text
    assert shared_client.get(address, params={"x": "no such conductor"}, headers=BROWSER).text.strip() == ""
