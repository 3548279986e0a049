import math

import pytest

from app.convert import resolve_document
from app.pages import examples
from app.pages.drawings.iced_bundles import ice_outline, iced_bundle
from app.pages.drawings.svg import Point
from app.pages.measures import FEET, SI

RADIUS, THICKNESS = 0.014, 0.012


def area(points: list[Point]) -> float:
    following = points[1:] + points[:1]
    return 0.5 * abs(sum(a * d - b * c for (a, b), (c, d) in zip(points, following, strict=True)))


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        ("uniform", math.pi * (RADIUS + THICKNESS) ** 2),
        ("crescent", math.pi * (RADIUS + 0.5 * THICKNESS) ** 2),
        ("d_shape", 0.5 * math.pi * ((RADIUS + THICKNESS) ** 2 + RADIUS**2)),
    ],
)
def test_outlines_enclose_the_areas_of_their_shapes(shape: str, expected: float) -> None:
    outline = ice_outline({"shape": shape, "angle_deg": 270.0}, RADIUS, THICKNESS)
    assert area(outline) == pytest.approx(expected, rel=5e-3)


def test_the_thickest_point_lies_in_the_direction_of_the_angle() -> None:
    for angle, direction in ((270.0, (-1.0, 0.0)), (0.0, (0.0, 1.0)), (90.0, (1.0, 0.0))):
        outline = ice_outline({"shape": "crescent", "angle_deg": angle}, RADIUS, THICKNESS)
        furthest = max(outline, key=lambda point: math.hypot(*point))
        assert furthest == pytest.approx((26e-3 * direction[0], 26e-3 * direction[1]), abs=1e-9)
        assert min(math.hypot(*point) for point in outline) == pytest.approx(RADIUS)


def test_a_profile_is_turned_clockwise_and_no_ice_has_no_outline() -> None:
    turned = ice_outline({"shape": "profile", "angle_deg": 90.0, "points_m": [[0.02, 0.0]]}, RADIUS, 0.0)
    assert turned[0] == pytest.approx((0.02, 0.0), abs=1e-12)
    assert ice_outline(None, RADIUS, THICKNESS) == []


def test_a_bundle_is_drawn_with_a_bar_of_its_scale() -> None:
    explicit = resolve_document(examples.line(examples.DRAKE))["line"]
    drawn = str(iced_bundle(explicit, {"shape": "crescent"}, THICKNESS, SI))
    assert drawn.count('class="wire"') == drawn.count('class="ice"') == drawn.count('class="mass"') == 2
    assert "100 mm" in drawn
    assert " in</text>" in str(iced_bundle(explicit, None, 0.0, FEET))
