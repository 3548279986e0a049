import pytest
from matplotlib.lines import Line2D

from app.plots import Options
from app.plots.canvas.sheet import (
    Heading,
    columns,
    layout_width,
    limits_about,
    new_sheet,
    place_legend,
    scale_of,
    settle,
)
from tests.app.plots.seen import figure_of

HEADING = Heading("C11 twin", "What it shows.", ("2 sub-conductors", "", "engine 0.4.0"))


@pytest.mark.parametrize(
    ("options", "size", "dots"),
    [
        (Options(), (1000.0, None), 96.0),
        (Options("png"), (1000.0, None), 1.6 * 96.0),
        (Options("png", width=600.0), (600.0, None), 96.0),
        (Options("png", width=2800.0, height=2000.0), (1400.0, 1000.0), 192.0),
        (Options("pdf", width=2800.0), (2800.0, None), 96.0),
    ],
)
def test_a_sheet_has_the_size_asked_for(options: Options, size: tuple[float, float | None], dots: float) -> None:
    sheet = new_sheet(HEADING, options, 300.0)
    width, height = (96.0 * side for side in figure_of(sheet).get_size_inches())
    assert (width, figure_of(sheet).dpi) == (pytest.approx(size[0]), pytest.approx(dots))
    assert height == pytest.approx(size[1] or sheet.above + 300.0 + sheet.below)


def test_larger_pictures_are_the_same_in_larger_letters() -> None:
    assert (layout_width(Options(width=2800.0)), scale_of(Options(width=2800.0))) == (1400.0, 2.0)


def test_panels_stay_between_heading_and_legend() -> None:
    sheet = new_sheet(HEADING, Options(), 300.0)
    panel = figure_of(sheet).subplots()
    panel.set_title("title")
    place_legend(sheet, [Line2D([], [], label="a"), Line2D([], [], label="b")])
    settle(sheet)
    place = panel.get_position()
    assert place.y1 * sheet.height < sheet.height - sheet.above
    assert place.y0 * sheet.height > sheet.below + 30.0
    assert [text.get_text() for text in figure_of(sheet).texts] == [
        "C11 twin",
        "What it shows.",
        "2 sub-conductors",
        "engine 0.4.0",
    ]


def test_a_name_without_a_font_is_told() -> None:
    sheet = new_sheet(Heading("\U0001f32c wind", "x"), Options(), 300.0)
    assert figure_of(sheet).texts[0].get_text() == sheet.write("\U0001f32c wind")
    if sheet.write("\U0001f32c") != "\U0001f32c":
        assert "without a font" in figure_of(sheet).texts[-1].get_text()


def test_columns_fill_whole_rows() -> None:
    assert [columns(width, 4, 300.0) for width in (1300.0, 1000.0, 700.0, 300.0)] == [4, 2, 2, 1]


def test_limits_hold_the_box_in_the_shape_of_the_panel() -> None:
    (left, right), (bottom, top) = limits_about((-1.0, 1.0, 0.0, 1.0), 0.5)
    assert (top - bottom) / (right - left) == pytest.approx(0.5)
    assert [left, right] == pytest.approx([-1.14, 1.14])
    assert bottom < 0.0
    assert top > 1.0
