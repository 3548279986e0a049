from typing import get_args

import pytest

from app.pages.lines.row_lists import row_lists
from app.pages.measures import FEET, SI
from app.pages.wording import words
from app.schemas.devices import Device


def test_every_kind_of_device_of_the_schemas_has_a_row() -> None:
    classes = get_args(get_args(Device)[0])
    kinds = {get_args(model.model_fields["type"].annotation)[0] for model in classes}
    assert row_lists()["line.devices"].kinds.keys() == kinds
    assert all(hasattr(words().devices, kind) for kind in kinds)


def test_every_list_and_field_has_its_words() -> None:
    for name, row_list in row_lists().items():
        assert getattr(words().rows, name).about
        for kind in row_list.kinds.values():
            for field in kind.fields:
                assert hasattr(words().fields, field.said), (name, field.name)
                assert not field.part or hasattr(words().parts, field.part)
                assert field.row["description"]


@pytest.mark.parametrize(
    ("name", "most"),
    [("line.devices", 200), ("line.phases", 20), ("line.section.strings", 19), ("analysis.wind_speeds_m_per_s", 1000)],
)
def test_a_list_has_as_many_rows_as_the_schema_allows(name: str, most: int) -> None:
    assert row_lists()[name].most == most


def test_fields_are_those_of_the_kind_with_names_and_pointers_of_their_row() -> None:
    devices = row_lists()["line.devices"]
    fields = {field.name: field for field in devices.fields(2, "detuning_pendulum")}
    assert list(fields) == [f"line.devices.2.{name}" for name in ("position_m", "mass_kg", "arm_m", "angle_deg")]
    assert fields["line.devices.2.arm_m"].pointer == "/line/devices/2/arm_m"
    assert "From 0.001 to 10 m." in fields["line.devices.2.arm_m"].hint(SI)
    assert "Usually 0 °." in fields["line.devices.2.angle_deg"].hint(SI)
    assert devices.fields(0, "balloon") == []


def test_lists_of_fixed_length_have_a_field_for_each_item() -> None:
    names = [field.name for field in row_lists()["line.devices"].fields(0, "interphase_spacer")]
    assert names[2:4] == ["line.devices.0.between.0", "line.devices.0.between.1"]
    spoiler = {field.name: field for field in row_lists()["line.devices"].fields(0, "airflow_spoiler")}
    third = spoiler["line.devices.0.aerodynamics.vertical.2"]
    assert (third.part, third.unit(FEET).name, third.is_number) == ("aerodynamics", "1/rad³", True)
    assert not any("table" in name or "static_angle" in name for name in spoiler)


def test_a_list_that_only_a_later_form_of_its_part_has_has_rows() -> None:
    table = row_lists()["line.ice.aerodynamics.table"]
    assert [field.name for field in table.columns] == ["angle_deg", "lift", "drag", "moment"]
    assert [field.unit(FEET).name for field in table.columns] == ["°", "", "", ""]
    assert (table.most, table.most_rows) == (10_000, 1000)


def test_columns_of_a_sheet_are_the_fields_of_the_row_itself() -> None:
    assert row_lists()["line.devices"].columns == []
    names = [field.name for field in row_lists()["line.phases"].columns]
    assert names == ["name", "y_m", "z_m", "required_clearance_m"]


def test_what_has_no_field_makes_room_for_json_and_a_required_part_is_known() -> None:
    kinds = row_lists()["line.devices"].kinds
    assert kinds["airflow_spoiler"].has_more
    assert kinds["airflow_spoiler"].required == {"aerodynamics"}
    assert not kinds["spacer"].has_more
    assert not any(field.name.startswith("line.") for field in row_lists()["line.phases"].kinds[""].fields)
