import pytest

from app.pages.drawings.scales import fitting, scale_bar, ticks


@pytest.mark.parametrize(
    ("low", "high", "most", "expected"),
    [
        (0.0, 300.0, 7, [0.0, 50.0, 100.0, 150.0, 200.0, 250.0, 300.0]),
        (-0.3, 1.1, 8, [-0.2, 0.0, 0.2, 0.4, 0.6, 0.8, 1.0]),
        (0.0, 413.0, 7, [0.0, 100.0, 200.0, 300.0, 400.0]),
    ],
)
def test_ticks_are_round_and_few(low: float, high: float, most: int, expected: list[float]) -> None:
    assert ticks(low, high, most) == pytest.approx(expected)


def test_all_points_fit_with_their_margin() -> None:
    scale = fitting([(0.0, 0.0), (4.0, 1.0)], (100.0, 100.0), 10.0)
    assert scale.per_metre == pytest.approx(20.0)
    assert scale.place((0.0, 0.0)) == pytest.approx((10.0, 60.0))
    assert fitting([(1.0, 1.0)], (100.0, 100.0), 10.0, least=2.0).per_metre == pytest.approx(40.0)


def test_a_bar_of_a_round_length_shows_the_scale() -> None:
    scale = fitting([(0.0, 0.0), (10.0, 0.0)], (420.0, 260.0), 10.0)
    bar, text = scale_bar(scale, "ft", 1 / 0.3048)
    assert ">10 ft</text>" in text
    assert f"h{10.0 * 0.3048 * 40.0:.2f}" in bar
