from pathlib import Path

import pytest

from app.exchange.cim import read_segments
from app.schemas.faults import BadInput
from app.sheets.columns import PlacedLine
from tests.app.exchange.cim_files import an_object, file, pieces

EXAMPLE = Path(__file__).parents[3] / "docs" / "examples" / "segments.xml"


def lines(body: bytes, defaults: object = None) -> tuple[list[PlacedLine], list[str]]:
    found = read_segments(pieces(body), defaults, 1_000_000, 100_000)
    return list(found.lines), found.notes.sentences()


def segment(length: str = "300", **attributes: str) -> str:
    return an_object("ACLineSegment", "_s", Conductor__length=length, **attributes)


def test_the_example_says_wires_bundle_phases_and_spans() -> None:
    (first, second, third), notes = lines(EXAMPLE.read_bytes())
    assert first.document == {
        "reference": "7a0e3c52-9a55-4b6b-8d0f-0c6f5d1c0017",
        "name": "Tower 17 to tower 18",
        "asset_id": "L204-S017",
        "conductor": {"catalogue": "Drake", "diameter_m": 0.02814},
        "bundle": {"subconductors": 2, "spacing_m": 0.457},
        "span": {"length_m": 305.5},
        "phases": [
            {"name": "A", "y_m": 7.2, "z_m": -0.5},
            {"name": "C", "y_m": -7.2, "z_m": -0.5},
            {"name": "N", "y_m": 14.0, "z_m": -4.6},
        ],
    }
    assert (first.place, first.geometry) == ("ACLineSegment _segment-17", None)
    assert [line.place for line in (second, third)] == [f"ACLineSegment _segment-18, span {i}" for i in (1, 2)]
    assert second.geometry == {"type": "LineString", "coordinates": [[14.4241, 50.0886], [14.4279, 50.0903]]}
    lengths = [line.computed[0].value for line in (second, third)]
    assert sum(lengths) == pytest.approx(662.22, abs=0.01)
    assert notes == ["Conductor.length was read in metres, as CIM declares it."]


def test_lengths_are_kilometres_in_cgmes() -> None:
    for profile in ("http://entsoe.eu/CIM/EquipmentCore/3/1", "http://iec.ch/TC57/ns/CIM/CoreEquipment-EU/3.0"):
        head = f'<md:FullModel rdf:about="urn:uuid:m"><md:Model.profile>{profile}</md:Model.profile></md:FullModel>'
        (line,), notes = lines(file(head, segment("0.3")))
        assert line.document == {"reference": "_s", "span": {"length_m": 300.0}}
        assert notes == ["Conductor.length was read in kilometres, as CGMES declares it."]


def test_numbers_that_are_none_are_told_of_by_their_attribute() -> None:
    (line,), _ = lines(file(segment("long")))
    (fault,) = line.faults
    assert (fault.pointer, fault.detail) == (
        "/span/length_m",
        "Conductor.length of _s must be a number, got 'long'",
    )


def test_a_length_that_is_not_that_of_its_positions_is_noted() -> None:
    system = an_object("CoordinateSystem", "_c", CoordinateSystem__crsUrn="urn:ogc:def:crs:EPSG::4326")
    place = an_object("Location", "_l", Location__PowerSystemResources="#_s", Location__CoordinateSystem="#_c")
    points = [
        an_object(
            "PositionPoint",
            f"_p{i}",
            PositionPoint__Location="#_l",
            PositionPoint__sequenceNumber=str(i),
            PositionPoint__xPosition="14.0",
            PositionPoint__yPosition=f"{50.0 + 0.003 * i}",
        )
        for i in range(3)
    ]
    for count, made in ((2, 1), (3, 2)):
        found, notes = lines(file(segment("300"), system, place, *points[:count]))
        assert len(found) == made
        assert notes[1].endswith("more than 5 %: ACLineSegment _s.")


def test_a_file_without_segments_is_refused() -> None:
    with pytest.raises(BadInput, match="no ACLineSegment"):
        lines(file(an_object("Substation", "_a")))
