import warnings
from xml.etree import ElementTree

import numpy as np
import pytest

from app.plots import Options
from app.plots.canvas.drawing import About, drawn
from app.plots.canvas.sheet import Heading, Sheet, new_sheet


def sheet(title: str, points: int = 10) -> Sheet:
    made = new_sheet(Heading(title, "x"), Options(), 300.0)
    phase = np.linspace(0.0, 2.0 * np.pi, points)
    made.figure.subplots().plot(np.cos(phase), np.sin(phase))
    return made


@pytest.mark.parametrize(
    "title", ["$x^", "50 % $ \\frac{", "\u5bfc\u7ebf <&>", "x" * 200, " ", "\u062e\u0637 \u0646\u0642\u0644"]
)
def test_no_name_of_a_line_breaks_its_picture(title: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        root = ElementTree.fromstring(drawn(lambda: sheet(title), Options(), About(title, "y")))
    assert root[0].text == title


def test_paths_are_as_short_as_a_tenth_of_a_px_allows() -> None:
    sizes = [len(drawn(lambda n=n: sheet("x", n), Options(), About("x", "y"))) for n in (400, 40000)]  # type: ignore[misc]
    assert sizes[1] < 1.1 * sizes[0]
