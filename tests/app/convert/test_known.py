from dataclasses import replace

import pytest

from app import convert
from app.reference.conductors import named
from app.reference.source_lines import example
from app.schemas.faults import BadInput
from engine.known.resolve import resolve
from tests.app.known_documents import CONTRACT, changed


def test_an_explicit_line_stays_the_object_that_it_is() -> None:
    line = example("c11-twin")
    found, known = convert.explicit_line(line)
    assert found is line
    assert known is None
    assert convert.explicit_request({"line": line})["line"] is line
    assert convert.explicit_request([1]) == [1]


def test_the_line_of_a_request_is_resolved_and_the_rest_is_kept() -> None:
    found = convert.explicit_request({"line": CONTRACT, "analysis": {"loops": [1]}})
    assert found == {
        "line": convert.resolve_document(CONTRACT)["line"],
        "analysis": {"loops": [1]},
        "known": {"line": CONTRACT, "conductors": [], "tables": []},
    }
    assert convert.read(found).line.conductor.diameter == 0.02814


def test_faults_of_the_line_of_a_request_begin_at_its_root() -> None:
    with pytest.raises(BadInput) as caught:
        convert.explicit_request({"line": changed(conductor={"catalogue": "x"})})
    assert [fault.pointer for fault in caught.value.faults] == ["/line/conductor/catalogue"]


def test_a_result_lists_where_the_values_of_its_line_came_from() -> None:
    asked = convert.explicit_request({"line": CONTRACT, "analysis": {"loops": [1], "wind_speeds_m_per_s": [5.0]}})
    (point,) = (item for item in convert.run(convert.read(asked).kept()) if isinstance(item, convert.PointResult))
    assert point.tables["assumptions"] == convert.resolve_document(CONTRACT)["assumptions"]
    plain = {"line": asked["line"], "analysis": asked["analysis"]}
    (explicit,) = (item for item in convert.run(convert.read(plain).kept()) if isinstance(item, convert.PointResult))
    assert explicit.tables["assumptions"] == []
    assert explicit.tables["critical_wind_speeds"] == point.tables["critical_wind_speeds"]


def test_own_rows_that_a_line_names_go_with_its_request() -> None:
    (drake,) = named("795 kcmil 26/7")
    own = convert.OwnRows([replace(drake, name="Mine", designation="Mine", diameter_m=0.029, own=True), drake])
    asked = convert.explicit_request({"line": changed(conductor={"catalogue": "mine"})}, own)
    assert [row["name"] for row in asked["known"]["conductors"]] == ["Mine"]
    known = convert.known_of(convert.read(asked))
    assert known is not None
    assert resolve(known).line.conductor.diameter == 0.029
    assert convert.known_of(convert.read({"line": example("c11-twin")})) is None


def test_a_request_that_was_given_back_is_taken_again_unless_it_was_changed() -> None:
    kept = convert.read(convert.explicit_request({"line": CONTRACT})).kept()
    assert convert.explicit_request(kept) is kept
    kept["line"]["damping"]["torsional_ratio"] = 0.2
    for wrong in (kept, {**kept, "known": {"line": 1}}):
        with pytest.raises(BadInput) as caught:
            convert.explicit_request(wrong)
        assert [fault.pointer for fault in caught.value.faults] == ["/known"]


@pytest.mark.parametrize(
    ("part", "field"),
    [
        ("damping", "vertical_ratio"),
        ("conductor", "torsional_rigidity_n_m2"),
        ("conductor", "polar_inertia_kg_m"),
        ("conductor", "axial_rigidity_n"),
    ],
)
def test_nothing_that_can_be_estimated_is_required(part: str, field: str) -> None:
    line = example("c11-twin")
    line[part] = {name: value for name, value in line[part].items() if name != field}
    request = convert.read(convert.explicit_request({"line": line}))
    assert request.known is not None
    rows = {row["path"]: row for row in convert.resolve_document(line)["assumptions"]}
    assert rows[f"{part}.{field}"]["origin"] in {"assumed", "computed"}
    told = request.line.model_dump(by_alias=True)[part][field]
    assert told == pytest.approx(rows[f"{part}.{field}"]["value"])
    assert request.kept()["line"]["span"]["horizontal_tension_n"] == line["span"]["horizontal_tension_n"]


def test_what_cannot_be_estimated_is_missed_by_its_name() -> None:
    line = example("c11-twin")
    del line["conductor"]["mass_kg_per_m"]
    with pytest.raises(BadInput) as caught:
        convert.read(convert.explicit_request({"line": line}))
    assert [(fault.pointer, fault.code) for fault in caught.value.faults] == [
        ("/line/conductor/mass_kg_per_m", "missing")
    ]
