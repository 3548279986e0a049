import math

import pytest

from app.pages import examples
from app.pages.drawings.bundles import icon, positions


@pytest.mark.parametrize(
    ("bundle", "expected"),
    [
        ({"subconductors": 1}, [(0.0, 0.0)]),
        ({"subconductors": 2, "spacing_m": 0.457, "arrangement": "horizontal"}, [(0.2285, 0.0), (-0.2285, 0.0)]),
        ({"subconductors": 2, "radius_m": 0.2, "orientation_deg": 0.0}, [(0.0, 0.2), (0.0, -0.2)]),
        ({"positions_m": [[0.1, -0.2], [0.0, 0.3]]}, [(-0.2, 0.1), (0.3, 0.0)]),
    ],
)
def test_sub_conductors_are_where_the_line_says(bundle: dict[str, object], expected: list[tuple[float, float]]) -> None:
    assert [pytest.approx(place, abs=1e-12) for place in expected] == positions(bundle)


def test_neighbours_of_a_quad_bundle_have_its_spacing() -> None:
    places = positions({"subconductors": 4, "spacing_m": 0.4})
    assert [math.dist(places[i], places[i - 1]) for i in range(4)] == pytest.approx([0.4] * 4)


@pytest.mark.parametrize("name", examples.NAMES)
def test_an_icon_has_a_circle_for_each_conductor_and_its_ice(name: str) -> None:
    line = examples.line(name)
    assert str(icon(line)).count("<circle") == 2 * line["bundle"]["subconductors"]
