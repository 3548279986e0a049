from concurrent.futures import ThreadPoolExecutor

import httpx

from tests.app import service
from tests.app.pages.reading import BROWSER, read


def test_the_report_of_a_job_is_a_page_and_a_file(shared_client: httpx.Client, known_job: str) -> None:
    page = read(shared_client, f"/pages/jobs/{known_job}/report")
    assert known_job in page.text
    pictures = [address for address in page.addresses if address.endswith("point=0")]
    assert len(pictures) == 2
    for address in set(page.addresses) - {"data:,"}:  # no icon is asked for
        assert shared_client.get(address).status_code == 200, address
    answer = shared_client.get(f"/pages/jobs/{known_job}/report.pdf", timeout=60.0)
    assert answer.status_code == 200
    assert answer.headers["content-type"] == "application/pdf"
    assert answer.content.startswith(b"%PDF-")
    links = read(shared_client, f"/pages/jobs/{known_job}").addresses
    assert f"/pages/jobs/{known_job}/report.pdf?point=0" in links


def test_there_is_no_report_of_what_is_not_done_or_not_there(shared_client: httpx.Client, known_job: str) -> None:
    waiting = service.submit(shared_client)["id"]
    assert shared_client.get(f"/pages/jobs/{waiting}/report").status_code == 409
    assert shared_client.get(f"/pages/jobs/{known_job}/report?point=3").status_code == 404


def test_more_files_than_one_owner_may_wait_for_are_refused_with_a_time(
    shared_client: httpx.Client, known_job: str
) -> None:
    address = f"/pages/jobs/{known_job}/report.pdf"
    with ThreadPoolExecutor(8) as pool:
        answers = list(pool.map(lambda _: shared_client.get(address, headers=BROWSER, timeout=60.0), range(8)))
    assert {answer.status_code for answer in answers} == {200, 429}
    refused = next(answer for answer in answers if answer.status_code == 429)
    assert refused.headers["retry-after"] == "5"
    assert "The report as HTML is there at once" in refused.text
    assert shared_client.get(address, timeout=60.0).status_code == 200
