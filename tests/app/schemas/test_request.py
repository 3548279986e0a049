import math
from typing import Any

import pytest
from pydantic import ValidationError

from app import schemas
from app.reference.source_lines import example


@pytest.mark.parametrize(
    "axes",
    [
        [],
        [{"parameter": "span.length_m", "values": []}],
        [{"parameter": "span.length_m", "values": [1]}, {"parameter": "span.length_m", "values": [2]}],
        [{"parameter": f"span.{name}", "values": [1]} for name in ("length_m", "sag_m", "elements")],
        [
            {"parameter": "span.length_m", "values": [100.0] * 101},
            {"parameter": "span.horizontal_tension_n", "values": [3e4] * 100},
        ],
        [{"parameter": "span.length_m", "values": [True]}],
        [{"parameter": "span.length_m", "values": [math.nan]}],
        [{"parameter": "span.length_m", "values": [10**400]}],
        [{"parameter": "span..length_m", "values": [1]}],
        [{"parameter": "__class__.x", "values": [1]}],
        [{"parameter": "span.length_m", "also": ["span.length_m"], "values": [1]}],
        [{"parameter": "span.length_m", "also": ["__class__.x"], "values": [1]}],
    ],
)
def test_a_study_has_one_or_two_axes_of_different_fields_and_at_most_ten_thousand_points(axes: list[Any]) -> None:
    with pytest.raises(ValidationError):
        schemas.Study.model_validate({"axes": axes})


def test_documents_that_leave_a_field_out_share_its_default_which_nobody_can_change() -> None:
    first, second = (schemas.JobRequest.model_validate({"line": example("c11-twin")}) for _ in range(2))
    assert first.analysis is second.analysis
    with pytest.raises(ValidationError, match="frozen"):
        first.analysis.harmonics = 7  # type: ignore[misc]
    given = schemas.JobRequest.model_validate({"line": example("c11-twin"), "analysis": {"harmonics": 7}})
    assert (given.analysis.harmonics, second.analysis.harmonics) == (7, 5)
