from pathlib import Path

import pytest
from pydantic import ValidationError

from app.runtime.settings import Settings
from tests.app import service

GRID, OTHER = "https://grid.example", "https://other.example"


def test_pages_of_other_origins_are_kept_out_by_default(tmp_path: Path) -> None:
    with service.running(service.sqlite_settings(tmp_path)) as client:
        answer = client.get("/v1/version", headers={"Origin": GRID})
        assert not [name for name in answer.headers if name.startswith("access-control")]


def test_pages_of_named_origins_may_call_the_api(tmp_path: Path) -> None:
    with service.running(service.sqlite_settings(tmp_path, cors_origins=f"{GRID}, https://maps.example")) as client:
        asked = {
            "Access-Control-Request-Method": "POST",
            "Access-Control-Request-Headers": "authorization,content-type",
        }
        allowed = client.options("/v1/jobs", headers={"Origin": GRID, **asked})
        assert allowed.status_code == 200
        assert allowed.headers["Access-Control-Allow-Origin"] == GRID
        assert "POST" in allowed.headers["Access-Control-Allow-Methods"]
        assert "Access-Control-Allow-Credentials" not in allowed.headers
        assert client.options("/v1/jobs", headers={"Origin": OTHER, **asked}).status_code == 400
        answer = client.get("/v1/nothing", headers={"Origin": GRID})
        assert answer.headers["Access-Control-Allow-Origin"] == GRID
        assert {"Location", "ETag", "Retry-After"} <= set(
            answer.headers["Access-Control-Expose-Headers"].replace(" ", "").split(",")
        )
        assert "Access-Control-Allow-Origin" not in client.get("/v1/version", headers={"Origin": OTHER}).headers


def test_the_setting_is_a_list_of_origins_and_passed_to_child_processes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GALLOPING_CORS_ORIGINS", f"{GRID},{OTHER}")
    assert Settings().cors_origins == (GRID, OTHER)
    assert Settings().environment()["GALLOPING_CORS_ORIGINS"] == f"{GRID},{OTHER}"
    with pytest.raises(ValidationError, match="no origin"):
        Settings(cors_origins="grid.example")
