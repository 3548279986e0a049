"""Every picture of the registry is drawn, in every format, and equal rows give equal bytes."""

import io
import subprocess
import sys
from xml.etree import ElementTree

import pytest
from matplotlib.image import imread

from app import convert
from app.plots import EDITION, PICTURES, Options, draw, drawable
from tests.app.plots.drawn_motions import FACTS, NO_MOTIONS, SURROUNDED, Tables, motions

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def found() -> Tables:
    """Give rows of every table."""
    verdict = {"worst_loops": 1, "worst_wind_m_per_s": 6.0, "vertical_peak_to_peak_m": 0.6}
    tables = convert.example_tables()
    return {
        **tables,
        **motions(),
        "verdict": [{**tables["verdict"][0], **verdict}],
        "shapes": [],
        "static": [],
    }


@pytest.mark.parametrize("name", PICTURES)
def test_every_picture_is_whole_small_and_the_same_twice(name: str, found: Tables) -> None:
    svg = draw(name, found, SURROUNDED, Options())
    root = ElementTree.fromstring(svg)
    assert (root.tag, root[0].tag, root[1].tag) == (f"{SVG}svg", f"{SVG}title", f"{SVG}desc")
    assert root[0].text == f"Drake: {PICTURES[name].title}"
    assert "Drake" in [text.text for text in root.iter(f"{SVG}text")]
    assert len(svg) < 60_000
    assert svg == draw(name, found, SURROUNDED, Options())


@pytest.mark.parametrize("name", ["amplitude", "verdict"])
def test_png_has_the_pixels_asked_for_and_the_theme_its_colours(name: str, found: Tables) -> None:
    drawn = draw(name, found, FACTS, Options("png", "dark", 400.0, 700.0))
    picture = imread(io.BytesIO(drawn), format="png")
    assert picture.shape[:2] == (700, 400)
    assert [round(float(value) * 255) for value in picture[2, 2, :3]] == [0x14, 0x18, 0x1D]
    assert float(picture[..., :3].std()) > 0.01


def test_pdf_is_the_same_twice_and_has_the_size_asked_for(found: Tables) -> None:
    drawn = draw("tensions", found, FACTS, Options("pdf", "light", 800.0, 400.0))
    assert drawn.startswith(b"%PDF")
    assert b"/MediaBox [ 0 0 600 300 ]" in drawn
    assert drawn == draw("tensions", found, FACTS, Options("pdf", "light", 800.0, 400.0))


def test_pictures_for_print_are_the_same_in_more_dots(found: Tables) -> None:
    drawn = draw("risk", found, FACTS, Options("png", width=400.0, height=300.0, dots_per_px=2.0))
    assert imread(io.BytesIO(drawn), format="png").shape[:2] == (600, 800)


def test_pictures_that_make_sense_are_those_with_rows(found: Tables) -> None:
    assert set(drawable(found, study=False)) == set(PICTURES) - {"study"}
    assert drawable(found, study=True) == ["study"]
    assert drawable(NO_MOTIONS, study=False) == []


def test_matplotlib_is_not_loaded_before_a_picture_is_drawn() -> None:
    script = "import sys, app.plots, app.interactive; sys.exit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == 0
    assert EDITION > 0
