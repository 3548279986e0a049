import json
import tracemalloc
from collections.abc import Iterator
from typing import Any
from weakref import WeakSet

import pytest
from sqlalchemy import func, select
from sqlalchemy.orm import Session, sessionmaker

from app.batches import batch_records
from app.batches.intake import Incoming, Receipt, examine, lines_a_chunk, read_ndjson, receive
from app.convert import read_analysis
from app.jobs import batch_progress
from app.reference.source_lines import example
from app.runtime.settings import Settings
from app.schemas.faults import BadInput
from app.security.caller import LOCAL
from app.tables import Batch, BatchItem, Job
from tests.app.lines import SHORT, changed

TWIN = example("c11-twin")
BAD = changed("span.length_m", -1.0, TWIN)


def take(
    sessions: sessionmaker[Session], settings: Settings, lines: list[Any], *, atomic: bool = False, **changes: Any
) -> Receipt:
    changed_settings = settings.model_copy(update=changes)
    return receive(sessions, changed_settings, LOCAL, Incoming(SHORT, iter(lines)), atomic=atomic)


def items(sessions: sessionmaker[Session], receipt: Receipt) -> list[BatchItem]:
    statement = select(BatchItem).where(BatchItem.batch_id == receipt.batch_id).order_by(BatchItem.number)
    with sessions() as session:
        return list(session.scalars(statement))


def count(sessions: sessionmaker[Session], table: type[Batch | BatchItem | Job]) -> int:
    with sessions() as session:
        return session.scalar(select(func.count()).select_from(table)) or 0


def test_lines_keep_numbers_references_and_defaults(sessions: sessionmaker[Session], settings: Settings) -> None:
    receipt = take(sessions, settings, [{**TWIN, "reference": "r1", "asset_id": "L1"}, {"reference": None, **TWIN}])
    first, second = items(sessions, receipt)
    assert [(i.number, i.reference, i.asset_id, i.faults) for i in (first, second)] == [
        (1, "r1", "L1", None),
        (2, None, None, None),
    ]
    assert first.document is not None and first.document["wind"]["air_density_kg_per_m3"] == 1.2929
    assert "reference" not in first.document
    with sessions() as session:
        batch = batch_records.get(session, LOCAL.owner, receipt.batch_id)
    assert batch is not None and batch.analysis["closure"] == "exact"


def test_labels_are_kept_in_one_form_and_references_as_they_are(
    sessions: sessionmaker[Session], settings: Settings
) -> None:
    decomposed = "Bra\u030al\u00f8s"
    line = {**TWIN, "reference": decomposed, "asset_id": decomposed, "tags": {decomposed: decomposed}}
    (item,) = items(sessions, take(sessions, settings, [line]))
    composed = "Br\u00e5l\u00f8s"
    assert (item.reference, item.asset_id) == (decomposed, composed)
    assert item.document is not None and item.document["tags"] == {composed: composed}


def test_valid_lines_are_cut_into_chunks_and_others_keep_their_faults(
    sessions: sessionmaker[Session], settings: Settings
) -> None:
    lines = [TWIN, BAD, TWIN, {**TWIN, "reference": "x" * 201}, "text", TWIN, BadInput([])]
    receipt = take(sessions, settings, lines, most_chunk_lines=2)
    found = items(sessions, receipt)
    assert [item.chunk_id for item in found] == [
        receipt.chunk_ids[0], None, receipt.chunk_ids[0], None, None, receipt.chunk_ids[1], None,
    ]  # fmt: skip
    assert [[fault["pointer"] for fault in item.faults or ()] for item in found[:5]] == [
        [], ["/span/length_m"], [], ["/reference"], [""],
    ]  # fmt: skip
    with sessions() as session:
        assert batch_progress.counts(session, [receipt.batch_id])[receipt.batch_id].accepted == 3
        assert session.get_one(Batch, receipt.batch_id).rejected_lines == 4
        assert [session.get_one(Job, chunk).lines for chunk in receipt.chunk_ids] == [2, 1]


