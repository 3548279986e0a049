from dataclasses import asdict, replace
from typing import Any

import pytest

from app import convert
from app.convert.assemble import SoundParts, gather
from app.convert.known.own_rows import OwnRows
from app.convert.known.to_document import document_path
from app.convert.known.to_engine import known_line
from app.schemas import Line
from app.schemas.faults import BadInput
from app.schemas.known import KnownLine
from engine.known.resolve import resolve
from tests.app.known_documents import CONTRACT, LINES, changed


def numbers(node: Any) -> list[Any]:
    """Return the leaves of nested data in order."""
    if isinstance(node, dict):
        return [leaf for key in sorted(node) for leaf in numbers(node[key])]
    if isinstance(node, list | tuple):
        return [leaf for item in node for leaf in numbers(item)]
    return [node]


@pytest.mark.parametrize("name", LINES)
def test_the_explicit_document_is_the_line_that_was_resolved(name: str) -> None:
    """The engine reads from it the very line that it made, so every analysis gives the same results."""
    made = resolve(known_line(KnownLine.model_validate(LINES[name]), OwnRows())).line
    explicit = convert.resolve_document(LINES[name])["line"]
    read, _, faults = gather(SoundParts.of(Line.model_validate(explicit)), None)
    assert faults == []
    assert read is not None
    # The analysis decides on the section, and resolving hands on climate and design wind as they were said.
    bundle = replace(read.bundle, section=made.bundle.section)
    settled = replace(read, bundle=bundle, climate=None, required_clearance=None, design_wind=None)
    expected, found = numbers(asdict(made)), numbers(asdict(settled))
    assert len(expected) == len(found)
    for here, there in zip(expected, found, strict=True):
        assert there == (pytest.approx(here, rel=1e-12, abs=1e-13) if isinstance(here, float) else here)


@pytest.mark.parametrize("name", LINES)
def test_an_explicit_document_resolves_to_itself(name: str) -> None:
    explicit = convert.resolve_document(LINES[name])["line"]
    again = convert.resolve_document(explicit)
    assert again["line"] == explicit
    assert "catalogue" not in {row["origin"] for row in again["assumptions"]}
    assert {row["path"] for row in again["assumptions"] if row["origin"] == "assumed"} <= {
        "supports.left.adjacent_span_m",
        "supports.right.adjacent_span_m",
        "conductor.area_m2",
    }


def test_every_value_has_its_origin_and_every_assumed_one_its_range() -> None:
    rows = {row["path"]: row for row in convert.resolve_document(CONTRACT)["assumptions"]}
    assert rows["conductor.diameter_m"]["origin"] == "catalogue"
    assert rows["ice.accretion.thickness_m"] == {
        "path": "ice.accretion.thickness_m",
        "value": 0.012,
        "unit": "m",
        "origin": "given",
        "source": "as given",
        "lowest": None,
        "highest": None,
    }
    assert (rows["ice.accretion.angle_deg"]["value"], rows["ice.accretion.angle_deg"]["unit"]) == (0.0, "deg")
    torsion = rows["conductor.torsional_rigidity_n_m2"]
    assert torsion["origin"] == "assumed"
    assert torsion["lowest"] < torsion["value"] < torsion["highest"]
    for row in rows.values():
        assert (row["lowest"] is None) == (row["origin"] != "assumed")
        assert row["source"]


def test_twenty_percent_of_the_rated_strength_is_the_everyday_tension() -> None:
    states = convert.resolve_document(CONTRACT)["states"]
    assert states["everyday"]["horizontal_tension_n"] == pytest.approx(0.2 * 140_120.0)
    assert states["iced"]["horizontal_tension_n"] > states["everyday"]["horizontal_tension_n"]
    assert convert.resolve_document(LINES["explicit"])["states"] == {"everyday": None, "iced": None}


def test_what_resolving_does_not_touch_stays_in_the_line() -> None:
    resolved = convert.resolve_document(CONTRACT)
    assert resolved["line"]["design_wind_m_per_s"] == 10.0
    assert resolved["line"]["climate"]["icing"][0]["hours_a_year"] == 40.0
    assert [phase["name"] for phase in resolved["line"]["phases"]] == ["top", "ground wire"]


def test_faults_of_the_whole_line_are_found() -> None:
    device = {"type": "spacer", "position_m": 400.0, "mass_kg": 6.5, "polar_inertia_kg_m2": 0.4}
    with pytest.raises(BadInput) as caught:
        convert.resolve_document(changed(devices=[device]))
    assert [fault.pointer for fault in caught.value.faults] == ["/devices/0/position_m"]


@pytest.mark.parametrize(
    ("engine", "document"),
    [
        ("conductor.modulus", "conductor.youngs_modulus_pa"),
        ("ice.aerodynamics_at_rest.horizontal", "ice.aerodynamics_at_rest.horizontal"),
        ("ice.aerodynamics.reference_diameter", "ice.aerodynamics.reference_diameter_m"),
        ("span.everyday.temperature", "span.everyday.temperature_c"),
        ("supports.left.adjacent_span", "supports.left.adjacent_span_m"),
        ("ice.aerodynamics.vertical_factor", "ice.aerodynamics.vertical_factor"),
    ],
)
def test_paths_are_those_of_documents(engine: str, document: str) -> None:
    assert document_path(engine) == document


def test_a_section_has_the_ruling_span_of_its_spans_and_holds_the_ends() -> None:
    resolved = convert.resolve_document(LINES["in a section on a slope"])
    rows = {row["path"]: row for row in resolved["assumptions"]}
    ruling = rows["span.ruling_span_m"]
    assert (ruling["origin"], ruling["value"]) == ("computed", pytest.approx((84.889e6 / 910.0) ** 0.5))
    assert not any(path.startswith("supports.") for path in rows)
    assert [span["level_difference_m"] for span in resolved["line"]["section"]["spans"]] == [0.0, 12.0, -5.0]
    alone = dict(LINES["in a section on a slope"])
    del alone["section"]
    alone["span"] = {**alone["span"], "ruling_span_m": ruling["value"]}
    spelled = convert.resolve_document(alone)["line"]
    assert resolved["line"]["span"] == spelled["span"]


def test_faults_of_a_section_point_into_it() -> None:
    line = dict(LINES["in a section on a slope"])
    line["section"] = {**line["section"], "strings": []}
    with pytest.raises(BadInput) as caught:
        convert.resolve_document(line)
    assert [fault.pointer for fault in caught.value.faults] == ["/section/strings"]
