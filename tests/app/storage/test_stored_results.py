from uuid import UUID

import pytest
from sqlalchemy import select
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session, sessionmaker

from app import convert
from app.convert import TABLES, PointResult
from app.jobs import leases
from app.storage import stored_results
from app.tables import PointRow
from tests.documents import add_job, long_request, point_result, short_request


@pytest.fixture(scope="module")
def computed() -> list[PointResult]:
    """Compute a study of two points for real."""
    return [item for item in convert.run(long_request(2)) if isinstance(item, PointResult)]


def keep(sessions: sessionmaker[Session], points: list[PointResult]) -> UUID:
    job_id = add_job(sessions)
    with sessions.begin() as session:
        stored_results.store(session, job_id, stored_results.rows_of(points))
    return job_id


def test_every_table_comes_back_as_the_engine_gave_it(
    sessions: sessionmaker[Session], computed: list[PointResult]
) -> None:
    job_id = keep(sessions, computed[::-1])
    for table in TABLES:
        expected = [{**point.axes, **row} for point in computed for row in point.tables[table]]
        with sessions() as session:
            rows = list(stored_results.rows(session, job_id, table))
        assert rows == expected
        assert [list(row) for row in rows] == [list(row) for row in expected]
    assert all(point.tables["limit_cycles"] for point in computed)


def test_points_come_back_as_the_engine_gave_them(sessions: sessionmaker[Session], computed: list[PointResult]) -> None:
    job_id = keep(sessions, computed)
    with sessions() as session:
        found = list(stored_results.points(session, job_id))
    for kept, point in zip(found, computed, strict=True):
        assert kept == {
            "point": point.point,
            "axes": point.axes,
            "static": point.static,
            "den_hartog": point.den_hartog,
            "warnings": point.warnings,
            "engine_version": point.engine_version,
            "failure": None,
        }
    assert [list(kept["axes"]) for kept in found] == [["span.horizontal_tension_n"]] * 2


def test_orbits_come_back_as_the_engine_gave_them(sessions: sessionmaker[Session], computed: list[PointResult]) -> None:
    job_id = keep(sessions, computed)
    expected = [{"point": point.point, **orbit} for point in computed for orbit in point.orbits]
    with sessions() as session:
        assert list(stored_results.orbits(session, job_id)) == expected
    assert expected


def test_failed_point_has_its_sentence_and_no_numbers(sessions: sessionmaker[Session]) -> None:
    job_id = keep(sessions, [point_result(0), point_result(1, failure="It overflowed.")])
    with sessions() as session:
        found = list(stored_results.points(session, job_id))
        rows = list(stored_results.rows(session, job_id, "frequencies"))
    assert [(point["failure"], point["static"], point["den_hartog"]) for point in found[1:]] == [
        ("It overflowed.", None, None)
    ]
    assert len(rows) == 1


def test_jobs_do_not_see_each_others_rows(sessions: sessionmaker[Session]) -> None:
    keep(sessions, [point_result()])
    other = add_job(sessions)
    with sessions() as session:
        assert list(stored_results.rows(session, other, "frequencies")) == []
        assert list(stored_results.points(session, other)) == []


def test_peaks_stand_beside_what_is_packed(sessions: sessionmaker[Session], computed: list[PointResult]) -> None:
    job_id = keep(sessions, computed)
    names = PointRow.lowest_critical_wind_speed_m_per_s, PointRow.largest_vertical_m
    with sessions() as session:
        kept = session.execute(select(*names).where(PointRow.job_id == job_id).order_by(PointRow.point)).all()
    for peaks, point in zip(kept, computed, strict=True):
        winds = [row["wind_speed_m_per_s"] for row in point.tables["critical_wind_speeds"]]
        amplitudes = [row["vertical_m"] for row in point.tables["limit_cycles"] if row["stability"] == "stable"]
        assert tuple(peaks) == (min(winds), max(amplitudes))


def test_a_point_is_one_row_much_smaller_than_its_text(
    sessions: sessionmaker[Session], computed: list[PointResult]
) -> None:
    job_id = keep(sessions, computed)
    with sessions() as session:
        kept = session.execute(select(PointRow.tables, PointRow.orbits).where(PointRow.job_id == job_id)).all()
    assert len(kept) == len(computed)
    packed = sum(len(part) for row in kept for part in row)
    assert packed < 0.4 * sum(len(point.tables_json) + len(point.orbits_json) for point in computed)


def test_a_point_is_stored_once(sessions: sessionmaker[Session]) -> None:
    job_id = keep(sessions, [point_result()])
    with pytest.raises(IntegrityError), sessions.begin() as session:
        stored_results.store(session, job_id, stored_results.rows_of([point_result()]))


def test_a_job_without_study_has_no_axes(sessions: sessionmaker[Session]) -> None:
    points = [item for item in convert.run(short_request()) if isinstance(item, PointResult)]
    job_id = add_job(sessions)
    with sessions.begin() as session:
        held = leases.claim(session, job_id, "here", 60.0)
        assert held is not None
        assert leases.finish(session, held, points)
    with sessions() as session:
        first = next(stored_results.rows(session, job_id, "frequencies"))
        assert list(first) == list(points[0].tables["frequencies"][0])
        (point,) = stored_results.points(session, job_id)
    assert point["axes"] == {}
