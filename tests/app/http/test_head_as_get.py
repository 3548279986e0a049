import httpx
import pytest

from tests.app import service


def test_head_has_the_headers_of_get_and_no_body(shared_client: httpx.Client) -> None:
    address = f"/v1/jobs/{service.submit(shared_client)['id']}"
    got, head = shared_client.get(address), shared_client.head(address)
    assert (head.status_code, head.content) == (200, b"")
    assert head.headers["content-length"] == str(len(got.content))
    assert head.headers["retry-after"] == got.headers["retry-after"]


@pytest.mark.parametrize(
    ("path", "status"),
    [("/v1/jobs", 200), ("/health/live", 200), ("/nothing", 404), ("/v1/jobs?limit=0", 400)],
)
def test_head_has_the_status_of_get(shared_client: httpx.Client, path: str, status: int) -> None:
    assert shared_client.head(path).status_code == shared_client.get(path).status_code == status


def test_head_where_nothing_can_be_got_is_a_wrong_method(shared_client: httpx.Client) -> None:
    answer = shared_client.head("/v1/batches/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e/resubmit")
    assert (answer.status_code, answer.headers["allow"]) == (405, "POST")
