import pytest

from app.pages.drawings.spans import heights, positions_along, span_drawing
from app.pages.measures import SI

LINE = {
    "span": {"length_m": 300.0, "level_difference_m": 6.0},
    "devices": [{"type": "spacer", "position_m": 150.0}, {"type": "airflow_spoiler", "from_m": 30.0, "to_m": 60.0}],
    "ice": {"segments": [{"from_m": 0.0, "to_m": 100.0}]},
}


def test_the_sag_is_measured_from_the_chord_at_mid_span() -> None:
    found = heights(300.0, 6.3, 6.0, positions_along(300.0))
    assert (found[0], found[-1]) == pytest.approx((0.0, 6.0))
    assert 3.0 - found[len(found) // 2] == pytest.approx(6.3)


def test_a_span_is_drawn_with_devices_and_pieces_of_ice() -> None:
    drawn = span_drawing(LINE, 6.3, 0.0, SI)
    text = str(drawn.picture)
    assert text.count('class="device"') == 1
    assert [name for _, name in drawn.legend] == ["Spacer: 1", "Airflow spoiler: 1", "Stretch with ice of its own: 1"]
    assert 'class="device stretch"' in text
    assert 'class="ice-piece"' in text
    assert "moving-plan" not in text
    assert drawn.exaggeration > 1.0
    assert f"{drawn.exaggeration:.2g} times" in text


def test_a_motion_has_room_and_a_view_from_above() -> None:
    drawn = span_drawing(LINE, 6.3, 2.0, SI)
    assert "moving-plan" in str(drawn.picture)
    assert min(drawn.rest) - 2.0 * drawn.per_metre == pytest.approx(26.0)
