import pytest

from app.exchange.defaults import checked_defaults, filled, merged
from app.schemas.faults import BadInput
from app.sheets.columns import Computed

LENGTH = Computed(("span", "length_m"), 301.5, "m", "of its coordinates")
AZIMUTH = Computed(("climate", "line_azimuth_deg"), 57.0, "deg", "of its coordinates")


def test_objects_are_merged_and_everything_else_replaced() -> None:
    under = {"span": {"length_m": 1.0, "everyday": {"sag_m": 5.0}}, "devices": [1, 2], "name": "x"}
    over = {"span": {"everyday": {"temperature_c": 15.0}}, "devices": [3]}
    assert merged(under, over) == {
        "span": {"length_m": 1.0, "everyday": {"sag_m": 5.0, "temperature_c": 15.0}},
        "devices": [3],
        "name": "x",
    }
    assert under["devices"] == [1, 2]


def test_own_fields_win_over_coordinates_and_these_over_defaults() -> None:
    defaults = {"span": {"length_m": 100.0, "sag_m": 5.0}}
    whole, taken = filled({"reference": "a"}, (LENGTH, AZIMUTH), defaults)
    assert (whole, taken) == ({"reference": "a", "span": {"length_m": 301.5, "sag_m": 5.0}}, [LENGTH])
    whole, taken = filled({"span": {"length_m": 300.0}}, (LENGTH,), defaults)
    assert (whole, taken) == ({"span": {"length_m": 300.0, "sag_m": 5.0}}, [])
    assert filled({"span": 7}, (LENGTH,), defaults) == ({"span": 7}, [])


def test_a_direction_goes_into_a_climate_only() -> None:
    for document, defaults in (({"climate": {"sectors": []}}, {}), ({}, {"climate": {"sectors": []}})):
        whole, taken = filled(document, (AZIMUTH,), defaults)
        assert (whole, taken) == ({"climate": {"sectors": [], "line_azimuth_deg": 57.0}}, [AZIMUTH])
    assert filled({"climate": {"line_azimuth_deg": 3.0}}, (AZIMUTH,), {})[1] == []


def test_defaults_have_the_fields_of_a_line() -> None:
    assert checked_defaults(None) == {}
    assert checked_defaults({"ice": {}, "design_wind_m_per_s": 10.0}) == {"ice": {}, "design_wind_m_per_s": 10.0}
    for wrong, pointer, code in (
        ([], "/defaults", "not_an_object"),
        ({"icee": {}}, "/defaults/icee", "unknown_field"),
        ({"reference": "a"}, "/defaults/reference", "not_a_default"),
    ):
        with pytest.raises(BadInput) as caught:
            checked_defaults(wrong)
        assert [(fault.pointer, fault.code) for fault in caught.value.faults] == [(pointer, code)]
