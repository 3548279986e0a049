from app.plots import Facts, Options
from app.plots.canvas.sheet import Heading, new_sheet
from app.plots.canvas.themes import LIGHT
from app.plots.parts.surroundings import bounds_of, draw_surroundings, surroundings_legend
from tests.app.plots.drawn_motions import SURROUNDED
from tests.app.plots.seen import figure_of


def test_the_bounds_hold_ellipse_and_phases_with_their_clearance() -> None:
    assert bounds_of(SURROUNDED) == (-1.2, 2.0, -6.0, 8.5)
    assert bounds_of(Facts("x")) == (0.0, 0.0, 0.0, 0.0)


def test_what_surrounds_is_drawn_to_the_scale_of_the_axes() -> None:
    sheet = new_sheet(Heading("x", "y"), Options(), 300.0)
    panel = figure_of(sheet).subplots()
    draw_surroundings(panel, SURROUNDED, sheet)
    ellipse, circle = panel.patches
    assert (ellipse.get_center(), ellipse.height) == ((0.0, 1.2), 6.0)
    assert (circle.center, circle.radius) == ((0.5, 7.0), 1.5)
    assert [text.get_text() for text in panel.texts] == ["top", sheet.write("\u76f8 B")]


def test_the_legend_names_only_what_is_there() -> None:
    names = [str(handle.get_label()) for handle in surroundings_legend(Facts("x"), LIGHT)]
    assert names == ["conductor at rest"]
    assert len(list(surroundings_legend(SURROUNDED, LIGHT))) == 4
