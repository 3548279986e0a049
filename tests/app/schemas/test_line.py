from typing import Any

import pytest
from pydantic import ValidationError

from app import schemas
from app.reference.source_lines import example


def test_a_line_survives_the_way_through_json() -> None:
    line = schemas.Line.model_validate(example("c11-twin"))
    assert schemas.Line.model_validate(line.model_dump(mode="json", by_alias=True)) == line


@pytest.mark.parametrize(
    ("change", "sound"),
    [
        ({"axial_rigidity_n": 1e7}, True),
        ({"area_m2": 4e-4, "youngs_modulus_pa": 5e10}, True),
        ({}, False),
        ({"area_m2": 4e-4}, False),
        ({"youngs_modulus_pa": 5e10}, False),
        ({"axial_rigidity_n": 1e7, "area_m2": 4e-4}, False),
        ({"axial_rigidity_n": 1e7, "area_m2": 4e-4, "youngs_modulus_pa": 5e10}, False),
    ],
)
def test_the_axial_rigidity_is_given_in_exactly_one_way(change: dict[str, float], sound: bool) -> None:
    conductor = {key: value for key, value in example("c11-twin")["conductor"].items() if key != "axial_rigidity_n"}
    if sound:
        assert schemas.Conductor.model_validate(conductor | change).diameter == 0.0286
    else:
        with pytest.raises(ValidationError, match="exactly one"):
            schemas.Conductor.model_validate(conductor | change)


@pytest.mark.parametrize(
    "bundle",
    [
        {},
        {"radius_m": 0.2},
        {"subconductors": 2, "radius_m": 0.2, "positions_m": [[0.0, 0.0]]},
        {"positions_m": []},
        {"positions_m": [[0.0]]},
        {"subconductors": 13, "radius_m": 0.2},
        {"subconductors": 2.0, "radius_m": 0.2},
    ],
)
def test_a_bundle_is_a_circle_or_positions(bundle: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        schemas.Bundle.model_validate(bundle)
