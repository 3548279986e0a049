from urllib.parse import parse_qsl, urlencode

import httpx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.pages import forms
from app.pages.forms import local_path
from tests.app.pages.reading import BROWSER, read


@pytest.mark.parametrize("elsewhere", ["//evil.example", "/\\evil.example", "https://evil.example", "", "a\nb"])
def test_a_way_back_stays_in_the_service(elsewhere: str) -> None:
    assert local_path(elsewhere) == "/"
    assert local_path("/pages/jobs?cursor=1") == "/pages/jobs?cursor=1"


@given(st.dictionaries(st.text(max_size=20), st.text(max_size=20)))
def test_a_form_is_read_as_it_was_written(fields: dict[str, str]) -> None:
    assert forms._parsed(urlencode(fields).encode()) == fields


@given(st.text(alphabet="%+&=4aAfxä", max_size=40))
def test_a_broken_form_is_read_as_the_library_reads_it(text: str) -> None:
    try:
        found = dict(parse_qsl(text, keep_blank_values=True, errors="strict"))
    except ValueError:
        with pytest.raises(ValueError):
            forms._parsed(text.encode())
    else:
        assert forms._parsed(text.encode()) == found


def test_a_long_text_is_read_in_pieces_without_a_change() -> None:
    text = "ä%+" * 40_000
    assert forms._parsed(urlencode({"a": text}).encode()) == {"a": text}


def test_a_form_without_the_mark_of_a_page_is_refused(shared_client: httpx.Client) -> None:
    for fields in ({"other": "x"}, {"mark": "guessed"}, {"mark": read(shared_client, "/").fields["mark"] + "x"}):
        answer = shared_client.post("/pages/examples/c11-twin", data=fields, headers=BROWSER)
        assert answer.status_code == 403
        assert "does not come from this service" in answer.text


def test_what_is_no_form_is_refused(shared_client: httpx.Client) -> None:
    answer = shared_client.post("/pages/preferences", json={"mark": "x"}, headers=BROWSER)
    assert answer.status_code == 415
    assert (
        shared_client.post(
            "/pages/preferences",
            content=b"%ff%fe=1&" * 2,
            headers={**BROWSER, "Content-Type": "application/x-www-form-urlencoded"},
        ).status_code
        == 400
    )
