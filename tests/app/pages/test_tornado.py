from typing import Any

import pytest

from app.pages import tornado
from app.pages.findings import Findings
from app.pages.measures import SI


def row(path: str, low: float | None, high: float | None, share: float) -> dict[str, Any]:
    onset = {"onset_at_lowest_m_per_s": 1.0, "onset_at_highest_m_per_s": None, "onset_total": 0.5 * share}
    amplitude = {"vertical_at_lowest_m": low, "vertical_at_highest_m": high, "amplitude_total": share}
    return {"path": path, "lowest": 0.1, "highest": 0.2, **onset, **amplitude}


def test_bars_lie_between_the_amplitudes_of_the_ends() -> None:
    made = tornado.bars([row("a", 0.4, 0.2, 0.1), row("b", 0.2, 1.2, 0.8), row("c", None, 0.2, 0.5)], SI, {"a": "N m2"})
    assert made is not None
    first, last, bars = made
    assert (first, last) == ("0.200 m", "1.20 m")
    assert [(bar.path, bar.falls) for bar in bars] == [("b", False), ("a", True)]
    assert [bar.start for bar in bars] == pytest.approx([0.0, 0.0])
    assert [bar.length for bar in bars] == pytest.approx([100.0, 20.0])
    assert [(bar.low, bar.high) for bar in bars] == [("0.100", "0.200"), ("0.100", "0.200 N·m²")]
    assert bars[0].onset == ("1.00", "\N{EN DASH}")
    assert (bars[0].share, bars[0].onset_share) == (0.8, 0.4)


def test_there_are_no_bars_without_samples_or_where_nothing_decides() -> None:
    assert tornado.bars([], SI, {}) is None
    assert tornado.bars([row("a", 0.4, 0.4, 0.0)], SI, {}) is None


def test_the_bars_of_a_result_are_those_of_its_sensitivities(found: Findings) -> None:
    made = tornado.bars(found.rows("sensitivities"), SI, {})
    assert made is not None
    assert {bar.path for bar in made[2]} <= {row["path"] for row in found.rows("sensitivities")}
    assert all(0.0 <= bar.start <= bar.start + bar.length <= 100.0 + 1e-9 for bar in made[2])
