import httpx
import pytest

from tests.documents import short_request

LATER, EARLIER = "2200-01-01T00:00:00Z", "2000-01-01T00:00:00+01:00"


@pytest.mark.parametrize("kind", ["jobs", "batches"])
def test_lists_are_cut_to_a_time(client: httpx.Client, kind: str) -> None:
    line, analysis = short_request()["line"], short_request()["analysis"]
    document = {"line": line, "analysis": analysis} if kind == "jobs" else {"lines": [line], "analysis": analysis}
    for _ in range(3):
        client.post(f"/v1/{kind}", json=document, headers={"Cache-Control": "no-cache"}).raise_for_status()

    def found(**query: str) -> int:
        return len(client.get(f"/v1/{kind}", params=query).raise_for_status().json()[kind])

    assert [found(created_after=EARLIER), found(created_before=LATER)] == [3, 3]
    assert [found(created_after=LATER), found(created_before=EARLIER)] == [0, 0]
    page = client.get(f"/v1/{kind}", params={"created_after": EARLIER, "limit": 2}).json()
    assert "created_after=" in page["next"]
    assert len(client.get(page["next"]).raise_for_status().json()[kind]) == 1


@pytest.mark.parametrize("moment", ["2026-01-01T00:00:00", "0001-01-01T00:00:00+14:00", "soon"])
def test_a_moment_has_a_time_zone_and_lies_in_the_years_of_utc(client: httpx.Client, moment: str) -> None:
    for kind in ("jobs", "batches"):
        answer = client.get(f"/v1/{kind}", params={"created_before": moment})
        assert (answer.status_code, answer.json()["errors"][0]["pointer"]) == (400, "/query/created_before")
