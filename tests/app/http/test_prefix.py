import contextlib
import re
from collections.abc import AsyncIterator, Iterator
from typing import Any
from uuid import UUID

import httpx
import pytest
from pydantic import ValidationError
from starlette.applications import Starlette
from starlette.background import BackgroundTask
from starlette.requests import Request
from starlette.responses import StreamingResponse
from starlette.routing import Route

from app.client import Client
from app.jobs import webhooks
from app.runtime.settings import Settings
from app.security import webhook_addresses
from app.storage.database import make_engine, session_factory
from app.tables import WebhookDelivery
from tests.app import service
from tests.documents import short_request
from tests.in_process import run_job

PREFIX = "/gal"


def proxy(target: str, *, strips: bool) -> Starlette:
    """Return a reverse proxy that passes on what is below the prefix, with or without the prefix."""

    @contextlib.asynccontextmanager
    async def lifespan(app: Starlette) -> AsyncIterator[None]:
        async with httpx.AsyncClient(base_url=target, timeout=60.0) as app.state.client:
            yield

    async def pass_on(request: Request) -> StreamingResponse:
        path = request.url.path.removeprefix(PREFIX) if strips else request.url.path
        client: httpx.AsyncClient = request.app.state.client
        address = client.base_url.copy_with(path=path or "/", query=request.url.query.encode())
        passed = client.build_request(
            request.method, address, headers=request.headers.raw, content=await request.body()
        )
        answer = await client.send(passed, stream=True)
        return StreamingResponse(
            answer.aiter_raw(), answer.status_code, answer.headers, background=BackgroundTask(answer.aclose)
        )

    methods = ["GET", "POST", "PATCH", "DELETE", "HEAD"]
    return Starlette(routes=[Route(PREFIX + "{rest:path}", pass_on, methods=methods)], lifespan=lifespan)


@pytest.fixture(scope="module")
def settings(tmp_path_factory: pytest.TempPathFactory) -> Settings:
    """Give the settings of a service under the prefix."""
    return service.sqlite_settings(tmp_path_factory.mktemp("prefix"), root_path=f"{PREFIX}/", max_body_bytes=10_000)


@pytest.fixture(scope="module", params=[True, False], ids=["the prefix is stripped", "the prefix is kept"])
def proxied(settings: Settings, request: pytest.FixtureRequest) -> Iterator[httpx.Client]:
    """Give a client of a proxy before the service."""
    with service.running(settings) as direct, service.serving(proxy(str(direct.base_url), strips=request.param)) as own:
        yield own


def addresses(document: Any) -> Iterator[str]:
    """Yield the addresses that a document links to."""
    if isinstance(document, dict):
        yield from (document[name] for name in ("href", "next") if isinstance(document.get(name), str))
        for inner in document.values():
            yield from addresses(inner)
    if isinstance(document, list):
        for inner in document:
            yield from addresses(inner)


def test_every_link_of_jobs_and_batches_leads_through_the_proxy(proxied: httpx.Client, settings: Settings) -> None:
    key = {"Idempotency-Key": f"prefix {proxied.base_url}"}
    posted = proxied.post(f"{PREFIX}/v1/jobs", json=short_request(), headers={**service.ANEW, **key})
    again = proxied.post(f"{PREFIX}/v1/jobs", json=short_request(), headers=key)
    assert (again.json(), again.headers["Location"]) == (posted.json(), posted.headers["Location"])
    assert again.headers["Idempotency-Replayed"] == "true"
    job = posted.headers["Location"]
    assert job == f"{PREFIX}/v1/jobs/{posted.json()['id']}"
    run_job(settings, UUID(posted.json()["id"]))
    batch = proxied.post(f"{PREFIX}/v1/batches", json={"lines": [short_request()["line"], {}]}).headers["Location"]
    page = proxied.get(f"{PREFIX}/v1/jobs?limit=1&created_after=2000-01-01T00:00:00Z").json()
    proxied.post(f"{PREFIX}/v1/jobs", json=short_request(), headers=service.ANEW)
    first = proxied.get(f"{PREFIX}/v1/jobs?limit=1").json()
    found = [
        job,
        batch,
        first["next"],
        *(link for address in (job, batch) for link in addresses(proxied.get(address).json())),
        *addresses(page),
        *addresses(proxied.get(f"{PREFIX}/", headers={"Accept": "application/json"}).json()),
    ]
    assert len(found) > 20
    for address in found:
        assert address.startswith(f"{PREFIX}/"), address
        assert proxied.get(address).status_code in {200, 405}, address  # a link to what takes a POST
    assert proxied.get(f"{job}/results", headers={"Accept-Encoding": "gzip"}).json()["limit_cycles"]


