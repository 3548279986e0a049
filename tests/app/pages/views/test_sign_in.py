from collections.abc import Callable, Iterator

import httpx
import pytest

from app.runtime.settings import Settings
from app.security import keys, sessions
from app.security.caller import Scope
from app.storage.database import make_engine, session_factory
from tests.app import service
from tests.app.pages.reading import BROWSER, Page, read, send

SIGN_IN = "/pages/sign-in"


@pytest.fixture
def make_key(own_settings: Settings, own_client: httpx.Client) -> Iterator[Callable[..., str]]:
    """Give a function that makes a key of an owner."""
    del own_client  # its database must be there
    engine = make_engine(own_settings)

    def made(owner: str, *scopes: Scope) -> str:
        with session_factory(engine).begin() as session:
            return keys.create(session, owner, scopes or tuple(Scope), None, None)[1]

    yield made
    engine.dispose()


def signed_in(client: httpx.Client, key: str) -> httpx.Response:
    client.cookies.clear()
    return send(client, SIGN_IN, {"key": key, "back": "/pages/jobs"}, SIGN_IN)


def test_a_page_leads_to_the_sign_in_and_back(own_client: httpx.Client, make_key: Callable[..., str]) -> None:
    key = make_key("north")
    refused = own_client.get("/pages/jobs", headers=BROWSER)
    assert refused.status_code == 303
    assert refused.headers["location"] == f"{SIGN_IN}?back=/pages/jobs"
    assert own_client.get("/").status_code == 401
    answer = signed_in(own_client, key)
    assert answer.status_code == 303
    assert answer.headers["location"] == "/pages/jobs"
    cookie = answer.headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=lax" in cookie
    assert "Secure" not in cookie  # the test speaks plain HTTP
    assert key not in cookie
    assert "Signed in as north" in read(own_client, "/pages/jobs").text


def test_a_wrong_key_is_refused_and_none_is_kept(own_client: httpx.Client, make_key: Callable[..., str]) -> None:
    make_key("north")
    answer = signed_in(own_client, "galloping_0000")
    assert answer.status_code == 401
    assert "The key is unknown" in answer.text
    assert "set-cookie" not in answer.headers


def test_one_owner_does_not_see_the_pages_of_another(own_client: httpx.Client, make_key: Callable[..., str]) -> None:
    north, south = make_key("north"), make_key("south")
    job = service.submit_as(own_client, {"Authorization": f"Bearer {north}"})
    signed_in(own_client, south)
    assert read(own_client, f"/pages/jobs/{job}").status == 404
    assert f"/pages/jobs/{job}" not in read(own_client, "/").addresses
    assert send(own_client, f"/pages/jobs/{job}/again", {}).status_code == 404
    signed_in(own_client, north)
    assert read(own_client, f"/pages/jobs/{job}").status == 200


def test_a_session_reads_the_api_but_changes_it_by_forms_only(
    own_client: httpx.Client, make_key: Callable[..., str]
) -> None:
    job = service.submit_as(own_client, {"Authorization": f"Bearer {make_key('north')}"})
    signed_in(own_client, make_key("north"))
    assert own_client.get(f"/v1/jobs/{job}").status_code == 200
    assert own_client.delete(f"/v1/jobs/{job}").status_code == 401
    assert own_client.post("/v1/jobs", json={}).status_code == 401


def test_the_mark_of_a_form_is_of_no_use_to_another_caller(
    own_client: httpx.Client, make_key: Callable[..., str]
) -> None:
    north, south = make_key("north"), make_key("south")
    signed_in(own_client, north)
    mark = read(own_client, "/").fields["mark"]
    signed_in(own_client, south)
    answer = own_client.post("/pages/examples/c11-twin", data={"mark": mark}, headers=BROWSER)
    assert answer.status_code == 403


def test_a_key_without_the_scope_cannot_cancel(own_client: httpx.Client, make_key: Callable[..., str]) -> None:
    key = make_key("north", Scope.READ, Scope.SUBMIT)
    job = service.submit_as(own_client, {"Authorization": f"Bearer {key}"})
    signed_in(own_client, key)
    answer = send(own_client, f"/pages/jobs/{job}/cancel", {})
    assert answer.status_code == 403
    assert "may not cancel" in answer.text


def test_signing_out_ends_the_session(own_client: httpx.Client, make_key: Callable[..., str]) -> None:
    signed_in(own_client, make_key("north"))
    assert send(own_client, "/pages/sign-out", {}).headers["location"] == SIGN_IN
    assert sessions.COOKIE not in own_client.cookies
    assert own_client.get("/pages/jobs", headers=BROWSER).status_code == 303


def test_a_copied_cookie_is_refused_after_the_sign_out(
    own_settings: Settings, own_client: httpx.Client, make_key: Callable[..., str]
) -> None:
    key = make_key("north")
    job = service.submit_as(own_client, {"Authorization": f"Bearer {key}"})
    signed_in(own_client, key)
    copied = {"Cookie": f"{sessions.COOKIE}={own_client.cookies[sessions.COOKIE]}", **BROWSER}
    signed_in(own_client, key)  # another session of the same key
    other = {"Cookie": f"{sessions.COOKIE}={own_client.cookies[sessions.COOKIE]}", **BROWSER}
    own_client.cookies.clear()
    assert own_client.get("/pages/jobs", headers=copied).status_code == 200
    mark = Page(own_client.get("/", headers=copied)).fields["mark"]
    assert own_client.post("/pages/sign-out", data={"mark": mark}, headers=copied).status_code == 303
    refused = own_client.get("/pages/jobs", headers=copied)
    assert (refused.status_code, refused.headers["location"]) == (303, f"{SIGN_IN}?back=/pages/jobs")
    assert own_client.get(f"/v1/jobs/{job}", headers={**copied, "Accept": "*/*"}).status_code == 401
    with service.running(own_settings) as another:  # a second process, or the same one after a restart
        assert another.get("/pages/jobs", headers=copied).status_code == 303
        assert another.get("/pages/jobs", headers=other).status_code == 200
    assert own_client.get("/pages/jobs", headers=other).status_code == 200
    assert own_client.get(f"/v1/jobs/{job}", headers={"Authorization": f"Bearer {key}"}).status_code == 200


def test_a_key_that_is_replaced_ends_its_sessions(
    own_settings: Settings, own_client: httpx.Client, make_key: Callable[..., str]
) -> None:
    old = make_key("north")
    make_key("north")
    signed_in(own_client, old)
    engine = make_engine(own_settings)
    with session_factory(engine).begin() as session:
        keys.revoke(session, old)
    engine.dispose()
    with service.running(own_settings) as another:  # one that has not looked the key up before
        headers = {"Cookie": f"{sessions.COOKIE}={own_client.cookies[sessions.COOKIE]}", **BROWSER}
        assert another.get("/pages/jobs", headers=headers).status_code == 303
