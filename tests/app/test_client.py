import httpx
import pytest

from app import client
from app.settings import Settings
from tests.app import service
from tests.app.lines import changed
from tests.documents import short_request


def test_a_job_is_followed_to_its_result(own_client: httpx.Client, own_settings: Settings) -> None:
    job = own_client.get(service.finished(own_client, own_settings)).json()
    shown: list[tuple[float, str]] = []
    with client.connect(str(own_client.base_url)) as connection:
        ended = client.follow(connection, job, lambda fraction, step: shown.append((fraction, step)))
        result = client.results(connection, ended)
        table = client.download(connection, ended, "results/frequencies?format=csv")
    assert ended["status"] == "successful"
    assert shown[-1][0] == 1.0
    assert result["frequencies"][0]["loops"] == 1
    assert table.startswith(b"model,loops,")


def test_a_refused_document_tells_its_faults(own_client: httpx.Client) -> None:
    with client.connect(str(own_client.base_url)) as connection, pytest.raises(client.Refused) as caught:
        client.submit(connection, {"line": changed("span.length_m", -1.0)})
    assert [fault.pointer for fault in caught.value.faults] == ["/line/span/length_m"]


def test_results_before_the_end_are_an_error_with_the_services_words(own_client: httpx.Client) -> None:
    with client.connect(str(own_client.base_url)) as connection:
        job = client.submit(connection, short_request())
        with pytest.raises(client.ServiceError, match="409: The job is accepted"):
            client.download(connection, job, "results")


def test_another_service_is_told_from_ours(own_client: httpx.Client) -> None:
    with (
        pytest.raises(client.ServiceError, match="is not this service"),
        client.connect(str(own_client.base_url)) as connection,
    ):
        client.results(connection, own_client.get("/health/live").json())
