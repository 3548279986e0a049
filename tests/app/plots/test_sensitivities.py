from typing import Any

import pytest

from app import convert
from app.plots import Options
from app.plots.sensitivities import picture
from tests.app.plots.drawn_motions import FACTS
from tests.app.plots.seen import figure_of

ROW = convert.example_tables()["sensitivities"][0]


def row(path: str, onsets: tuple[float | None, float | None], share: float | None = 0.5) -> dict[str, Any]:
    ends = {"onset_at_lowest_m_per_s": onsets[0], "onset_at_highest_m_per_s": onsets[1], "onset_total": share}
    return {**ROW, "path": path, **ends, "vertical_at_lowest_m": 1.0, "vertical_at_highest_m": 1.0}


def test_the_longest_bar_is_on_top_with_both_ends_and_its_share() -> None:
    rows = [row("a.b_m", (2.0, 3.0)), row("damping.vertical_ratio", (6.0, 2.0), 0.84), row("c", (2.0, None))]
    onset, amplitude = figure_of(picture({"sensitivities": rows}, FACTS, Options())).axes
    assert [label.get_text() for label in onset.get_yticklabels()] == ["damping: vertical ratio", "a: b"]
    bar = onset.patches[0]
    assert bar.get_x() + bar.get_width() == pytest.approx(2.0)
    low, high = onset.get_lines()[:2]
    assert (low.get_xydata().tolist(), high.get_xydata().tolist()) == ([[6.0, 0.0]], [[2.0, 0.0]])
    assert onset.texts[0].get_text() == "84 %"
    assert "no sample tells" in amplitude.texts[0].get_text()


def test_what_is_not_drawn_is_told() -> None:
    rows = [row(f"part.value_{number}", (1.0, 1.1 + number)) for number in range(12)]
    figure = figure_of(picture({"sensitivities": [*rows, row("c", (2.0, None))]}, FACTS, Options()))
    told = next(text.get_text() for text in figure.texts if "least" in text.get_text())
    assert "the 2 values that change least are not shown" in told
    assert len(figure.axes[0].patches) == 10


def test_without_samples_it_says_why_there_is_nothing() -> None:
    panels = figure_of(picture({"sensitivities": []}, FACTS, Options())).axes
    assert all("nothing is assumed" in panel.texts[0].get_text() for panel in panels)
