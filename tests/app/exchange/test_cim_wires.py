from typing import Any

from app.exchange.cim import read_segments
from app.schemas.faults import BadInput
from app.sheets.columns import PlacedLine
from tests.app.exchange.cim_files import an_object, file, pieces

PHASE = "http://iec.ch/TC57/CIM100#SinglePhaseKind."


def line(*objects: str, defaults: Any = None, **attributes: str) -> PlacedLine:
    segment = an_object("ACLineSegment", "_s", **attributes)
    (found,) = read_segments(pieces(file(segment, *objects)), defaults, 100_000, 100_000).lines
    return found


def document(*objects: str, defaults: Any = None, **attributes: str) -> dict[str, Any]:
    found = line(*objects, defaults=defaults, **attributes).document
    assert isinstance(found, dict)
    return {name: value for name, value in found.items() if name != "reference"}


def wire(name: str, identity: str = "_w", **attributes: str) -> str:
    return an_object("OverheadWireInfo", identity, IdentifiedObject__name=name, **attributes)


def phase(letter: str, sheet: str) -> str:
    return an_object(
        "ACLineSegmentPhase",
        f"_{letter}",
        ACLineSegmentPhase__ACLineSegment="#_s",
        ACLineSegmentPhase__phase=f"{PHASE}{letter}",
        PowerSystemResource__AssetDatasheet=sheet,
    )


def test_a_wire_is_found_by_sheet_phase_and_asset() -> None:
    asset = an_object("Asset", "_a", Asset__PowerSystemResources="#_s", Asset__AssetInfo="#_w")
    assert document(wire("Drake"), PowerSystemResource__AssetDatasheet="#_w") == {"conductor": {"catalogue": "Drake"}}
    assert document(wire("Drake"), phase("A", "#_w"), phase("B", "#_w")) == {"conductor": {"catalogue": "Drake"}}
    assert document(wire("Drake"), asset) == {"asset_id": "_a", "conductor": {"catalogue": "Drake"}}
    assert document(wire("no one's")) == {}


def test_the_name_that_the_catalogue_knows_is_taken() -> None:
    sized = wire("our wire 12", WireInfo__sizeDescription="Drake", WireInfo__radius="0.014")
    assert document(sized, phase("A", "#_w"))["conductor"] == {"catalogue": "Drake", "diameter_m": 0.028}
    own = wire("our wire 12", WireInfo__radius="0.014")
    assert document(own, phase("A", "#_w"))["conductor"] == {"catalogue": "our wire 12", "diameter_m": 0.028}
    said = {"conductor": {"bare_mass_kg_per_m": 1.6}}
    assert document(own, phase("A", "#_w"), defaults=said)["conductor"] == {"diameter_m": 0.028}


def test_phases_of_different_wires_are_no_line_but_a_neutral_may_differ() -> None:
    two = wire("Drake", "_w"), wire("Hawk", "_x")
    assert document(*two, phase("A", "#_w"), phase("N", "#_x")) == {"conductor": {"catalogue": "Drake"}}
    found = line(*two, phase("A", "#_w"), phase("B", "#_x"))
    assert [fault.code for fault in found.faults] == ["several_wires"]
    assert "Drake and Hawk" in found.faults[0].detail


def test_cables_are_refused() -> None:
    cable = an_object("ConcentricNeutralCableInfo", "_w", IdentifiedObject__name="XLPE")
    spacing = an_object("WireSpacingInfo", "_w", WireSpacingInfo__isCable="true")
    for sheet in (cable, spacing):
        found = line(sheet, PowerSystemResource__AssetDatasheet="#_w").document
        assert isinstance(found, BadInput) and found.faults[0].code == "cable"


def test_bundles_and_their_faults() -> None:
    def spaced(**attributes: str) -> PlacedLine:
        return line(an_object("WireSpacing", "_d", **attributes), ACLineSegment__WireSpacingInfo="#_d")

    four = spaced(WireSpacing__phaseWireCount="4", WireSpacing__phaseWireSpacing="0.4")
    assert four.document == {"reference": "_s", "bundle": {"subconductors": 4, "spacing_m": 0.4}}
    single = spaced(WireSpacing__phaseWireCount="1", WireSpacing__phaseWireSpacing="0")
    assert single.document == {"reference": "_s", "bundle": {"subconductors": 1}}
    for text in ("2.5", "nan", "two"):
        assert [fault.pointer for fault in spaced(WireSpacing__phaseWireCount=text).faults] == ["/bundle/subconductors"]
    assert spaced(WireSpacing__phaseWireSpacing="0.4").document == {"reference": "_s"}


def test_positions_without_phase_have_that_of_their_number() -> None:
    def hung(number: int, x: str, y: str) -> str:
        return an_object(
            "WirePosition",
            f"_p{number}",
            WirePosition__WireSpacingInfo="#_d",
            WirePosition__sequenceNumber=str(number),
            WirePosition__xCoord=x,
            WirePosition__yCoord=y,
        )

    spacing = an_object("WireSpacingInfo", "_d")
    numbered = an_object(
        "ACLineSegmentPhase",
        "_a",
        ACLineSegmentPhase__ACLineSegment="#_s",
        ACLineSegmentPhase__phase="C",
        ACLineSegmentPhase__sequenceNumber="1",
    )
    flat = hung(1, "-8", "20"), hung(2, "0", "20"), hung(3, "8", "20")
    found = document(spacing, numbered, *flat, ACLineSegment__WireSpacingInfo="#_d")
    assert found["phases"] == [{"name": "C", "y_m": 0.0, "z_m": -8.0}, {"name": "wire 3", "y_m": 0.0, "z_m": 8.0}]
    assert "phases" not in document(spacing, flat[0], ACLineSegment__WireSpacingInfo="#_d")
    wrong = line(spacing, *flat[:2], hung(3, "wide", "20"), ACLineSegment__WireSpacingInfo="#_d")
    assert [fault.pointer for fault in wrong.faults] == ["/phases"]
