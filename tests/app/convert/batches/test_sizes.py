from typing import Any

import pytest

from app import schemas
from app.convert import PointResult, bytes_a_line, expected_bytes, run
from app.reference.source_lines import example
from app.storage import stored_bytes, stored_results

WINDS = {"start": 4.0, "stop": 12.0, "count": 11}
HYBRID: dict[str, Any] = {"models": ["hybrid"], "wind_speeds_m_per_s": WINDS}
BOTH: dict[str, Any] = {"loops": [1], "finite_element_loops": [1], "wind_speeds_m_per_s": [4.0, 5.0, 6.0]}


@pytest.mark.parametrize(
    "analysis", [{**HYBRID, "loops": [1]}, {**HYBRID, "loops": [1, 2]}, {**HYBRID, "harmonics": 12}, BOTH]
)
def test_what_is_expected_is_about_what_a_galloping_line_leaves(analysis: dict[str, Any]) -> None:
    request = schemas.JobRequest.model_validate({"line": example("c11-twin"), "analysis": analysis})
    points = [item for item in run(request.kept(), ()) if isinstance(item, PointResult)]
    found = stored_bytes.of_points(stored_results.rows_of(points))
    assert expected_bytes(request.kept()) == pytest.approx(found, rel=0.35)


def test_every_point_of_a_study_counts_as_a_line() -> None:
    analysis = {"loops": [1, 2], "models": ["hybrid"]}
    axes = [{"parameter": "span.length_m", "values": [1.0] * 100}, {"parameter": "wind.yaw_deg", "values": [0.0] * 50}]
    one = bytes_a_line(schemas.Analysis.model_validate(analysis))
    assert expected_bytes({"analysis": analysis}) == one
    assert expected_bytes({"analysis": analysis, "study": {"axes": axes}}) == 5000 * one
    more = bytes_a_line(schemas.Analysis.model_validate({**analysis, "loops": [1, 2, 3, 4]}))
    assert 1.3 * one < more < 2.0 * one


def test_a_request_of_an_earlier_version_counts_as_one_with_the_defaults() -> None:
    assert expected_bytes({"analysis": {"loops": "all"}}) == expected_bytes({}) == bytes_a_line(schemas.Analysis())
