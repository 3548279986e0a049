import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session, sessionmaker

from app.storage import stored_bytes, stored_results
from app.tables import BatchItem, PointRow
from tests.batch_rows import add_batch
from tests.documents import add_job, point_result


def test_points_have_the_same_size_before_and_after_they_are_stored(sessions: sessionmaker[Session]) -> None:
    job_id = add_job(sessions)
    rows = stored_results.rows_of([point_result(0), point_result(1, failure="It overflowed.")])
    size = 2 * stored_bytes.ROW_BYTES + len(rows[0]["tables"]) + len(rows[0]["orbits"])
    assert stored_bytes.of_points(rows) == size
    with sessions.begin() as session:
        stored_results.store(session, job_id, rows)
        assert session.scalar(select(stored_bytes.of_stored_points(PointRow.job_id == job_id))) == size
        first = PointRow.job_id == job_id, PointRow.point == 1
        assert session.scalar(select(stored_bytes.of_stored_points(*first))) == stored_bytes.ROW_BYTES
        assert session.scalar(select(stored_bytes.of_stored_points(PointRow.point == 7))) == 0


def test_lines_are_as_large_as_their_texts_in_utf_8(sessions: sessionmaker[Session]) -> None:
    batch_id, _ = add_batch(sessions, 1)
    faults = [{"pointer": "", "code": "missing", "detail": "größer"}]
    rejected = {"batch_id": batch_id, "number": 2, "chunk_id": None, "reference": None, "asset_id": None}
    texts = '{"n":1}', '[{"pointer":"","code":"missing","detail":"größer"}]'
    with sessions.begin() as session:
        session.add(BatchItem(**rejected, document=None, faults=faults))
        session.flush()
        size = session.scalar(select(stored_bytes.of_lines(session, BatchItem.batch_id == batch_id)))
    assert size == sum(len(text.encode()) for text in texts)


@pytest.mark.parametrize(("document", "size"), [({}, 2), ({"a": "ö"}, 10)])
def test_a_request_is_as_large_as_its_text_and_its_row(document: dict[str, str], size: int) -> None:
    assert stored_bytes.of_request(document) == size + stored_bytes.ROW_BYTES
