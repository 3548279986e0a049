import httpx

from tests.app import service
from tests.app.pages.reading import read


def test_jobs_are_listed_a_page_at_a_time(own_client: httpx.Client) -> None:
    names = [service.submit(own_client)["id"] for _ in range(3)]
    page = read(own_client, "/pages/jobs")
    assert [f"/pages/jobs/{name}" for name in reversed(names)] == [
        address for address in page.addresses if address.startswith("/pages/jobs/")
    ]
    assert own_client.get("/pages/jobs?cursor=forged").status_code == 400
