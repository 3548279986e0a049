"""What grows with a document is done beside the event loop: the loop's own calls are counted, not its time."""

import asyncio
import json
import sys
from collections.abc import AsyncIterator, Callable, Iterator, Mapping
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path
from types import FrameType
from typing import Any
from urllib.parse import urlencode

import httpx
import pytest

from app.http.beside_loop import QUICK_BYTES
from app.main import create_app
from app.storage.migration import migrate
from tests.app import service
from tests.app.pages.reading import BROWSER, Page
from tests.documents import short_request

ROWS = 9_900
MOST_CALLS_MORE = 1_500  # reading, checking or writing the rows of the table would be 10,000 or more
AFTER_READING = {"request_faults", "JobRequest.kept", "canonical", "fingerprint", "StrictJsonRoute.checked"}
FORM = {"Content-Type": "application/x-www-form-urlencoded", **BROWSER}
KNOWN: dict[str, Any] = {
    "conductor": {"catalogue": "Drake"},
    "span": {"length_m": 300.0, "everyday": {"temperature_c": 15.0, "share_of_rated_strength": 0.2}},
    "ice": {"accretion": {"shape": "crescent", "thickness_m": 0.012}},
}


def table(rows: int) -> dict[str, Any]:
    measured = [
        {"angle_deg": 180.0 * place / rows - 90.0, "lift": 0.3, "drag": 1.2, "moment": -0.1} for place in range(rows)
    ]
    return {"table": measured, "static_angle_deg": 0.0, "half_range_deg": 80.0}


def request(rows: int, **parts: Any) -> dict[str, Any]:
    document = short_request()
    ice = {name: value for name, value in document["line"]["ice"].items() if name != "aerodynamics_at_rest"}
    return {**document, "line": {**document["line"], "ice": {**ice, "aerodynamics": table(rows)}}, **parts}


def known(aerodynamics: Mapping[str, Any]) -> dict[str, Any]:
    return {**KNOWN, "ice": {**KNOWN["ice"], "aerodynamics": aerodynamics}}


def study(points: int) -> dict[str, Any]:
    tensions = [20_000 + number for number in range(points)]
    return {**short_request(), "study": {"axes": [{"parameter": "span.horizontal_tension_n", "values": tensions}]}}


def sheet(rows: int) -> str:
    return "name,diameter [mm],mass [kg/m]\n" + "".join(f"c{number},28.1,1.6\n" for number in range(rows))


Make = Callable[[int], dict[str, Any]]
JSON_CASES: dict[str, tuple[str, Make, int]] = {
    "a job": ("/v1/jobs", request, 202),
    "an estimate": ("/v1/jobs/estimate", request, 200),
    "a preview with a fault": ("/v1/previews", lambda rows: request(rows, webhook_url="https://x.example"), 422),
    "remedies": ("/v1/remedies", request, 202),
    "a fit": ("/v1/aerodynamics/fit", table, 200),
    "an own table": ("/v1/aerodynamics/own", lambda rows: {"name": "mine", **table(rows)}, 200),
    "a line to resolve": ("/v1/lines/resolve", lambda rows: known(table(rows)), 200),
    "a job as it is known": ("/v1/jobs", lambda rows: {**short_request(), "line": known(table(rows))}, 202),
    "an execution": ("/ogc/processes/galloping/execution", lambda rows: {"inputs": request(rows)}, 201),
    "a study": ("/v1/jobs", study, 202),
}


@asynccontextmanager
async def served(directory: Path) -> AsyncIterator[httpx.AsyncClient]:
    """Serve the application in this thread's own loop."""
    settings = service.sqlite_settings(directory)
    await asyncio.to_thread(migrate, settings)
    app = create_app(settings)
    transport = httpx.ASGITransport(app, client=("127.0.0.1", 1))
    async with (
        app.router.lifespan_context(app),
        httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1", timeout=60.0) as client,
    ):
        yield client


@contextmanager
def noted() -> Iterator[list[str]]:
    """Note the names of the Python functions that this thread calls."""
    names: list[str] = []

    def note(frame: FrameType, event: str, _: object) -> None:
        if event == "call":
            names.append(frame.f_code.co_qualname)

    sys.setprofile(note)
    try:
        yield names
    finally:
        sys.setprofile(None)


async def calls_of(client: httpx.AsyncClient, path: str, body: bytes | str, status: int, **headers: str) -> list[str]:
    with noted() as names:
        answer = await client.post(path, content=body, headers=headers)
    assert answer.status_code == status, answer.text[:500]
    return names


def of_json(document: object) -> dict[str, str]:
    return {"body": json.dumps(document), "Content-Type": "application/json", "Prefer": "respond-async"}


def assert_beside(small: list[str], large: list[str]) -> None:
    assert AFTER_READING & set(large) == set()
    assert len(large) < len(small) + MOST_CALLS_MORE


@pytest.mark.parametrize("name", JSON_CASES)
def test_a_large_document_is_read_beside_the_loop(tmp_path: Path, name: str) -> None:
    path, make, status = JSON_CASES[name]

    async def trial() -> None:
        async with served(tmp_path) as client:
            await calls_of(client, path, status=status, **of_json(make(20)))  # loads what is loaded once
            small = await calls_of(client, path, status=status, **of_json(make(20)))
            large = await calls_of(client, path, status=status, **of_json(make(ROWS)), **{"Idempotency-Key": "a"})
            assert "parse_json" not in large
            assert_beside(small, large)

    asyncio.run(trial())


def test_a_small_document_that_names_a_large_table_is_read_beside_the_loop(tmp_path: Path) -> None:
    document = {**short_request(), "line": known({"catalogue": "mine", "angle_deg": 0.0})}

    async def trial() -> None:
        async with served(tmp_path) as client:

            async def posted(rows: int) -> list[str]:
                own = of_json({"name": "mine", **table(rows)})
                await calls_of(client, "/v1/aerodynamics/own", status=200, **own)
                key = {"Idempotency-Key": f"{rows}"}
                job = await calls_of(client, "/v1/jobs", status=202, **of_json(document), **key)
                ogc = of_json({"inputs": document})
                return job + await calls_of(client, "/ogc/processes/galloping/execution", status=201, **ogc)

            await posted(19)
            assert_beside([*await posted(20)], [*await posted(ROWS)])

    asyncio.run(trial())


def test_a_small_document_is_read_at_once(tmp_path: Path) -> None:
    document = of_json(short_request())
    assert len(document["body"]) < QUICK_BYTES

    async def trial() -> None:
        async with served(tmp_path) as client:
            names = await calls_of(client, "/v1/jobs", status=202, **document)
            assert {"parse_json", "request_faults", "JobRequest.kept"} <= set(names)

    asyncio.run(trial())


def test_a_large_form_and_a_large_sheet_are_read_beside_the_loop(tmp_path: Path) -> None:
    async def trial() -> None:
        async with served(tmp_path) as client:
            mark = Page(await client.get("/pages/lines/new", headers=BROWSER)).fields["mark"]

            async def posted(rows: int) -> list[str]:
                devices = {f"line.devices.{number}.type": "spacer" for number in range(rows)}
                form = urlencode({"mark": mark, "note": "%" * rows, **devices})
                calls = await calls_of(client, "/pages/lines/new", form, 422, **FORM)
                csv = {"Content-Type": "text/csv"}
                status = 200 if rows < 1000 else 422
                return calls + await calls_of(client, "/v1/conductors/own", sheet(rows), status, **csv)

            await posted(3)
            assert_beside(await posted(3), await posted(ROWS))

    asyncio.run(trial())
