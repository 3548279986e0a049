import httpx

from tests.app.pages.reading import BROWSER, read, send


def test_a_program_finds_the_parts_of_the_service(shared_client: httpx.Client) -> None:
    document = shared_client.get("/").json()
    assert document["engine_version"]
    assert document["version"] == shared_client.get("/v1/version").json()["service"]
    assert {"version", "conformance"} <= {link["rel"] for link in document["links"]}
    for link in document["links"]:
        assert shared_client.get(link["href"]).status_code in {200, 405, 503}, link
    assert shared_client.get("/").headers["vary"] == "Accept"


def test_the_start_page_offers_examples_and_lists_recent_jobs(shared_client: httpx.Client) -> None:
    page = read(shared_client, "/")
    assert "Does the iced span gallop?" in page.text
    assert "/pages/examples/c11-quad" in page.addresses
    answer = send(shared_client, "/pages/examples/c11-twin", {})
    assert answer.status_code == 303
    assert answer.headers["location"].startswith("/pages/jobs/")
    after = read(shared_client, "/")
    assert answer.headers["location"] in after.addresses
    assert "C11 twin, 126 m" in after.text


def test_an_example_that_is_not_there_is_missing(shared_client: httpx.Client) -> None:
    assert send(shared_client, "/pages/examples/c12", {}).status_code == 404


def test_pages_stand_behind_the_prefix_of_a_proxy(shared_client: httpx.Client) -> None:
    answer = shared_client.get("/", headers=BROWSER)
    assert 'href="/pages/jobs"' in answer.text
