import httpx
import pytest

from app.pages.frame import POLICY
from tests.app.pages.reading import BROWSER, read


def test_a_problem_is_a_page_for_people_and_a_document_for_programs(shared_client: httpx.Client) -> None:
    missing = "/pages/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e"
    shown = shared_client.get(missing, headers=BROWSER)
    assert shown.status_code == 404
    assert "It may have been removed" in shown.text
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
