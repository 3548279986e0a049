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
