import math
from typing import Any

import pytest

from app.pages.charts.curves import curves, pieces
from app.pages.findings import Findings
from app.pages.measures import FEET, SI


def curve(winds: list[float], stability: str = "stable", number: int = 0) -> list[dict[str, Any]]:
    where = {"model": "hybrid", "loops": 1, "branch": 0, "curve": number}
    return [{**where, "point": i, "wind_speed_m_per_s": wind, "stability": stability} for i, wind in enumerate(winds)]


def winds(rows: list[dict[str, Any]]) -> list[list[float]]:
    return [[row["wind_speed_m_per_s"] for row in piece] for piece in pieces(rows)]


def test_a_curve_is_cut_at_its_folds_and_the_pieces_share_a_point() -> None:
    assert winds(curve([2.0, 4.0, 6.0, 5.0, 3.0, 4.0])) == [[2.0, 4.0, 6.0], [6.0, 5.0, 3.0], [3.0, 4.0]]


def test_a_curve_is_cut_where_its_stability_changes_and_at_the_next_curve() -> None:
    rows = curve([2.0, 4.0]) + curve([5.0, 6.0], "unstable")
    assert winds(rows) == [[2.0, 4.0], [4.0, 5.0, 6.0]]
    assert winds(curve([2.0, 4.0]) + curve([1.0, 0.5], number=1)) == [[2.0, 4.0], [1.0, 0.5]]
    assert winds([]) == []


def test_the_chart_shows_the_rows_of_the_result(found: Findings) -> None:
    drawn = curves(found, SI)
    rows = found.rows("amplitude_curves")
    largest = max(row["vertical_m"] for row in rows)
    assert max(max(piece["vertical"]) for piece in drawn["pieces"]) == pytest.approx(largest)
    turned = max(abs(row["torsional_rad"]) for row in rows)
    assert max(max(piece["torsional"]) for piece in drawn["pieces"]) == pytest.approx(math.degrees(turned))
    assert drawn["onset"] == pytest.approx(found.verdict["onset_m_per_s"] if found.verdict else 0.0)
    births = [mark for mark in drawn["marks"] if mark["type"] == "hopf"]
    assert births
    assert all(mark["vertical"] == 0.0 for mark in births)
    assert drawn["spread"]["wind"] == [4.0, 8.0]
    assert drawn["quantities"][0]["label"] == "Vertical amplitude, half of peak to peak"


def test_the_chart_is_drawn_in_feet_where_the_reader_wants_them(found: Findings) -> None:
    metres, feet = curves(found, SI), curves(found, FEET)
    assert feet["quantities"][0]["unit"] == "ft"
    assert feet["wind_unit"] == "mph"
    for one, other in zip(metres["pieces"], feet["pieces"], strict=True):
        assert other["vertical"] == pytest.approx([value / 0.3048 for value in one["vertical"]])
        assert other["wind"] == pytest.approx([value / 0.44704 for value in one["wind"]])


def test_a_torus_is_drawn_between_its_amplitudes() -> None:
    cycle = {"model": "hybrid", "loops": 2, "branch": 1, "stability": "stable", "kind": "quasi_periodic"}
    sizes = {"vertical_m": 0.3, "vertical_min_m": 0.1, "horizontal_m": 0.2, "horizontal_min_m": 0.2}
    twist = {"torsional_rad": 0.02, "torsional_min_rad": 0.01, "wind_speed_m_per_s": 7.0}
    found = Findings(0, [], {}, {}, {"limit_cycles": [{**cycle, **sizes, **twist}]})
    (torus,) = curves(found, SI)["tori"]
    assert torus["vertical"] == [0.1, 0.3]
    assert torus["torsional"] == pytest.approx([math.degrees(0.01), math.degrees(0.02)])
    assert torus["name"] == "hybrid, 2 loops, stable, quasi-periodic"
