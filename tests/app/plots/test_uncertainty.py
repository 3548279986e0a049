import numpy as np
import pytest

from app import convert
from app.plots import Options
from app.plots.uncertainty import picture
from tests.app.plots.drawn_motions import FACTS
from tests.app.plots.seen import figure_of

ROW = convert.example_tables()["uncertainty"][0]
WHOLE = {**ROW, "wind_speed_m_per_s": None}


def test_bands_lie_between_the_quantiles() -> None:
    rows = [WHOLE, *({**ROW, "wind_speed_m_per_s": wind, "vertical_p95_m": 0.2 * wind} for wind in (8.0, 4.0))]
    share, vertical, _, torsional = figure_of(picture({"uncertainty": rows}, FACTS, Options())).axes
    band = vertical.collections[0].get_paths()[0].vertices
    assert (band[:, 0].min(), band[:, 0].max(), band[:, 1].max()) == (4.0, 8.0, pytest.approx(1.6))
    assert np.asarray(vertical.get_lines()[1].get_data()).tolist() == [[4.0, 8.0], [0.81, 0.81]]
    assert np.asarray(torsional.get_lines()[1].get_ydata()).tolist() == [pytest.approx(np.degrees(0.03))] * 2
    assert share.get_ylim() == (0.0, 1.02)
    onset = share.get_lines()[1]
    assert np.asarray(onset.get_xdata()).tolist() == [4.6, 4.6]


def test_a_quantile_that_is_not_known_is_told() -> None:
    rows = [WHOLE, {**ROW, "vertical_p95_m": None}]
    texts = [text.get_text() for text in figure_of(picture({"uncertainty": rows}, FACTS, Options())).texts]
    assert any(text.endswith("how far is not known: 10 m/s.") for text in texts)


def test_without_samples_it_says_why_there_is_nothing() -> None:
    panels = figure_of(picture({"uncertainty": []}, FACTS, Options())).axes
    assert all("no samples" in panel.texts[0].get_text() for panel in panels)
