import re
from typing import Any

import pytest

from app.pages.drawings.neighbours import neighbours
from app.pages.measures import FEET, SI

LINE: dict[str, Any] = {
    "span": {"length_m": 300.0},
    "supports": {"left": {"adjacent_span_m": 200.0, "insulator_length_m": 2.4}, "right": {"adjacent_span_m": 100.0}},
}
SECTION: dict[str, Any] = {
    "span": {"length_m": 300.0},
    "section": {
        "spans": [{"length_m": 200.0}, {"length_m": 300.0, "level_difference_m": 5.0}, {"length_m": 100.0}],
        "span_of_interest": 2,
        "strings": [{"length_m": 1.2}, {"length_m": 1.2}],
    },
}


def curve(text: str, kind: str) -> list[tuple[float, float]]:
    found = re.search(rf'<path d="M([^"]*)" class="{kind}"', text)
    assert found is not None
    return [(float(x), float(y)) for x, y in (point.split() for point in found[1].split("L"))]


@pytest.mark.parametrize("line", [LINE, SECTION])
def test_spans_lie_side_by_side_to_one_scale(line: dict[str, Any]) -> None:
    text = str(neighbours(line, 1500.0, SI))
    own = curve(text, "moving-side")
    assert (own[0][0] - 12.0) / 200.0 == pytest.approx((own[-1][0] - own[0][0]) / 300.0, rel=1e-3)
    assert own[-1][0] + 100.0 * 536.0 / 600.0 == pytest.approx(548.0, abs=0.01)
    assert ">200 m</text>" in text
    assert ">328 ft</text>" in str(neighbours(line, 1500.0, FEET))


def test_sags_are_those_of_one_tension_and_levels_add_up() -> None:
    text = str(neighbours(SECTION, 1500.0, SI))
    factor = float(re.search(r"heights drawn ([\d.]+) times", text)[1])  # type: ignore[index]
    per_metre = factor * 536.0 / 600.0
    own, other = curve(text, "moving-side"), curve(text, "neighbour")
    assert (own[0][1] - own[-1][1]) / per_metre == pytest.approx(5.0, rel=0.05)
    sags = [points[len(points) // 2][1] - 0.5 * (points[0][1] + points[-1][1]) for points in (own, other)]
    assert sags[0] / sags[1] == pytest.approx((300.0 / 200.0) ** 2, rel=0.01)
    assert sags[0] / per_metre == pytest.approx(300.0**2 / (8.0 * 1500.0), rel=0.05)


def test_spans_of_a_section_move_and_others_are_at_rest_and_strings_hang_where_they_are() -> None:
    at_rest, moving = (str(neighbours(line, 1500.0, SI)) for line in (LINE, SECTION))
    assert (at_rest.count('class="still"'), at_rest.count('class="neighbour"')) == (2, 0)
    assert (moving.count('class="still"'), moving.count('class="neighbour"')) == (0, 2)
    assert (at_rest.count('class="string"'), moving.count('class="string"')) == (1, 2)


def test_a_span_between_dead_ends_or_beside_unknown_ones_has_no_neighbours() -> None:
    alone = {"span": {"length_m": 300.0}, "supports": {"left": {"dead_end": True}, "right": {"dead_end": True}}}
    assert neighbours(alone, 1500.0, SI) is None
    assert neighbours({"span": {"length_m": 300.0}, "supports": {"left": {}, "right": {}}}, 1500.0, SI) is None


def test_many_spans_are_numbered_where_there_is_no_room() -> None:
    spans = [{"length_m": 300.0}] * 20
    line = {"span": {"length_m": 300.0}, "section": {"spans": spans, "strings": [{"length_m": 2.0}] * 19}}
    text = str(neighbours(line, 1500.0, SI))
    assert ">20</text>" in text
    assert "300 m" not in text
