import json
from datetime import UTC, datetime, timedelta

import httpx

from app.runtime.settings import Settings
from tests.app import service
from tests.app.command_line import galloping, refused
from tests.app.pages.reading import send


def test_record_is_exported_a_line_for_each_event(own_settings: Settings, own_client: httpx.Client) -> None:
    place = ("--data-dir", str(own_settings.data_dir))
    job = service.submit(own_client)["id"]
    key = galloping("keys", "create", "--owner", "acme", *place).stdout.strip()
    assert send(own_client, "/pages/sign-in", {"key": key}, "/pages/sign-in").status_code == 303
    exported = galloping("audit", "export", *place)
    assert exported.returncode == 0, exported.stderr
    events = [json.loads(line) for line in exported.stdout.splitlines()]
    assert [event["action"] for event in events] == ["job_submitted", "key_created", "signed_in"]
    assert (events[0]["owner"], events[0]["subject"], events[2]["owner"]) == ("local", job, "acme")
    assert events[2]["key_id"] == events[1]["subject"]
    assert len({event["id"] for event in events}) == 3
    assert datetime.fromisoformat(events[0]["at"]) <= datetime.fromisoformat(events[2]["at"])
    tomorrow = (datetime.now(UTC) + timedelta(days=1)).strftime("%Y-%m-%d")
    assert galloping("audit", "export", "--since", tomorrow, *place).stdout == ""
    assert len(galloping("audit", "export", "--until", tomorrow, "--owner", "local", *place).stdout.splitlines()) == 1
    assert "--since" in refused("audit", "export", "--since", "yesterday", *place)
