import anyio
import httpx
import pytest

from app.main import create_app
from app.pages.frame import POLICY
from app.runtime.settings import Settings
from tests.app.pages.reading import BROWSER, Page, read


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
