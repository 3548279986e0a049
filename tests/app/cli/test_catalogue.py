import json

from app.reference import conductors
from app.schemas.field_table import all_fields
from tests.app.command_line import galloping, on_a_terminal, run


def test_conductors_are_printed_with_their_sources() -> None:
    ended = galloping("conductors", "--search", "drake")
    assert ended.returncode == 0
    (row,) = json.loads(ended.stdout)["conductors"]
    assert (row["name"], row["stranding"], row["licence"]) == (
        "Drake",
        "26/7",
        "Unlicense (public domain); pandapower: BSD-3-Clause",
    )
    assert len(json.loads(galloping("conductors", "--json").stdout)["conductors"]) == len(conductors.shipped())


def test_ice_shapes_are_printed_with_coefficients_and_caveats() -> None:
    shapes = json.loads(galloping("ice-shapes").stdout)["ice_shapes"]
    assert [shape["name"] for shape in shapes] == ["c11-40", "c11-270"]
    assert shapes[0]["aerodynamics"]["vertical"] == [-0.1667, -4.0547, 8.3581]
    assert len(shapes[0]["caveats"]) >= 3


def test_fields_are_found_by_words_of_name_or_description() -> None:
    assert json.loads(run("fields").stdout)["fields"] == json.loads(json.dumps(all_fields()))
    found = json.loads(run("fields", "--search", "everyday TEMPERATURE").stdout)["fields"]
    assert [row["name"] for row in found] == ["line.span.everyday.temperature_c"]
    assert (found[0]["unit"], found[0]["minimum"], found[0]["maximum"]) == ("degC", -60.0, 60.0)
    shown = on_a_terminal("fields", "--search", "line.span.length")
    assert "needed" in shown and "1 to 5000" in shown
