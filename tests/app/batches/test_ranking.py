import math
import random
from dataclasses import replace
from uuid import UUID, uuid4

import pytest
from sqlalchemy import text
from sqlalchemy.orm import Session, sessionmaker

from app.batches import batch_records, ranking
from app.batches.ranking import Order, Place
from app.http.paging import BadCursor
from app.jobs import leases
from app.security.caller import LOCAL
from app.storage.stored_results import RANKING_FIGURES
from tests.batch_rows import add_batch, claim
from tests.documents import point_result

KEY = b"k" * 32
AMPLITUDE = Order("largest_vertical_m", descending=True)
CRITICAL = Order("lowest_critical_wind_speed_m_per_s", descending=False)
LINES = 23


def filled(sessions: sessionmaker[Session], seed: int) -> tuple[UUID, dict[int, dict[str, float | None]]]:
    """Make a batch of finished lines with figures drawn at random, many of them equal and some unknown."""
    draw = random.Random(seed)
    batch_id, chunks = add_batch(sessions, 10, LINES - 10)
    figures: dict[int, dict[str, float | None]] = {}
    for chunk in chunks:
        held = claim(sessions, chunk)
        with sessions.begin() as session:
            _, lines = batch_records.lines_of_chunk(session, chunk, batch_id)
            for line in lines:
                figures[line.number] = {
                    name: draw.choice([None, 0.1 + 0.2, 1.5, 2.5, 1e-300, math.inf]) for name in RANKING_FIGURES
                }
            found = [replace(point_result(line.number), ranking_figures=figures[line.number]) for line in lines]
            assert leases.finish(session, held, found)
    return batch_id, figures


def pages(sessions: sessionmaker[Session], batch_id: UUID, order: Order, limit: int) -> list[int]:
    """Return the numbers of all lines of a ranking, read page by page through cursors."""
    numbers: list[int] = []
    after = None
    while True:
        with sessions() as session:
            rows = ranking.page(session, batch_id, order, after, limit)
        if not rows:
            return numbers
        numbers += [row.number for row in rows]
        place = Place(getattr(rows[-1], order.figure), rows[-1].number, len(numbers))
        after = ranking.decode(KEY, batch_id, order, ranking.encode(KEY, batch_id, order, place))
        assert after == place


@pytest.mark.parametrize("limit", [1, 4, 100])
def test_pages_hold_every_known_line_once_in_order(sessions: sessionmaker[Session], limit: int) -> None:
    batch_id, figures = filled(sessions, 1)
    filled(sessions, 2)  # another batch, whose lines belong to no page of this one
    for order in (AMPLITUDE, CRITICAL):
        known = [(value, n) for n, f in figures.items() if (value := f[order.figure]) is not None]
        expected = [n for _, n in sorted(known, reverse=order.descending)]
        assert pages(sessions, batch_id, order, limit) == expected


def test_a_page_is_read_along_the_index(sessions: sessionmaker[Session]) -> None:
    batch_id, _ = filled(sessions, 3)
    with sessions() as session:
        if session.get_bind().dialect.name != "sqlite":
            session.execute(text("SET LOCAL enable_seqscan = off"))
            session.execute(text("SET LOCAL enable_sort = off"))
        plans = []
        execute = session.execute

        def explained(statement: object) -> object:
            bound = statement.compile(session.get_bind(), compile_kwargs={"literal_binds": True})  # type: ignore[attr-defined]
            word = "EXPLAIN QUERY PLAN" if session.get_bind().dialect.name == "sqlite" else "EXPLAIN"
            plans.append("\n".join(str(row) for row in execute(text(f"{word} {bound}".replace(":", r"\:")))))
            return execute(statement)  # type: ignore[call-overload]

        session.execute = explained  # type: ignore[assignment, method-assign]
        for order in (AMPLITUDE, CRITICAL):
            ranking.page(session, batch_id, order, Place(1.0, 5, 5), 4)
    for order, plan in zip((AMPLITUDE, CRITICAL), plans, strict=True):
        assert f"ix_results_batch_id_{order.figure}_point" in plan
        assert "TEMP B-TREE" not in plan
        assert "Sort" not in plan


def test_a_resubmitted_line_is_ranked_by_its_last_result(sessions: sessionmaker[Session]) -> None:
    batch_id, chunks = add_batch(sessions, 2)
    held = claim(sessions, chunks[0])
    sound = replace(point_result(1), ranking_figures={"largest_vertical_m": 1.0})
    with sessions.begin() as session:
        assert leases.finish(session, held, [sound, point_result(2, failure="Bad.")])
    assert pages(sessions, batch_id, AMPLITUDE, 10) == [1]
    with sessions.begin() as session:
        (again,) = batch_records.resubmit(session, LOCAL, batch_id, 10)
    assert pages(sessions, batch_id, AMPLITUDE, 10) == [1]
    held = claim(sessions, again)
    with sessions.begin() as session:
        assert leases.finish(session, held, [replace(point_result(2), ranking_figures={"largest_vertical_m": 2.0})])
    assert pages(sessions, batch_id, AMPLITUDE, 10) == [2, 1]


@pytest.mark.parametrize("other", ["batch", "order", "key", "text"])
def test_a_cursor_holds_for_its_batch_and_order_only(other: str) -> None:
    batch_id = uuid4()
    cursor = ranking.encode(KEY, batch_id, AMPLITUDE, Place(1.0, 2, 3))
    key, batch, order = KEY, batch_id, AMPLITUDE
    if other == "batch":
        batch = uuid4()
    elif other == "order":
        order = CRITICAL
    elif other == "key":
        key = b"x" * 32
    else:
        cursor = "A" + cursor[1:] if cursor[0] != "A" else "B" + cursor[1:]
    with pytest.raises(BadCursor):
        ranking.decode(key, batch, order, cursor)
