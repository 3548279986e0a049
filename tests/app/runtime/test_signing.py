import stat
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx
import pytest
from pydantic import SecretStr

from app.runtime.settings import Settings
from app.runtime.signing import SecretUnavailable, make_signing_key, signing_key
from app.security import sessions
from tests.app import service
from tests.app.pages.reading import BROWSER
from tests.documents import short_request


def made(settings: Settings) -> bytes:
    make_signing_key(settings)
    return signing_key(settings)


def test_signing_key_that_is_set_is_used(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path / "none", signing_secret=SecretStr("s3cret"))
    assert signing_key(settings) == b"s3cret"
    assert not (tmp_path / "none").exists()


def test_the_former_name_of_the_signing_secret_still_works(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GALLOPING_CURSOR_SECRET", "former")
    assert signing_key(Settings(data_dir=tmp_path)) == b"former"
    monkeypatch.setenv("GALLOPING_SIGNING_SECRET", "present")
    assert signing_key(Settings(data_dir=tmp_path)) == b"present"


def test_a_secret_file_of_an_earlier_version_is_used(tmp_path: Path) -> None:
    (tmp_path / "cursor-secret").write_text("kept since then")
    assert signing_key(Settings(data_dir=tmp_path)) == b"kept since then"
    assert [path.name for path in tmp_path.iterdir()] == ["cursor-secret"]


def test_signing_key_is_made_once_in_a_private_file(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path / "data")
    with ThreadPoolExecutor(8) as pool:
        keys = set(pool.map(lambda _: made(settings), range(32)))
    files = list((tmp_path / "data").iterdir())
    assert len(keys) == 1
    assert len(next(iter(keys))) >= 40
    assert [stat.S_IMODE(path.stat().st_mode) for path in files] == [0o600]
    assert made(Settings(data_dir=tmp_path / "other")) not in keys


def test_a_secret_is_made_at_the_start_only(tmp_path: Path) -> None:
    with pytest.raises(SecretUnavailable, match="signing-secret"):
        signing_key(Settings(data_dir=tmp_path))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("gone", [True, False])
def test_without_its_secret_the_service_says_so_and_goes_on_when_it_is_back(
    own_settings: Settings, own_client: httpx.Client, gone: bool
) -> None:
    for _ in range(2):
        service.submit(own_client)
    cookie = {"Cookie": f"{sessions.COOKIE}={sessions.issue(own_settings, 'x')}"}
    file, aside = own_settings.data_dir / "signing-secret", own_settings.data_dir / "aside"
    file.rename(aside)
    if not gone:
        file.mkdir()  # whatever the reason, it is there and cannot be read
    for path, headers in {"/v1/jobs?limit=1": {}, "/pages/jobs": BROWSER, "/": BROWSER, "/v1/jobs/1": cookie}.items():
        answer = own_client.get(path, headers=headers)
        assert answer.status_code == 503, path
        assert "signing secret" in answer.json()["detail"]
    ready = own_client.get("/health/ready")
    assert (ready.status_code, ready.json()["checks"]["secret"]) == (503, "cannot be read")
    assert own_client.post("/v1/jobs", json=short_request()).status_code == 202
    if not gone:
        file.rmdir()
    aside.rename(file)
    assert own_client.get("/v1/jobs?limit=1").status_code == 200
    assert own_client.get("/health/ready").status_code == 200
