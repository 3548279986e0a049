from typing import Any

import pytest

from app import convert
from app.plots import Options
from app.plots.remedies import picture
from tests.app.plots.drawn_motions import FACTS
from tests.app.plots.seen import figure_of

ROW: dict[str, Any] = convert.example_tables()["remedies"][0]
NO_SAMPLES = {"onset_p50_m_per_s": None, "vertical_p50_m": None, "vertical_p95_m": None, "samples": 0} | dict.fromkeys(
    ("improves", "improves_lowest", "improves_highest")
)
AS_IT_IS = {
    **ROW,
    "remedy": None,
    "what": "The line as it is",
    "change": None,
    "rank": None,
    "onset_m_per_s": 1.8,
    "improves": None,
}


def remedy(number: int, what: str, **changes: Any) -> dict[str, Any]:
    return {**ROW, "remedy": number, "what": what, "change": "worse", "rank": None, **changes}


def test_the_line_as_it_is_stands_on_top_and_the_best_remedy_below_it() -> None:
    best = remedy(1, "dampers", change="better", rank=1, onset_m_per_s=2.1)
    rows = [remedy(0, "spacers"), best, AS_IT_IS]
    onset, amplitude, share = figure_of(picture({"remedies": rows}, FACTS, Options())).axes
    assert [label.get_text() for label in onset.get_yticklabels()] == ["The line as it is", "dampers", "spacers"]
    assert [line.get_xydata().tolist() for line in onset.get_lines() if line.get_marker() == "o"] == [[[2.1, 1.0]]]
    dashed = next(line for line in onset.get_lines() if line.get_linestyle() == "--")
    assert list(dashed.get_xdata()) == [1.8, 1.8]
    half, most = ROW["vertical_p50_m"] / 2.0, ROW["vertical_p95_m"] / 2.0
    assert amplitude.collections[1].get_segments()[0].tolist() == [[half, 1.0], [most, 1.0]]
    assert [line.get_xdata()[0] for line in share.get_lines()] == pytest.approx([100.0 * ROW["improves"]] * 2)


def test_what_is_absent_says_whether_there_is_none_or_it_is_not_known() -> None:
    at_rest = remedy(0, "at rest", gallops="no", onset_m_per_s=None, vertical_peak_to_peak_m=0.0, **NO_SAMPLES)
    unknown = remedy(1, "unknown", gallops="undecided", onset_m_per_s=None, vertical_peak_to_peak_m=None, **NO_SAMPLES)
    rows = [{**AS_IT_IS, **NO_SAMPLES}, at_rest, unknown]
    onset, amplitude, share = figure_of(picture({"remedies": rows}, FACTS, Options())).axes
    assert [text.get_text() for text in onset.texts] == ["no onset", "not known"]
    assert [text.get_text() for text in amplitude.texts] == ["not known"]
    assert [text.get_text() for text in share.texts] == ["there are no samples"]


def test_a_long_table_is_cut_and_an_empty_one_told() -> None:
    rows = [AS_IT_IS, *(remedy(number, f"remedy {number}") for number in range(20))]
    figure = figure_of(picture({"remedies": rows}, FACTS, Options(width=400.0)))
    assert len(figure.axes) == 3
    assert any("5 further rows of the table" in text.get_text() for text in figure.texts)
    for panel in figure_of(picture({"remedies": []}, FACTS, Options())).axes:
        assert panel.texts
