from uuid import UUID

import pytest
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session, sessionmaker

from app import convert, leases, results
from app.convert import PointResult
from app.results import Table
from tests.documents import add_job, long_request, point_result, short_request

TABLES: tuple[Table, ...] = ("frequencies", "critical_wind_speeds", "limit_cycles", "bifurcations")


@pytest.fixture(scope="module")
def computed() -> list[PointResult]:
    """Compute a study of two points for real."""
    return [item for item in convert.run(long_request(2)) if isinstance(item, PointResult)]


def keep(sessions: sessionmaker[Session], points: list[PointResult]) -> UUID:
    job_id = add_job(sessions)
    with sessions.begin() as session:
        results.store(session, job_id, points)
    return job_id


def test_every_table_comes_back_as_the_engine_gave_it(
    sessions: sessionmaker[Session], computed: list[PointResult]
) -> None:
    job_id = keep(sessions, computed[::-1])
    for table in TABLES:
        expected = [{**point.axes, **row} for point in computed for row in point.tables[table]]
        with sessions() as session:
            rows = list(results.rows(session, job_id, table))
        assert rows == expected
        assert [list(row) for row in rows] == [list(row) for row in expected]
    assert all(point.tables["limit_cycles"] for point in computed)


def test_points_come_back_as_the_engine_gave_them(sessions: sessionmaker[Session], computed: list[PointResult]) -> None:
    job_id = keep(sessions, computed)
    with sessions() as session:
        found = list(results.points(session, job_id))
        names = results.axes(session, job_id)
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
    assert names == ["span.horizontal_tension_n"]


def test_orbits_come_back_as_the_engine_gave_them(sessions: sessionmaker[Session], computed: list[PointResult]) -> None:
    job_id = keep(sessions, computed)
    expected = [{"point": point.point, **orbit} for point in computed for orbit in point.orbits]
    with sessions() as session:
        assert list(results.orbits(session, job_id)) == expected
    assert expected


def test_columns_are_those_of_the_engine_without_keys(computed: list[PointResult]) -> None:
    for table in ("frequencies", "limit_cycles"):
        assert results.columns(table) == list(computed[0].tables[table][0])
    assert results.columns("bifurcations")[:3] == ["model", "loops", "branch"]


def test_failed_point_has_its_sentence_and_no_numbers(sessions: sessionmaker[Session]) -> None:
    job_id = keep(sessions, [point_result(0), point_result(1, failure="It overflowed.")])
    with sessions() as session:
        found = list(results.points(session, job_id))
        rows = list(results.rows(session, job_id, "frequencies"))
    assert [(point["failure"], point["static"], point["den_hartog"]) for point in found[1:]] == [
        ("It overflowed.", None, None)
    ]
    assert len(rows) == 1


def test_jobs_do_not_see_each_others_rows(sessions: sessionmaker[Session]) -> None:
    keep(sessions, [point_result()])
    other = add_job(sessions)
    with sessions() as session:
        assert list(results.rows(session, other, "frequencies")) == []
        assert list(results.points(session, other)) == []
        assert results.axes(session, other) == []


def test_rows_with_other_columns_are_refused(sessions: sessionmaker[Session]) -> None:
    more, less = point_result(), point_result()
    more.tables["frequencies"][0]["vertical_hertz"] = 1.0
    del less.tables["frequencies"][0]["vertical_hz"]
    job_id = add_job(sessions)
    for point, name in ((more, "vertical_hertz"), (less, "vertical_hz")):
        with pytest.raises(ValueError, match=rf"\['{name}'\]"), sessions.begin() as session:
            results.store(session, job_id, [point])


def test_rows_without_a_needed_value_are_refused(sessions: sessionmaker[Session]) -> None:
    point = point_result()
    point.tables["frequencies"][0]["loops"] = None
    job_id = add_job(sessions)
    with pytest.raises(IntegrityError), sessions.begin() as session:
        results.store(session, job_id, [point])


def test_a_job_without_study_has_no_axes(sessions: sessionmaker[Session]) -> None:
    points = [item for item in convert.run(short_request()) if isinstance(item, PointResult)]
    job_id = add_job(sessions)
    with sessions.begin() as session:
        held = leases.claim(session, job_id, "here", 60.0)
        assert held is not None
        assert leases.finish(session, held, points)
    with sessions() as session:
        first = next(results.rows(session, job_id, "frequencies"))
        assert list(first) == list(points[0].tables["frequencies"][0])
        assert results.axes(session, job_id) == []
