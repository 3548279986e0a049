"""Rows of assumptions and the values that they settle."""

import math

import pytest

from engine.known.estimate import Estimate
from engine.known.provenance import Assumption, Origin, Provenance, assumed, computed, from_catalogue, given
from engine.outcome import InvalidSpec

DENSITY = Estimate(900.0, "kg/m3", 800.0, 917.0, "glaze")


def test_each_origin_has_its_row() -> None:
    rows = [
        given("span.length", 300.0, "m"),
        from_catalogue("conductor.mass", 1.6, "kg/m", "a table"),
        computed("ice.eccentricity_y", 0.002, "m", "section"),
        assumed("ice.density", DENSITY, {}),
    ]
    assert [row.origin for row in rows] == ["given", "catalogue", "computed", "assumed"]
    assert [(row.lowest, row.highest) for row in rows] == [(None, None)] * 3 + [(800.0, 917.0)]
    assert (rows[3].value, rows[3].unit, rows[3].source) == (900.0, "kg/m3", "glaze")


def test_a_chosen_value_replaces_the_estimate_within_its_range() -> None:
    chosen = assumed("ice.density", DENSITY, {"ice.density": 850.0, "other": 3.0})
    assert (chosen.value, chosen.lowest, chosen.highest) == (850.0, 800.0, 917.0)
    with pytest.raises(InvalidSpec, match=r"ice\.density must lie between 800 and 917 kg/m3, got 950\.0"):
        assumed("ice.density", DENSITY, {"ice.density": 950.0})


@pytest.mark.parametrize(
    ("row", "fault"),
    [
        (("a", math.nan, "", Origin.GIVEN, ""), "a must be a finite number"),
        (("a", 1.0, "", Origin.ASSUMED, ""), "a must have a range if and only if it is assumed"),
        (("a", 1.0, "", Origin.GIVEN, "", 0.0, 2.0), "a must have a range if and only if it is assumed"),
    ],
)
def test_a_broken_rule_is_named(row: tuple[str, float, str, Origin, str], fault: str) -> None:
    with pytest.raises(InvalidSpec, match=fault):
        Assumption(*row)


def test_values_are_found_by_path() -> None:
    values = Provenance().extended([given("a", 1.0, "m")]).extended([given("b", 2.0, "m")])
    assert values["b"] == 2.0
    assert "a" in values
    assert "c" not in values
    with pytest.raises(KeyError, match="c"):
        values["c"]
