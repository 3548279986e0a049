import gzip
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import httpx
import pytest
import zstandard

from tests.app import service
from tests.documents import short_request

CODINGS = ("gzip", "zstd")


class Raw(NamedTuple):
    """An answer as it came over the wire."""

    status: int
    headers: httpx.Headers
    body: bytes

    @property
    def plain(self) -> bytes:
        """Return the body without its encoding."""
        coding = self.headers.get("Content-Encoding")
        if coding == "gzip":
            return gzip.decompress(self.body)
        if coding == "zstd":
            return zstandard.ZstdDecompressor().decompressobj().decompress(self.body)
        assert coding is None
        return self.body


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[httpx.Client, str]]:
    """Give a client of a service, and the address of a finished job."""
    settings = service.sqlite_settings(tmp_path_factory.mktemp("compression"))
    with service.running(settings) as client:
        yield client, service.finished(client, settings)


def get(client: httpx.Client, address: str, coding: str, **headers: str) -> Raw:
    with client.stream("GET", address, headers={"Accept-Encoding": coding, **headers}) as answer:
        return Raw(answer.status_code, answer.headers, b"".join(answer.iter_raw()))


@pytest.mark.parametrize("coding", CODINGS)
def test_texts_are_compressed_and_mean_the_same(served: tuple[httpx.Client, str], coding: str) -> None:
    client, job = served
    for address in ("/openapi.json", "/v1/conductors", f"{job}/results", f"{job}/results/limit-cycles?format=csv"):
        bare, packed = get(client, address, "identity"), get(client, address, coding)
        assert "Content-Encoding" not in bare.headers
        assert packed.headers["Content-Encoding"] == coding, address
        assert packed.plain == bare.plain, address
        assert len(packed.body) < 0.7 * len(bare.body), address
        assert all("accept-encoding" in answer.headers["Vary"].lower() for answer in (bare, packed)), address


def test_zstd_is_preferred_and_what_is_refused_is_not_sent(served: tuple[httpx.Client, str]) -> None:
    client, _ = served
    chosen = [
        get(client, "/openapi.json", coding).headers.get("Content-Encoding")
        for coding in ("gzip, deflate, br, zstd", "gzip, zstd;q=0", "br", "", "*;q=0")
    ]
    assert chosen == ["zstd", "gzip", None, None, None]


def test_what_is_compressed_small_or_secret_passes_unchanged(served: tuple[httpx.Client, str]) -> None:
    client, job = served
    table = f"{job}/results/limit-cycles"
    for address in (f"{job}/plots/amplitude.png", f"{table}?format=parquet", f"{table}?format=xlsx", "/v1/version"):
        assert "Content-Encoding" not in get(client, address, "gzip, zstd").headers, address
    page = get(client, "/", "gzip, zstd", Accept="text/html")
    assert page.headers["Content-Type"].startswith("text/html")
    assert "Content-Encoding" not in page.headers
    events = get(client, f"{job}/events", "gzip, zstd")
    assert "Content-Encoding" not in events.headers
    assert b"event: successful" in events.body


def test_each_encoding_has_its_own_strong_tag_and_all_are_known_again(served: tuple[httpx.Client, str]) -> None:
    client, job = served
    tags = {coding: get(client, f"{job}/results", coding).headers["ETag"] for coding in ("identity", *CODINGS)}
    assert len(set(tags.values())) == 3
    assert all(tag.startswith('"') for tag in tags.values())
    for coding, tag in tags.items():
        for known in (tag, f'"other", {tag}', f"W/{tag}"):
            again = get(client, f"{job}/results", coding, **{"If-None-Match": known})
            assert (again.status, again.headers["ETag"], again.body) == (304, tag, b""), coding
    assert get(client, f"{job}/results", "gzip", **{"If-None-Match": '"other-gzip"'}).status == 200


def test_a_batch_is_streamed_compressed(tmp_path: Path) -> None:
    settings = service.sqlite_settings(tmp_path)
    with service.running(settings) as client:
        document = {"lines": [short_request()["line"]] * 3, "analysis": short_request()["analysis"]}
        address = client.post("/v1/batches", json=document).headers["Location"]
        service.work_off(client, settings, address)
        for form in ("ndjson", "csv&table=limit-cycles", "json&table=limit-cycles"):
            bare, packed = (get(client, f"{address}/results?format={form}", coding) for coding in ("identity", "zstd"))
            assert packed.headers["Content-Encoding"] == "zstd"
            assert packed.plain == bare.plain


def test_a_head_tells_what_a_get_would(served: tuple[httpx.Client, str]) -> None:
    client, _ = served
    got = get(client, "/openapi.json", "gzip").headers
    head = client.head("/openapi.json", headers={"Accept-Encoding": "gzip"})
    assert head.headers["Content-Encoding"] == "gzip"
    assert (head.headers["Content-Length"], head.content) == (got["Content-Length"], b"")
