import math
from typing import Any

import numpy as np
import pytest

from app.plots import Options
from app.plots.amplitudes import picture, reach
from tests.app.plots.drawn_motions import FACTS, FOLDED, NO_MOTIONS, Tables, motions
from tests.app.plots.seen import figure_of


def lines_of(found: Tables, panel: int = 0) -> list[tuple[Any, Any, str]]:
    axes = figure_of(picture(found, FACTS, Options())).axes[panel]
    return [
        (np.asarray(line.get_xdata()).tolist(), np.asarray(line.get_ydata()).tolist(), str(line.get_linestyle()))
        for line in axes.get_lines()
    ]


def one_model(found: Tables) -> Tables:
    return {name: [row for row in rows if row.get("model", "hybrid") == "hybrid"] for name, rows in found.items()}


def test_the_picture_begins_at_the_onset_and_goes_through_the_winds_asked_for() -> None:
    assert ([2.4, 4.0, 5.0, 6.0], [0.0, 0.2, 0.25, pytest.approx(0.3)], "-") in lines_of(motions(loops=(1,)))


def test_whole_curves_are_solid_where_stable_and_dashed_where_not() -> None:
    drawn = lines_of({**motions(loops=(1,)), "amplitude_curves": FOLDED})
    assert ([2.4, 4.0, 8.0, 6.0], [0.0, 0.1, 0.3, 0.5], "-") in drawn
    assert ([6.0, 5.0], [0.5, 0.6], "--") in drawn


def test_torsion_is_in_degrees() -> None:
    drawn = lines_of({**motions(loops=(1,)), "amplitude_curves": FOLDED}, panel=2)
    sizes = [pytest.approx(math.degrees(0.1 * size)) for size in (0.5, 0.6)]
    assert ([6.0, 5.0], sizes, "--") in drawn


def test_a_fold_is_marked_where_the_branch_turns() -> None:
    fold = {"model": "hybrid", "loops": 1, "branch": 0, "type": "fold", "wind_speed_m_per_s": 7.98}
    drawn = lines_of({**motions(loops=(1,)), "amplitude_curves": FOLDED, "bifurcations": [fold]})
    ((_, (size,), _),) = [line for line in drawn if line[0] == [7.98]]
    assert size == pytest.approx(0.3, abs=0.01)


def test_a_bifurcation_without_a_branch_is_marked_at_the_upper_edge() -> None:
    lost = {"model": "hybrid", "loops": 1, "branch": 7, "type": "torus", "wind_speed_m_per_s": 5.0}
    assert ([5.0], [1.0], "None") in lines_of({**motions(loops=(1,)), "bifurcations": [lost]})


def test_quasi_periodic_motions_are_bands_between_their_amplitudes() -> None:
    found = one_model(motions(loops=(1,)))
    for row in found["limit_cycles"]:
        if row["kind"] == "periodic" and row["vertical_m"] is not None:
            row |= {"kind": "quasi_periodic", "vertical_min_m": 0.1, "horizontal_min_m": 0.1, "torsional_min_rad": 0.0}
    axes = figure_of(picture(found, FACTS, Options())).axes[0]
    bars, band = axes.collections
    assert [segment.tolist() for segment in bars.get_segments()] == [
        [[wind, 0.1], [wind, pytest.approx(0.05 * wind)]] for wind in (4.0, 5.0, 6.0)
    ]
    outline = band.get_paths()[0].vertices
    assert (outline[:, 0].min(), outline[:, 0].max(), outline[:, 1].max()) == (4.0, 6.0, pytest.approx(0.3))


def test_panels_of_one_direction_have_one_scale_from_zero() -> None:
    found = motions()
    for row in found["limit_cycles"]:
        if row["loops"] == 2 and row["vertical_m"] is not None:
            row["vertical_m"] *= 5.0
    axes = figure_of(picture(found, FACTS, Options())).axes
    assert axes[0].get_ylim() == axes[3].get_ylim()
    assert axes[0].get_ylim()[0] == 0.0
    assert axes[0].get_ylim()[1] > 5.0 * 0.3


def test_symbols_are_filled_if_stable_and_both_models_differ_in_shape_and_colour() -> None:
    axes = figure_of(picture(motions(loops=(1,)), FACTS, Options())).axes[0]
    symbols = {
        (line.get_marker(), line.get_markerfacecolor()) for line in axes.get_lines() if len(line.get_xydata()) > 2
    }
    assert {("o", "#0b5394"), ("s", "#b8520f"), ("o", "#ffffff"), ("s", "#ffffff")} <= symbols


def test_far_critical_winds_are_told_rather_than_drawn() -> None:
    found = motions(loops=(1,))
    far = {"model": "hybrid", "loops": 1, "wind_speed_m_per_s": 25.0, "crossing": "onset"}
    found["critical_wind_speeds"].append(far)
    figure = figure_of(picture(found, FACTS, Options()))
    assert reach(found) == pytest.approx(6.6)
    assert figure.axes[0].get_xlim()[1] < 7.0
    assert any("onset at 25 m/s (hybrid model, 1 loop)" in text.get_text() for text in figure.texts)
    assert reach(NO_MOTIONS) == math.inf


def test_it_says_half_peak_to_peak_and_has_units_on_every_axis() -> None:
    figure = figure_of(picture(motions(), FACTS, Options()))
    assert any("half of peak to peak" in text.get_text() for text in figure.texts)
    assert [axes.get_ylabel() for axes in figure.axes[:3]] == ["amplitude [m]", "amplitude [m]", "amplitude [\u00b0]"]
    assert {axes.get_xlabel() for axes in figure.axes[3:]} == {"wind speed [m/s]"}


def test_narrow_pictures_stack_their_panels() -> None:
    places = [
        axes.get_subplotspec() for axes in figure_of(picture(motions(loops=(1,)), FACTS, Options(width=400.0))).axes
    ]
    assert [spec.get_geometry()[:2] for spec in places if spec is not None] == [(3, 1)] * 3


def test_the_footer_says_how_to_get_branches_that_were_not_asked_for() -> None:
    def said(found: Tables) -> bool:
        return any("Whole branches" in text.get_text() for text in figure_of(picture(found, FACTS, Options())).texts)

    assert said({**motions(), "amplitude_curves": []})
    assert not said({**motions(), "amplitude_curves": FOLDED})
