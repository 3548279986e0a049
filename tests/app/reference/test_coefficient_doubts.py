import math
from collections.abc import Sequence

import pytest

from app.reference.coefficient_doubts import Row, cubic_doubts, ice_direction, table_doubts
from app.reference.source_lines import COEFFICIENTS

SOUND: list[Row] = [
    (float(a), 0.8 * math.sin(math.radians(2 * a)), 1.2 - 0.3 * math.cos(math.radians(2 * a)), 0.0)
    for a in range(0, 360, 10)
]


@pytest.mark.parametrize("angle", COEFFICIENTS)
def test_slopes_per_degree_are_told_and_those_per_radian_are_not(angle: int) -> None:
    cubics = COEFFICIENTS[angle]
    assert cubic_doubts(cubics) == []
    per_degree = {name: [a * math.radians(1.0) ** (j + 1) for j, a in enumerate(row)] for name, row in cubics.items()}
    (sentence,) = cubic_doubts(per_degree)
    assert "per degree" in sentence
    assert f"vertical {cubics['vertical'][0]:.3g}" in sentence


@pytest.mark.parametrize("row", [(0.0, 0.0, 0.0), (0.05, 0.0, 0.0), (-0.01, 4.0, 8.0)])
def test_small_or_straight_cubics_are_not_doubted(row: Sequence[float]) -> None:
    assert cubic_doubts({"vertical": row}) == []


def test_a_sound_table_is_not_doubted() -> None:
    assert table_doubts(SOUND) == []


def test_angles_in_radians_are_told() -> None:
    (sentence,) = table_doubts([(math.radians(a), lift, drag, m) for a, lift, drag, m in SOUND])
    assert "look like radians" in sentence
    assert "350" in sentence


@pytest.mark.parametrize("rows", [SOUND, SOUND[:9]])
def test_lift_and_drag_in_each_others_place_are_told(rows: list[Row]) -> None:
    (sentence,) = table_doubts([(a, drag, lift, m) for a, lift, drag, m in rows])
    assert "lift and drag look swapped" in sentence


def test_negative_drag_is_told() -> None:
    assert table_doubts([(a, lift, -drag, m) for a, lift, drag, m in SOUND]) == [
        "drag is negative at 36 of 36 angles; drag is positive downwind"
    ]


@pytest.mark.parametrize("direction", [0.0, 75.0, 270.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_moments_tell_where_the_ice_points_or_the_opposite_if_their_sign_is_anothers(
    direction: float, sign: float
) -> None:
    def moment(angle: float, lift: float, drag: float) -> float:
        """Return the moment of forces at the place (y, z) of the ice: y F_z - z F_y, from (3)."""
        phi = math.radians(angle + direction)
        return 0.2 * (math.cos(phi) * drag - math.sin(phi) * lift)

    found = ice_direction([(a, lift, drag, sign * moment(a, lift, drag)) for a, lift, drag, _ in SOUND])
    assert found == pytest.approx((direction + (0.0 if sign > 0.0 else 180.0)) % 360.0, abs=1e-8)


def test_moments_of_no_centre_of_pressure_tell_nothing() -> None:
    assert ice_direction(SOUND) is None
    assert ice_direction([(a, lift, drag, (-1.0) ** i) for i, (a, lift, drag, _) in enumerate(SOUND)]) is None
