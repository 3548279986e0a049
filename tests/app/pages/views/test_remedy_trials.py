import httpx

from tests.app.pages.reading import read, send


def test_remedies_are_compared_on_the_line_of_a_job(shared_client: httpx.Client, known_job: str) -> None:
    assert f"/pages/jobs/{known_job}/remedies" in read(shared_client, f"/pages/jobs/{known_job}").addresses
    answer = send(shared_client, f"/pages/jobs/{known_job}/remedies", {})
    assert answer.status_code == 303
    job = answer.headers["location"].rpartition("/")[2]
    assert job != known_job
    assert shared_client.get(f"/v1/jobs/{job}").json()["status"] == "accepted"
    assert send(shared_client, f"/pages/jobs/{'0' * 32}/remedies", {}).status_code == 404
