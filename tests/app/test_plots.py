import io
import warnings
from typing import Any, get_args
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.image import imread

from app import plots
from app.plots import Extension
from tests.app.plots.drawn_motions import NO_MOTIONS, motions


@pytest.mark.parametrize("draw", [plots.amplitude, plots.orbit])
@pytest.mark.parametrize(
    "rows", [motions(), motions(speeds=(5.0,), loops=(3,)), motions(tuple(np.linspace(3, 9, 20))), NO_MOTIONS]
)
def test_pictures_are_whole_whatever_was_found(draw: Any, rows: Any) -> None:
    root = ElementTree.fromstring(draw("C11 twin", rows, "svg"))
    assert root.tag.endswith("svg")
    picture = imread(io.BytesIO(draw("C11 twin", rows, "png")), format="png")
    assert picture.ndim == 3
    assert float(picture[..., :3].std()) > 0.01


@pytest.mark.parametrize("draw", [plots.amplitude, plots.orbit])
def test_the_same_rows_make_the_same_picture(draw: Any) -> None:
    assert draw("C11 twin", motions(), "svg") == draw("C11 twin", motions(), "svg")
    assert draw("C11 twin", motions(), "svg") != draw("C11 twin", motions(speeds=(4.0, 5.0, 7.0)), "svg")


@pytest.mark.parametrize("title", ["$x^", "50 % $ \\frac{", "\u5bfc\u7ebf <&>", "x" * 200, " "])
def test_no_name_of_a_line_breaks_its_picture(title: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ElementTree.fromstring(plots.amplitude(title, motions(), "svg"))
        ElementTree.fromstring(plots.orbit(title, motions(), "svg"))


def test_stable_and_unstable_motions_have_other_markers() -> None:
    stable, unstable = motions(), motions()
    for row in unstable["limit_cycles"]:
        row["stability"] = "unstable"
    assert plots.amplitude("x", stable, "svg") != plots.amplitude("x", unstable, "svg")
    assert plots.orbit("x", stable, "svg") != plots.orbit("x", unstable, "svg")


def test_there_is_a_media_type_for_each_format() -> None:
    assert plots.MEDIA_TYPES == {"svg": "image/svg+xml", "png": "image/png"}
    assert set(plots.MEDIA_TYPES) == set(get_args(Extension))