def test_every_link_of_ogc_api_processes_is_a_whole_address_of_the_proxy(proxied: httpx.Client) -> None:
    prefer, execution = {"Prefer": "respond-async"}, f"{PREFIX}/ogc/processes/galloping/execution"
    posted = proxied.post(execution, json={"inputs": short_request()}, headers=prefer)
    pages = [proxied.get(f"{PREFIX}/ogc{path}").json() for path in ("", "/processes", "/processes/galloping", "/jobs")]
    found = [posted.headers["Location"], *(link for page in (posted.json(), *pages) for link in addresses(page))]
    assert len(found) > 15
    for address in found:
        assert address.startswith(str(proxied.base_url.join(f"{PREFIX}/"))), address
        assert proxied.get(address).status_code in {200, 405}, address  # a link to what takes a POST


def test_a_problem_names_its_page_behind_the_proxy(proxied: httpx.Client) -> None:
    problem = proxied.get(f"{PREFIX}/v1/nothing").json()
    assert problem["instance"] == f"{PREFIX}/v1/nothing"
    assert problem["type"] == f"{PREFIX}/problems/not-found"
    assert proxied.get(problem["type"]).json()["slug"] == "not-found"


def test_pages_and_their_files_are_found_behind_the_proxy(proxied: httpx.Client) -> None:
    html = {"Accept": "text/html"}
    for address in ("/", "/pages/jobs", "/pages/batches", "/docs"):
        page = proxied.get(PREFIX + address, headers=html)
        assert page.status_code == 200, address
        own = [name for name in re.findall(r'(?:src|href|action)="(/[^"]*)"', page.text) if not name.startswith("//")]
        assert own, address
        for name in own:
            assert name.startswith(f"{PREFIX}/"), name
            assert proxied.get(name, headers=html).status_code in {200, 405}, name


def test_the_document_names_the_prefix_as_its_server(proxied: httpx.Client) -> None:
    assert [server["url"] for server in proxied.get(f"{PREFIX}/openapi.json").json()["servers"]] == [PREFIX]


def test_the_limits_of_bodies_are_those_of_the_paths(proxied: httpx.Client) -> None:
    large = b'{"span": 1}\n' * 1000
    answers = [
        proxied.post(f"{PREFIX}/v1/{name}", content=large, headers={"Content-Type": "application/x-ndjson"}).status_code
        for name in ("batches", "jobs")
    ]
    assert answers == [422, 413]


def test_the_python_client_follows_links_behind_the_proxy(proxied: httpx.Client, settings: Settings) -> None:
    with Client(str(proxied.base_url.join(PREFIX))) as client:
        job = client.submit(short_request()["line"], {**short_request()["analysis"], "wind_speeds_m_per_s": [7.0]})
        run_job(settings, job.id)
        assert client.wait(job).status == "successful"
        assert client.rows(job, "limit-cycles")
        client.remove(job)


def test_webhooks_link_behind_the_proxy(
    proxied: httpx.Client, settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def vetted(*_: object, **__: object) -> None:
        """Take every address."""

    monkeypatch.setattr(webhook_addresses, "vet", vetted)
    told = {**short_request(), "webhook_url": "https://assets.example.com/hook"}
    job = proxied.post(f"{PREFIX}/v1/jobs", json=told, headers=service.ANEW).json()["id"]
    run_job(settings, UUID(job))
    engine = make_engine(settings)
    with session_factory(engine).begin() as session:
        webhooks.enlist(session, settings.root_path)
        payloads = [delivery.payload or "" for delivery in session.query(WebhookDelivery)]
    engine.dispose()
    assert any(f'"href":"{PREFIX}/v1/jobs/{job}"' in payload for payload in payloads)


@pytest.mark.parametrize("wrong", ["gal", "/gal//x", "/gal?x", "http://host/gal"])
def test_a_prefix_is_a_path(wrong: str) -> None:
    with pytest.raises(ValidationError, match="root_path"):
        Settings(root_path=wrong)