@pytest.mark.parametrize(
    ("lines", "atomic", "pointers"),
    [
        ([TWIN, BAD, "text"], True, ["/lines/1/span/length_m", "/lines/2"]),
        ([BAD], False, ["/lines/0/span/length_m"]),
        ([], False, ["/lines"]),
        ([TWIN] * 4, False, ["/lines"]),
    ],
)
def test_a_batch_that_is_refused_leaves_nothing(
    sessions: sessionmaker[Session], settings: Settings, lines: list[Any], atomic: bool, pointers: list[str]
) -> None:
    with pytest.raises(BadInput) as caught:
        take(sessions, settings, lines, atomic=atomic, max_batch_lines=3)
    assert [fault.pointer for fault in caught.value.faults] == pointers
    assert [count(sessions, table) for table in (Batch, BatchItem, Job)] == [0, 0, 0]


def test_faults_of_the_analysis_refuse_the_whole(sessions: sessionmaker[Session], settings: Settings) -> None:
    with pytest.raises(BadInput, match="/analysis/loops"):
        receive(sessions, settings, LOCAL, Incoming({"loops": []}, iter([TWIN])), atomic=False)
    assert count(sessions, Batch) == 0


def test_a_sender_that_breaks_off_leaves_nothing(sessions: sessionmaker[Session], settings: Settings) -> None:
    def broken() -> Iterator[object]:
        yield from [TWIN] * 600
        raise ConnectionError

    with pytest.raises(ConnectionError):
        receive(sessions, settings, LOCAL, Incoming(SHORT, broken()), atomic=False)
    assert [count(sessions, table) for table in (Batch, BatchItem, Job)] == [0, 0, 0]


def test_chunks_are_smaller_where_a_line_costs_more(settings: Settings) -> None:
    cheap = lines_a_chunk(settings, read_analysis({"models": ["hybrid"]}))
    dear = lines_a_chunk(settings, read_analysis({"models": ["hybrid", "finite_element"]}))
    endless = lines_a_chunk(settings, read_analysis({"wind_speeds_m_per_s": {"start": 1.0, "stop": 9.0, "count": 900}}))
    assert settings.most_chunk_lines >= cheap > 5 * dear > dear > endless == 1


def test_memory_does_not_grow_with_the_batch(sessions: sessionmaker[Session], settings: Settings) -> None:
    text = json.dumps(TWIN).encode() + b"\n"
    peaks = [_peak(sessions, settings, text, lines) for lines in (1_000, 4_000)]
    assert count(sessions, BatchItem) == 5_000
    assert peaks[1] < 1.2 * peaks[0]


def _peak(sessions: sessionmaker[Session], settings: Settings, text: bytes, lines: int) -> int:
    def body() -> Iterator[bytes]:
        yield b'{"analysis": {"loops": [1], "models": ["hybrid"]}}\n'
        for _ in range(lines // 50):
            yield text * 50

    tracemalloc.start()
    try:
        receive(sessions, settings, LOCAL, read_ndjson(body(), 100_000), atomic=False)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


class _Watched(dict[str, Any]):
    __hash__ = object.__hash__  # type: ignore[assignment]  # a WeakSet takes nothing else


def test_one_document_is_held_at_a_time(sessions: sessionmaker[Session], settings: Settings) -> None:
    held: list[int] = []
    alive: WeakSet[_Watched] = WeakSet()

    def lines() -> Iterator[object]:
        for _ in range(20):
            document = _Watched()
            alive.add(document)
            held.append(len(alive))
            yield document
            del document

    with pytest.raises(BadInput):
        receive(sessions, settings, LOCAL, Incoming({}, lines()), atomic=False)
    assert len(held) == 20
    assert max(held) <= 2


def test_a_block_of_large_lines_is_held_in_a_few_megabytes(sessions: sessionmaker[Session], settings: Settings) -> None:
    rows = [
        {"angle_deg": -60.0 + 0.02 * number, "lift": number / 7e4, "drag": 1.0 / 3.0, "moment": number / 9e5}
        for number in range(6000)
    ]
    measured = {"table": rows, "static_angle_deg": 0.0, "half_range_deg": 20.0}
    large = changed("ice.aerodynamics", measured, TWIN)
    text = json.dumps(large).encode()
    assert len(text) > 400_000
    tracemalloc.start()
    try:
        examine(sessions, settings, LOCAL, Incoming(SHORT, (json.loads(text) for _ in range(30))), atomic=False)
        assert tracemalloc.get_traced_memory()[1] < 45_000_000
    finally:
        tracemalloc.stop()
