from app.pages.lines.line_fields import CLOSED, GROUPS, controls, form_fields, list_names
from app.pages.measures import FEET, SI
from app.pages.wording import words


def test_every_field_has_its_words_and_its_row_in_the_schemas() -> None:
    for name, field in form_fields().items():
        assert hasattr(words().fields, field.said), name
        assert field.row["description"]
    assert all(hasattr(words().groups, name) for name in GROUPS)
    assert GROUPS.keys() >= CLOSED
    assert "line.devices" in list_names()
    assert form_fields().keys().isdisjoint(list_names())


def test_a_list_of_fixed_length_has_a_field_for_each_item_and_any_other_has_rows() -> None:
    found = controls("coefficients")
    assert [name for name in found if ".torsional." in name] == [
        f"line.ice.aerodynamics.torsional.{number}" for number in range(3)
    ]
    assert found[-1] == "line.ice.aerodynamics.table"
    third = form_fields()["line.ice.aerodynamics.torsional.2"]
    assert (third.unit(SI).name, third.label) == ("1/rad³", "Torsional, third order")


def test_bounds_and_defaults_are_those_of_the_schema_in_the_units_of_the_form() -> None:
    length = form_fields()["line.span.length_m"]
    assert "From 1 to 5000 m." in length.hint(SI)
    assert "From 3.28084 to 16404.2 ft." in length.hint(FEET)
    assert "Usually 0 m." in form_fields()["line.span.level_difference_m"].hint(SI)
    hint = form_fields()["line.span.everyday.temperature_c"].hint(FEET)
    assert hint == "Temperature; if empty, 15 °C is assumed. From -76 to 140 °F."
    assert (length.key, length.pointer) == ("line-span-length_m", "/line/span/length_m")


def test_what_is_small_is_entered_in_millimetres_or_inches() -> None:
    thickness = form_fields()["line.ice.accretion.thickness_m"]
    assert (thickness.entered(0.012, SI), thickness.unit(SI).name) == ("12", "mm")
    assert (thickness.entered(0.0254, FEET), thickness.unit(FEET).name) == ("1", "in")
    assert form_fields()["line.conductor.diameter_m"].unit(SI).name == "mm"
    assert form_fields()["line.span.everyday.sag_m"].unit(SI).name == "m"
    assert form_fields()["line.conductor.axial_rigidity_n"].entered(28418105.8, SI) == "28418105.8"
    assert form_fields()["line.span.temperature_c"].entered(-5.0, FEET) == "23"
