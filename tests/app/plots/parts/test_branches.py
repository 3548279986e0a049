import pytest

from app.plots.parts.branches import Stretch, marks, stretches
from tests.app.plots.drawn_motions import FOLDED, motions

HYBRID = ("hybrid", 1, 0)


def winds(stretch: Stretch) -> list[float]:
    return [row["wind_speed_m_per_s"] for row in stretch.points]


def test_a_curve_is_divided_where_stability_changes() -> None:
    first, second = stretches({"amplitude_curves": FOLDED})
    assert (first.stability, winds(first), first.whole) == ("stable", [2.4, 4.0, 8.0, 6.0], True)
    assert (second.stability, winds(second)) == ("unstable", [6.0, 5.0])


def test_without_curves_the_winds_asked_for_are_joined_from_the_hopf_point() -> None:
    found = {stretch.key: stretch for stretch in stretches(motions(loops=(1,)))}
    assert winds(found[HYBRID]) == [2.4, 4.0, 5.0, 6.0]
    assert not found[HYBRID].whole
    assert ("hybrid", 1, 1) not in found  # its motions have no numbers


def test_several_motions_at_one_wind_are_not_joined() -> None:
    rows = motions(loops=(1,))
    twice = {**rows, "limit_cycles": [*rows["limit_cycles"], *rows["limit_cycles"]]}
    assert list(stretches(twice)) == []


@pytest.mark.parametrize(
    ("kind", "wind", "expected"), [("hopf", 2.4, 0.0), ("fold", 8.0, 0.3), ("torus", 5.0, 0.6), ("torus", 9.0, None)]
)
def test_bifurcations_have_their_place_on_the_branch(kind: str, wind: float, expected: float | None) -> None:
    row = {"model": "hybrid", "loops": 1, "branch": 0, "type": kind, "wind_speed_m_per_s": wind}
    (mark,) = marks({"amplitude_curves": FOLDED, "bifurcations": [row]})
    assert (mark.point and mark.point["vertical_m"]) == (expected if expected is None else pytest.approx(expected))
