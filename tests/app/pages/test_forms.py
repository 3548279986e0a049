import httpx
import pytest

from app.pages.forms import local_path
from tests.app.pages.reading import BROWSER, read


@pytest.mark.parametrize("elsewhere", ["//evil.example", "/\\evil.example", "https://evil.example", "", "a\nb"])
def test_a_way_back_stays_in_the_service(elsewhere: str) -> None:
    assert local_path(elsewhere) == "/"
    assert local_path("/pages/jobs?cursor=1") == "/pages/jobs?cursor=1"


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
