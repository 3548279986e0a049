from typing import Any

import numpy as np
import pytest

from app.plots import Options
from app.plots.modes import picture
from tests.app.plots.drawn_motions import FACTS
from tests.app.plots.seen import figure_of


def found(loops: tuple[int, ...] = (1, 2), models: tuple[str, ...] = ("hybrid", "finite_element")) -> Any:
    """Return half sines, the finite element model's with a tenth of the other direction."""
    x = np.linspace(0.0, 126.0, 21)
    shapes, frequencies = [], []
    for model in models:
        for count in loops:
            frequencies.append({"model": model, "loops": count, "vertical_hz": 0.5, "horizontal_hz": 0.4})
            frequencies[-1]["torsional_hz"] = None
            for direction in ("vertical", "horizontal", "torsional"):
                wave = np.sin(count * np.pi * x / 126.0)
                other = (0.1 * wave).tolist()
                row = {"model": model, "direction": direction, "loops": count, "position_m": x.tolist()}
                row |= dict.fromkeys(("longitudinal", "vertical", "horizontal", "torsional"), other)
                shapes.append(row | {direction: wave.tolist()})
    return {"shapes": shapes, "frequencies": frequencies}


def test_each_direction_and_number_of_loops_has_its_shapes() -> None:
    panels = figure_of(picture(found(), FACTS, Options())).axes
    assert len(panels) == 6
    assert panels[0].get_title() == "vertical, 1 loop\nhybrid 0.5000 Hz, finite element 0.5000 Hz"
    shape = np.asarray(panels[3].get_lines()[0].get_data())
    assert shape[0, [0, -1]].tolist() == [0.0, 126.0]
    assert shape[1, 5] == pytest.approx(1.0)  # a quarter of the span: the top of the first of two loops
    assert len({panel.get_ylim() for panel in panels}) == 1


def test_one_model_and_other_loops_are_drawn_too() -> None:
    panels = figure_of(picture(found((3,), ("hybrid",)), FACTS, Options())).axes
    assert [panel.get_title().split("\n")[0] for panel in panels] == [
        f"{direction}, 3 loops" for direction in ("vertical", "horizontal", "torsional")
    ]


def test_a_line_without_shapes_has_an_empty_picture() -> None:
    assert len(figure_of(picture({"shapes": [], "frequencies": []}, FACTS, Options())).axes) == 3
