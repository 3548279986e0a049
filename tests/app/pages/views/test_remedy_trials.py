import httpx

from app.reference.source_lines import example
from app.runtime.settings import Settings
from tests.app import service
from tests.app.lines import SHORT
from tests.app.pages.reading import read, send


def test_remedies_are_compared_on_the_line_of_a_job(shared_client: httpx.Client, known_job: str) -> None:
    assert f"/pages/jobs/{known_job}/remedies" in read(shared_client, f"/pages/jobs/{known_job}").addresses
    answer = send(shared_client, f"/pages/jobs/{known_job}/remedies", {})
    assert answer.status_code == 303
    job = answer.headers["location"].rpartition("/")[2]
    assert job != known_job
    assert shared_client.get(f"/v1/jobs/{job}").json()["status"] == "accepted"
    assert send(shared_client, f"/pages/jobs/{'0' * 32}/remedies", {}).status_code == 404


def test_result_and_report_draw_the_remedies_beside_their_table(
    shared_client: httpx.Client, shared_settings: Settings
) -> None:
    tried = {"remedies": {"tried": [{"type": "tension", "factor": 1.2}]}}
    document = {"line": example("c11-twin"), "analysis": SHORT, **tried}
    job = service.finished(shared_client, shared_settings, document).replace("/v1/", "/pages/")
    picture = f"{job.replace('/pages/', '/v1/')}/plots/remedies.svg?point=0"
    for path, address in ((job, f"{picture}&theme=light"), (f"{job}/report", picture)):
        page = read(shared_client, path)
        assert "1.2 times the tension" in page.text
        assert address in page.addresses
    assert "Remedies beside the line as it is" in shared_client.get(picture).text
    assert shared_client.get(f"{job}/report.pdf", timeout=60.0).content.startswith(b"%PDF-")
