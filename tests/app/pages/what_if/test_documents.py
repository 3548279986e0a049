from app.pages import examples
from app.pages.what_if.documents import number_at, pendulum, places_along, put


def test_a_number_is_read_in_any_unit() -> None:
    line = {"span": {"length_m": {"value": 1000, "unit": "ft"}, "sag_m": 6.5}, "devices": [{"mass_kg": 12}]}
    assert number_at(line, ("span", "length_m"), "m") == 304.8
    assert number_at(line, ("span", "sag_m"), "m") == 6.5
    assert number_at(line, ("devices", 0, "mass_kg"), "kg") == 12.0
    for place in (("span", "none"), ("devices", 3, "mass_kg"), ("span",), ("ice", "accretion", "thickness_m")):
        assert number_at(line, place, "m") is None


def test_a_value_is_set_with_the_objects_that_lead_to_it() -> None:
    line = {"damping": None, "devices": [{"position_m": 1.0}]}
    put(line, ("damping", "vertical_ratio"), 0.01)
    put(line, ("devices", 0, "position_m"), 2.0)
    assert line == {"damping": {"vertical_ratio": 0.01}, "devices": [{"position_m": 2.0}]}


def test_places_along_the_span_are_those_of_devices_ice_and_wind() -> None:
    line = {
        **examples.line("c11-twin"),
        "devices": [{"type": "spacer", "position_m": 9.0}, {"type": "detuning_pendulum", "position_m": 60.0}],
        "wind": {"profile": [{"position_m": 0.0, "factor": 1.0}]},
    }
    line["ice"] = {"segments": [{"from_m": 1.0, "to_m": 2.0}]}
    found = [place for place in places_along(line) if number_at(line, place, "m") is not None]
    assert found == [
        ("devices", 0, "position_m"),
        ("devices", 1, "position_m"),
        ("ice", "segments", 0, "from_m"),
        ("ice", "segments", 0, "to_m"),
        ("wind", "profile", 0, "position_m"),
    ]
    assert pendulum(line) == 1
    assert pendulum({}) is None
