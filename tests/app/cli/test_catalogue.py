import json

from app.reference import conductors
from tests.app.command_line import galloping


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
