import httpx

from tests.app.pages.reading import read, send


def test_units_and_appearance_are_kept(own_client: httpx.Client) -> None:
    answer = send(own_client, "/pages/preferences", {"units": "feet", "theme": "dark", "back": "/pages/jobs"})
    assert answer.headers["location"] == "/pages/jobs"
    cookies = answer.headers.get_list("set-cookie")
    assert all("HttpOnly" in cookie and "SameSite=lax" in cookie for cookie in cookies)
    assert 'data-theme="dark"' in own_client.get("/pages/jobs", headers={"Accept": "text/html"}).text
    assert read(own_client, "/").fields["units"] == ""


def test_what_is_no_choice_is_not_kept(own_client: httpx.Client) -> None:
    answer = send(own_client, "/pages/preferences", {"units": "cubits", "theme": "red", "back": "//evil.example"})
    assert "set-cookie" not in answer.headers
    assert answer.headers["location"] == "/"
