import io
from typing import Any
from xml.etree import ElementTree

import numpy as np
from matplotlib.image import imread

from app import plots


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


def test_the_picture_is_whole_whatever_was_asked() -> None:
    for rows in (found(), found((3,), ("hybrid",))):
        assert ElementTree.fromstring(plots.modes("$x^ <&>", rows, "svg")).tag.endswith("svg")
    picture = imread(io.BytesIO(plots.modes("C11 twin", found(), "png")), format="png")
    assert float(picture[..., :3].std()) > 0.01


def test_the_same_shapes_make_the_same_picture_and_others_another() -> None:
    assert plots.modes("x", found(), "svg") == plots.modes("x", found(), "svg")
    assert plots.modes("x", found(), "svg") != plots.modes("x", found((1, 3)), "svg")
