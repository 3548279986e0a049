import json
from typing import Any

import pytest

from app import convert
from app.convert import PointResult
from app.reference.source_lines import EXAMPLE_NAMES, example
from app.reference.source_studies import STUDY_NAMES, study_request
from tests.app.lines import faults


def points(name: str, line: str, **analysis: Any) -> list[PointResult]:
    request = study_request(name, line)
    document = convert.read({**request, "analysis": {**request["analysis"], **analysis}})
    found = convert.run(document.model_dump(mode="json", by_alias=True))
    return [item for item in found if isinstance(item, PointResult)]


@pytest.mark.parametrize("line", EXAMPLE_NAMES)
@pytest.mark.parametrize("name", STUDY_NAMES)
def test_every_study_is_a_request_that_is_taken_as_it_is(name: str, line: str) -> None:
    request = study_request(name, line)
    assert faults(json.loads(json.dumps(request))) == []
    assert request["line"]["name"] == example(line)["name"]


def test_two_requests_share_nothing() -> None:
    first = study_request("figure-4", "c11-twin")
    first["study"]["axes"][0]["values"].clear()
    first["line"]["ice"]["aerodynamics"]["vertical"].clear()
    assert study_request("figure-4", "c11-twin")["study"]["axes"][0]["values"]
    assert example("c11-twin")["ice"]["aerodynamics"]["vertical"]


def test_damping_raises_the_critical_speed_and_lowers_the_amplitude() -> None:
    found = points("figure-4", "c11-twin")
    onset = [point.tables["critical_wind_speeds"][0]["wind_speed_m_per_s"] for point in found]
    assert onset == sorted(onset)
    assert onset[8] == pytest.approx(2.403, rel=0.005)  # the source's damping
    amplitudes = [
        row["vertical_ratio"]
        for point in found
        for row in point.tables["limit_cycles"]
        if row["kind"] == "periodic" and row["stability"] == "stable" and row["loops"] == 1
    ]
    assert len(amplitudes) == len(found)
    assert amplitudes == sorted(amplitudes, reverse=True)


def test_a_study_outlives_the_spans_on_which_ice_twists_the_conductor_over() -> None:
    found = points("figure-9", "c11-single", loops=[1])
    rows = {point.axes["span.length_m"]: point.tables["limit_cycles"] for point in found}
    assert {row["outcome"] for row in rows[100] if row["stability"] == "stable"} == {"converged"}
    assert {row["outcome"] for row in rows[200]} == {"statically_unstable"}
    assert [point.failure for point in found] == [None] * len(found)
