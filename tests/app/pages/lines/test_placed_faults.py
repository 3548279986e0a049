from app.pages.lines.placed_faults import of_typed, placed
from app.schemas.faults import Fault

TEXTS = {
    "line.devices.0.type": "airflow_spoiler",
    "line.devices.0.from_m": "1",
    "line.devices.1.type": "spacer",
    "line.phases.0.name": "top",
    "analysis.wind_speeds_m_per_s.0": "",
}


def beside(pointer: str) -> tuple[str, str, list[str]]:
    found = placed([Fault(pointer, "code", "is wrong")], TEXTS)
    assert found.others == []
    (place, sentences), *others = found.listed
    assert others == []
    return place.name, place.label, list(sentences)


def test_faults_stand_beside_the_field_of_their_row() -> None:
    assert beside("/line/devices/1/mass_kg") == ("line.devices.1.mass_kg", "Device 2: Mass", ["is wrong"])
    name = "analysis.wind_speeds_m_per_s.0"
    assert beside("/analysis/wind_speeds_m_per_s/0") == (name, "Wind speed 1", ["is wrong"])


def test_faults_of_what_has_no_field_stand_at_the_row_or_list_that_holds_it() -> None:
    assert beside("/line/devices/0/aerodynamics") == ("line.devices.0", "Device 1", ["aerodynamics: is wrong"])
    deep = "/line/phases/0/line/span/length_m"
    assert beside(deep) == ("line.phases.0", "Phase 1", ["line.span.length_m: is wrong"])
    assert beside("/line/devices") == ("line.devices", "Devices", ["is wrong"])
    assert beside("/line/devices/7/mass_kg")[2] == ["7.mass_kg: is wrong"]
    assert beside("/line/phases/0/rest")[1] == "Phase 1: More, as JSON"


def test_faults_of_a_list_of_fixed_length_stand_beside_its_first_item() -> None:
    assert beside("/line/ice/aerodynamics/vertical")[:2] == (
        "line.ice.aerodynamics.vertical.0",
        "Vertical, first order",
    )
    of_row = beside("/line/devices/0/aerodynamics/torsional")
    assert of_row[:2] == ("line.devices.0.aerodynamics.torsional.0", "Device 1: Torsional, first order")


def test_other_faults_have_no_place() -> None:
    faults = [Fault("/line/colour", "unknown_field", "unknown field"), Fault("", "x", "y")]
    assert placed(faults, TEXTS).others == faults


def test_rows_into_which_nothing_was_typed_are_not_complained_about() -> None:
    faults = [
        Fault(pointer, "missing", "field required") for pointer in ("/line/devices/0/to_m", "/line/devices/1/mass_kg")
    ]
    empty = Fault("/analysis/wind_speeds_m_per_s/0", "float_type", "must be a number")
    assert of_typed([*faults, empty], TEXTS) == faults[:1]
