from typing import Any
from uuid import UUID

import anyio
import httpx
import pytest
from fastapi.routing import APIRoute

from app.main import create_app
from app.pages.frame import POLICY
from app.pages.views import routers
from app.runtime.settings import Settings
from tests.app import service
from tests.app.pages.reading import BROWSER, Page, read
from tests.documents import short_request


def test_a_problem_is_a_page_for_people_and_a_document_for_programs(shared_client: httpx.Client) -> None:
    missing = "/pages/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e"
    shown = shared_client.get(missing, headers=BROWSER)
    assert shown.status_code == 404
    assert "A job that was removed has no page any more" in shown.text
    assert shown.headers["content-security-policy"] == POLICY
    assert shared_client.get(missing).headers["content-type"] == "application/problem+json"
    assert shared_client.get("/v1/nothing", headers=BROWSER).headers["content-type"] == "application/problem+json"
    assert shared_client.get("/pages/nothing", headers=BROWSER).headers["content-type"].startswith("text/html")


def test_the_policy_allows_no_inline_script_or_style() -> None:
    assert "unsafe" not in POLICY
    assert "default-src 'none'" in POLICY


PAGES = {
    "default-src": "'none'",
    "script-src": "'self'",
    "style-src": "'self'",
    "img-src": "'self' data: blob:",
    "connect-src": "'self'",
    "base-uri": "'none'",
    "form-action": "'self'",
    "frame-ancestors": "'none'",
}
FILES = {  # pictures, which have styles of their own, and documents that no browser shows as a page
    "default-src": "'none'",
    "style-src": "'unsafe-inline'",
    "img-src": "data:",
    "base-uri": "'none'",
    "form-action": "'none'",
    "frame-ancestors": "'none'",
}


def directives(answer: httpx.Response) -> dict[str, str]:
    (policy,) = answer.headers.get_list("content-security-policy")
    pairs = [part.strip().partition(" ") for part in policy.split(";")]
    assert len({name for name, _, _ in pairs}) == len(pairs)  # browsers take the first of two alike
    return {name: value for name, _, value in pairs}


def test_every_page_has_the_policy_to_the_letter(
    shared_client: httpx.Client, shared_settings: Settings, known_job: str
) -> None:
    body = {"lines": [short_request()["line"]], "analysis": short_request()["analysis"]}
    batch = shared_client.post("/v1/batches", json=body).headers["location"]
    service.work_off(shared_client, shared_settings, batch)
    names = {"job_id": known_job, "batch_id": batch.rpartition("/")[2], "number": "1", "name": "c11-twin"}
    paths = sorted({route.path.format(**names) for route in _read_by_browsers()})
    assert len(paths) > 15 and "/pages/sign-in" in paths and f"/pages/jobs/{known_job}/what-if" in paths
    for path in paths:
        answer = shared_client.get(path, headers=BROWSER, params={"format": "csv"} if "results" in path else {})
        assert answer.status_code in {200, 303}, (path, answer.text[:200])
        shown = answer.headers.get("content-type", "").startswith("text/html")
        assert directives(answer) == (PAGES if shown else FILES), path
    missing = shared_client.get(f"/pages/jobs/{UUID(int=0)}", headers=BROWSER)
    assert (missing.status_code, directives(missing)) == (404, PAGES)


def _read_by_browsers() -> list[Any]:
    """Return the routes of all pages that are read by a GET."""
    found = [route for router in routers() for route in router.routes]
    return [route for route in found if isinstance(route, APIRoute) and "GET" in (route.methods or ())]


@pytest.mark.parametrize("path", ["/", "/pages/jobs", "/pages/lines/new"])
def test_pages_lead_nowhere_else(shared_client: httpx.Client, path: str) -> None:
    page = read(shared_client, path)
    assert page.status == 200
    assert [address for address in page.addresses if not address.startswith(("/", "#"))] == []


def test_addresses_and_cookies_stand_behind_the_prefix_and_the_encryption_of_a_proxy(
    own_settings: Settings, own_client: httpx.Client
) -> None:
    del own_client  # its database must be there
    transport = httpx.ASGITransport(create_app(own_settings), root_path="/galloping", client=("127.0.0.1", 1))
    answer = anyio.run(_through_proxy, transport)
    page = Page(answer)
    assert [path for path in page.addresses if not path.startswith(("/galloping/", "#"))] == []
    moved, cookies = answer.extensions["then"]
    assert moved == "/galloping/pages/jobs"
    assert all("Secure" in cookie and "Path=/galloping/" in cookie for cookie in cookies)


async def _through_proxy(transport: httpx.ASGITransport) -> httpx.Response:
    async with httpx.AsyncClient(transport=transport, base_url="https://127.0.0.1") as client:
        answer = await client.get("/galloping/", headers=BROWSER)
        fields = {"mark": Page(answer).fields["mark"], "units": "feet", "back": "/pages/jobs"}
        kept = await client.post("/galloping/pages/preferences", data=fields, headers=BROWSER)
        answer.extensions["then"] = (kept.headers["location"], kept.headers.get_list("set-cookie"))
        return answer
