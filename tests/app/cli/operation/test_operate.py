"""The operator's commands as operators use them: keys, audit, prune, status."""

import json
import re
from pathlib import Path

import httpx
import pytest

from app.runtime.settings import Settings
from tests.app import service
from tests.app.command_line import galloping, on_a_terminal, refused, run
from tests.documents import short_request


def test_a_key_is_made_used_listed_and_revoked(
    tmp_path: Path, own_settings: Settings, own_client: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = ("--data-dir", str(own_settings.data_dir))
    service.submit(own_client)
    made = galloping("keys", "create", "--owner", "acme", "--name", "SCADA", "--days", "9", *place)
    key = made.stdout.strip()
    assert made.returncode == 0 and len(made.stdout.splitlines()) == 1
    assert key not in made.stderr
    assert "1 job(s) and batch(es) made before keys existed belong to the owner local" in made.stderr
    monkeypatch.setenv("GALLOPING_KEY", key)
    request = tmp_path / "request.json"
    request.write_text(json.dumps(short_request()))
    sent = galloping("submit", str(request), "--url", str(own_client.base_url))
    assert sent.returncode == 0, sent.stderr
    (listed,) = json.loads(galloping("keys", "list", *place).stdout)["keys"]
    assert (listed["owner"], listed["name"], listed["state"]) == ("acme", "SCADA", "good")
    assert listed["scopes"] == ["cancel", "read", "submit"]
    assert listed["used_at"] is not None and listed["expires_at"] is not None
    assert key not in json.dumps(listed)
    assert galloping("keys", "revoke", listed["prefix"], *place).returncode == 0
    assert "revoked" in on_a_terminal("keys", "list", *place)
    assert galloping("keys", "create", "--owner", "b", "--scope", "read", *place).returncode == 0
    (narrow,) = json.loads(galloping("keys", "list", "--owner", "b", "--json", *place).stdout)["keys"]
    assert (narrow["owner"], narrow["scopes"], narrow["expires_at"]) == ("b", ["read"], None)
    assert "--scope" in refused("keys", "create", "--owner", "b", "--scope", "all", *place)
    events = json.loads(galloping("audit", *place).stdout)["events"]
    assert [event["action"] for event in events] == [
        "key_created",
        "key_revoked",
        "job_submitted",
        "key_created",
        "job_submitted",
    ]
    assert events[2]["key_id"] == listed["id"]


def test_what_cannot_be_done_with_keys_ends_with_2_and_a_sentence(tmp_path: Path) -> None:
    place = ("--data-dir", str(tmp_path))
    assert "--owner" in refused("keys", "create", "--owner", "a b", *place)
    assert list(tmp_path.iterdir()) == []
    assert galloping("migrate", *place).returncode == 0
    assert "no keys have the id or beginning" in refused("keys", "revoke", "galloping_0000", *place)
    assert "no key exists" in refused("serve", "--host", "0.0.0.0", *place)


@pytest.mark.parametrize(
    "command",
    [
        ("status",),
        ("status", "--json"),
        ("prune", "--days", "9"),
        ("audit",),
        ("keys", "list"),
        ("keys", "revoke", "galloping_0000"),
    ],
)
def test_elsewhere_than_with_the_data_a_command_names_the_place_and_makes_nothing(
    tmp_path: Path, command: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    ended = run(*command)
    assert (ended.returncode, ended.stdout) == (2, "")
    assert f"there is no database {tmp_path}/data/galloping.sqlite3: name the directory" in ended.stderr
    assert list(tmp_path.iterdir()) == []


def test_the_first_key_may_come_before_the_service(tmp_path: Path) -> None:
    place = ("--data-dir", str(tmp_path / "fresh"))
    made = run("keys", "create", "--owner", "acme", *place)
    assert (made.returncode, made.stdout.startswith("galloping_")) == (0, True)
    assert f"made the new database {tmp_path}/fresh/galloping.sqlite3" in made.stderr
    again = run("keys", "create", "--owner", "other", *place)
    assert (again.returncode, "made the new database" in again.stderr) == (0, False)
    assert [key["owner"] for key in json.loads(run("keys", "list", "--json", *place).stdout)["keys"]] == [
        "acme",
        "other",
    ]


def test_a_database_of_an_older_version_is_named(tmp_path: Path) -> None:
    (tmp_path / "galloping.sqlite3").touch()
    told = refused("keys", "list", "--data-dir", str(tmp_path))
    assert f"the database {tmp_path}/galloping.sqlite3 has an older schema: run `galloping migrate`" in told


def test_prune_counts_before_it_removes(own_settings: Settings, own_client: httpx.Client) -> None:
    address = service.finished(own_client, own_settings)
    place = ("--json", "--data-dir", str(own_settings.data_dir))
    nothing = {"jobs": 0, "batches": 0, "lines": 0, "audit_events": 0}
    assert json.loads(galloping("prune", "--days", "1", "--dry-run", *place).stdout) == {"dry_run": True, **nothing}
    assert json.loads(galloping("prune", "--days", "1", *place).stdout) == {"dry_run": False, **nothing}
    assert own_client.get(address).status_code == 200
    assert galloping("prune", *place).returncode == 2  # how long to keep is for the operator to say


def test_status_shows_the_service_and_its_exit_code_what_is_wrong(own_settings: Settings) -> None:
    place = ("--data-dir", str(own_settings.data_dir))
    assert galloping("migrate", *place).returncode == 0
    shown = on_a_terminal("status", *place, code=1)
    assert "No worker is running." in shown
    assert "oldest waiting" in shown
    assert "stored MB" not in shown, "nobody has anything"
    piped = galloping("status", *place)
    found = json.loads(piped.stdout)
    assert piped.returncode == 1
    assert (found["database"], found["broker"], found["queues"]) == ("ok", "ok", {"jobs": 0, "chunks": 0})
    assert found["faults"] == ["No worker is running."]


def test_status_shows_what_every_owner_has(own_client: httpx.Client, own_settings: Settings) -> None:
    place = ("--data-dir", str(own_settings.data_dir))
    service.submit(own_client)
    shown = on_a_terminal("status", *place, code=1)
    assert re.search(r"owner +running +waiting +stored MB", shown)
    assert re.search(r"local +0 +1 +0\.0", shown)
    found = json.loads(galloping("status", *place).stdout)
    assert found["contents"]["owners"]["local"]["waiting"] == 1
