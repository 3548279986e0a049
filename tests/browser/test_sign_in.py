"""With keys: a page leads to the sign-in, a key opens it, and signing out closes it."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, expect

from app.runtime.settings import Settings
from app.security import keys
from app.security.caller import Scope
from app.storage.database import make_engine, session_factory
from app.storage.migration import migrate
from tests import embedded
from tests.servers import free_port


@pytest.fixture(scope="module")
def guarded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, str]]:
    """Give the address of a service with keys, and a key."""
    settings = Settings(data_dir=tmp_path_factory.mktemp("guarded"))
    migrate(settings)
    engine = make_engine(settings)
    with session_factory(engine).begin() as session:
        key = keys.create(session, "north-grid", tuple(Scope), None, None)[1]
    engine.dispose()
    with embedded.serving(settings, free_port()) as (_, client):
        yield str(client.base_url).rstrip("/"), key


def test_a_key_opens_the_pages_and_signing_out_closes_them(browser: Browser, guarded: tuple[str, str]) -> None:
    service, key = guarded
    context = browser.new_context(base_url=service)
    page = context.new_page()
    page.goto("/pages/jobs")
    expect(page.locator("h1")).to_have_text("Sign in")
    page.get_by_label("Key").fill("galloping_wrong")
    page.get_by_role("button", name="Sign in").click()
    expect(page.get_by_role("alert")).to_contain_text("unknown, revoked or expired")
    page.get_by_label("Key").fill(key)
    page.get_by_role("button", name="Sign in").click()
    expect(page.locator("h1")).to_have_text("Jobs")
    expect(page.locator("header")).to_contain_text("north-grid")
    page.goto("/")
    page.locator("form[action$='/pages/examples/c11-twin'] button").click()
    page.wait_for_selector(".verdict", timeout=180_000)  # the stream of events takes the session, too
    page.get_by_role("button", name="Sign out").click()
    expect(page.locator("h1")).to_have_text("Sign in")
    page.goto("/pages/jobs")
    expect(page.locator("h1")).to_have_text("Sign in")
    context.close()
