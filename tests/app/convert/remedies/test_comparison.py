"""Remedies through the border: checked with pointers, run, and given back as rows."""

import copy
from typing import Any

import pytest

from app import convert, schemas
from app.answers.rows import row_schema
from app.reference.source_lines import example
from app.schemas.faults import BadInput
from app.schemas.request import RemediesRequest
from tests.app.known_documents import CONTRACT
from tests.app.lines import COEFFICIENTS, faults

PENDULUM: dict[str, Any] = {"type": "detuning_pendulum", "positions_m": [31.47, 94.41], "mass_kg": 15.0, "arm_m": 0.3}
TENSION = {"type": "tension", "factor": 1.2}
ANALYSIS = {"loops": [2], "wind_speeds_m_per_s": [6.0]}


def request(*tried: dict[str, Any], line: Any = None, **changes: Any) -> dict[str, Any]:
    return {
        "line": line or example("c11-twin"),
        "analysis": ANALYSIS,
        "remedies": {"tried": copy.deepcopy(list(tried)), **changes},
    }


def run(document: dict[str, Any]) -> convert.PointResult:
    kept = convert.read(convert.explicit_request(document)).kept()
    (point,) = (item for item in convert.run(kept) if isinstance(item, convert.PointResult))
    return point


def test_each_remedy_has_a_row_beside_the_line_as_it_is() -> None:
    kept = convert.read(request(PENDULUM, TENSION)).kept()
    assert kept["analysis"]["models"] == ["hybrid"]
    assert kept["remedies"]["tried"][0]["angle_deg"] == 0.0
    point = run(kept)
    first, pendulums, tension = point.tables["remedies"]
    assert (first["kind"], first["remedy"]) == ("none", None)
    assert pendulums["places"] == "31.47 94.41"
    assert pendulums["change"] == "better"
    assert tension["static_tension_n"] == pytest.approx(36_000.0)
    assert list(tension) == convert.columns("remedies")
    assert row_schema(convert.TABLES["remedies"].row).model_validate(pendulums).model_dump()["rank"] == 1
    line = example("c11-twin")
    line["devices"] = [{**PENDULUM, "position_m": place} for place in PENDULUM["positions_m"]]
    for device in line["devices"]:
        del device["positions_m"]
    alone = run({"line": line, "analysis": {**ANALYSIS, "models": ["hybrid"]}})
    assert alone.verdict is not None
    assert pendulums["onset_m_per_s"] == pytest.approx(alone.verdict["onset_m_per_s"], rel=1e-9)


def test_every_kind_of_remedy_reaches_the_engine() -> None:
    spoiler = {"type": "airflow_spoiler", "length_m": 30.0, "aerodynamics": COEFFICIENTS}
    kinds = [
        PENDULUM,
        {"type": "spacer", "count": 2},
        {"type": "torsional_damper", "count": 1, "damping_n_m_s": 3.0},
        spoiler,
        {"type": "moved", "device": "spacer", "positions_m": [70.0]},
        {"type": "tension", "horizontal_tension_n": 31000.0},
    ]
    line = example("c11-twin")
    line["devices"] = [{"type": "spacer", "position_m": 60.0, "mass_kg": 6.5, "polar_inertia_kg_m2": 0.4}]
    made = convert.read(request(*kinds, line=line))
    assert made.remedies is not None
    built = convert.remedies(made.remedies)
    assert built.tried is not None
    assert [remedy.kind for remedy in built.tried] == [kind["type"] for kind in kinds]


@pytest.mark.parametrize(
    ("remedy", "pointer"),
    [
        ({**PENDULUM, "positions_m": [31.0, 200.0]}, "/remedies/tried/0/positions_m"),
        ({**PENDULUM, "count": 3}, "/remedies/tried/0"),
        ({"type": "detuning_pendulum", "count": 20}, "/remedies/separation_m"),
        ({"type": "moved", "device": "spacer"}, "/remedies/tried/0/device"),
        ({"type": "interphase_spacer", "count": 1, "between": ["this", "top"]}, "/remedies/tried/0/between"),
        ({"type": "tension"}, "/remedies/tried/0"),
        ({"type": "wings"}, "/remedies/tried/0"),
    ],
)
def test_faults_point_at_the_remedy(remedy: dict[str, Any], pointer: str) -> None:
    found = [fault.pointer for fault in faults(request(remedy, separation_m=8.0))]
    assert found[:1] == [pointer]


def test_a_known_lines_tension_is_the_everyday_one() -> None:
    analysis = {"loops": [1], "wind_speeds_m_per_s": [], "uncertainty": {"samples": 4}}
    point = run({"line": CONTRACT, "analysis": analysis, "remedies": {"tried": [TENSION]}})
    first, tension = point.tables["remedies"]
    assert 1.05 < tension["static_tension_n"] / first["static_tension_n"] < 1.2
    assert (first["samples"], tension["samples"]) == (4, 4)
    assert tension["improves"] is not None
    with pytest.raises(BadInput) as caught:
        convert.read(
            convert.explicit_request({"line": CONTRACT, "remedies": {"tried": [{"type": "tension", "factor": 6.0}]}})
        )
    (fault,) = caught.value.faults
    assert fault.pointer == "/remedies/tried/0/factor"
    assert "rated strength" in fault.detail


def test_remedies_exclude_a_placement_and_are_usual_where_none_are_named() -> None:
    document = {**request(PENDULUM), "study": {"axes": [{"parameter": "span.sag_m", "values": [1.0]}]}}
    assert "" in [fault.pointer for fault in faults(document)]
    usual = RemediesRequest.model_validate({"line": example("c11-twin")})
    assert usual.kept()["remedies"] == {"tried": None, "separation_m": None}
    assert usual.analysis.models == ["hybrid"]
    both = RemediesRequest.model_validate({"line": example("c11-twin"), "analysis": {"models": ["finite_element"]}})
    assert both.analysis.models == ["finite_element"]
    assert "remedies" not in schemas.JobRequest.model_validate({"line": example("c11-twin")}).kept()
