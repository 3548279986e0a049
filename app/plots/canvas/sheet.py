"""The sheet of a picture: a figure with heading and footer, and room between them for panels and a legend."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.transforms import Bbox

from app.plots.canvas.fonts import MISSING, families, writable
from app.plots.canvas.themes import PALETTES, Palette
from app.plots.canvas.wrapping import width_of, wrapped
from app.plots.options import Options

USUAL_WIDTH = 1000.0
PX_PER_INCH = 96.0
PT_PER_PX = 72.0 / PX_PER_INCH
SHARP_DOTS_PER_PX = 1.6  # of a PNG of the usual size
_LARGEST_LAYOUT = 1400.0  # wider pictures are the same in larger letters
_MARGIN = 12.0
Box = tuple[float, float, float, float]
"""Left, right, bottom and top of what a panel shows."""

_TITLE, _TEXT, _FOOT = 15.0, 12.0, 10.5  # sizes of letters [px]
_LINE = 1.35
_HINTED = 1.06  # small letters of a PNG are rounded to whole px, which widens a line by so much at most
_LEGEND_PX, _LEGEND_ROW_PX = 16.0, 18.0
_LEFT_OUT = f"{MISSING} stands for characters without a font on this machine."


@dataclass(frozen=True, slots=True)
class Heading:
    """Texts around the body: the title, what the picture shows, and sentences below it."""

    title: str
    subtitle: str
    footer: Sequence[str] = ()


@dataclass(frozen=True, slots=True)
class Sheet:
    """A figure with heading and footer, its colours and fonts, and what counts for layout [px].

    width is that of the figure; above and below are the heights of heading and footer, within which panels may not be.
    boxes holds the panels whose axes are to be equal, with what each has to show; `settle` sets their limits.
    magnified holds those whose heights are so many times larger: left, right, height in the middle, and that number.
    """

    figure: Figure
    palette: Palette
    families: Sequence[str]
    width: float
    height: float
    above: float
    below: float
    boxes: dict[Axes, Box] = field(default_factory=dict)
    magnified: dict[Axes, tuple[float, float, float, float]] = field(default_factory=dict)

    def write(self, text: str) -> str:
        """Return a text as the sheet's fonts can write it."""
        return writable(text, self.families)


def settle(sheet: Sheet) -> None:
    """Place the panels, once and for all, and give both axes of those in `boxes` one scale.

    The solver of the layout leaves rounding errors that differ from run to run, so its places are rounded.
    """
    figure = sheet.figure
    for panel, box in sheet.boxes.items():
        _set_limits(panel, box, 1.0)  # as wide as later, so that there is room for the labels
    engine = figure.get_layout_engine()
    assert engine is not None, "sheets are made with a layout"
    engine.execute(figure)
    figure.set_layout_engine("none")
    for panel in figure.get_axes():
        panel.set_position(Bbox.from_extents(*np.round(panel.get_position(original=True).extents, 5)))
    for panel, box in sheet.boxes.items():
        place = panel.get_position(original=True)
        _set_limits(panel, box, place.height * sheet.height / (place.width * sheet.width))
    for panel, (left, right, middle, times) in sheet.magnified.items():
        place = panel.get_position(original=True)
        half = 0.5 * (right - left) * place.height * sheet.height / (place.width * sheet.width) / times
        panel.set_ylim(middle - half, middle + half)


def _set_limits(panel: Axes, box: Box, height_over_width: float) -> None:
    across, up = limits_about(box, height_over_width)
    panel.set_xlim(*across)
    panel.set_ylim(*up)


def layout_width(options: Options) -> float:
    """Return the width at which letters have their usual size [px]; larger pictures are magnified, except PDF."""
    wanted = options.width or USUAL_WIDTH
    return wanted if options.extension == "pdf" else min(wanted, _LARGEST_LAYOUT)


def columns(width: float, wanted: int, narrowest: float = 250.0) -> int:
    """Return how many of the wanted columns of panels fit into a width [px]; they fill whole rows."""
    fitting = max(1, min(wanted, int(width // narrowest)))
    return next(number for number in range(fitting, 0, -1) if wanted % number == 0)


def new_sheet(heading: Heading, options: Options, body_height: float, names: Sequence[str] = ()) -> Sheet:
    """Make a figure with heading and footer.

    Parameters
    ----------
    heading : Heading
    options : Options
        Its height, if given, is divided among the same parts.
    body_height : float
        Height that the panels and legends need [px].
    names : sequence of str
        Further texts of the line, such as names of phases, for which fonts are needed.
    """
    palette = PALETTES[options.theme]
    width = layout_width(options)
    scale = (options.width or USUAL_WIDTH) / width
    chosen = families(" ".join((heading.title, *heading.footer, *names)))
    inside = (width - 2.0 * _MARGIN) / _HINTED
    titles = wrapped(writable(heading.title, chosen), inside / (1.1 * _TITLE), 2)
    subtitles = wrapped(heading.subtitle, inside / _TEXT, 3)
    feet = _feet(heading, chosen, inside)
    above = _MARGIN + _LINE * (_TITLE * len(titles) + _TEXT * len(subtitles)) + 0.5 * _MARGIN
    below = 0.8 * _MARGIN + _LINE * _FOOT * len(feet)
    height = options.height / scale if options.height else above + body_height + below
    dots = scale * PX_PER_INCH * (_density(options) if options.extension == "png" else 1.0)
    figure = Figure(
        figsize=(width / PX_PER_INCH, height / PX_PER_INCH),
        dpi=dots,
        layout="constrained",
        facecolor=palette.background,
    )
    sheet = Sheet(figure, palette, chosen, width, height, above, below)
    down = _write_down(sheet, _MARGIN, [(line, _TITLE, palette.text, "bold") for line in titles])
    _write_down(sheet, down, [(line, _TEXT, palette.muted, "normal") for line in subtitles])
    _write_down(sheet, height - below + 0.2 * _MARGIN, [(line, _FOOT, palette.muted, "normal") for line in feet])
    _leave_room(sheet, 0.0)
    return sheet


def scale_of(options: Options) -> float:
    """Return by how much letters are larger than usual."""
    return (options.width or USUAL_WIDTH) / layout_width(options)


def place_legend(sheet: Sheet, handles: Sequence[Line2D | Any]) -> None:
    """Put a legend below the panels, in as many columns as fit its longest entry."""
    rows = _legend_rows(handles, sheet.width)
    if rows:
        legend = sheet.figure.legend(
            handles=handles,
            loc="lower center",
            bbox_to_anchor=(0.5, sheet.below / sheet.height),
            ncols=math.ceil(len(handles) / rows),
            frameon=False,
            handlelength=2.6,
        )
        legend.set_in_layout(False)
        _leave_room(sheet, _LEGEND_PX + _LEGEND_ROW_PX * rows)


def legend_height(handles: Sequence[Line2D | Any], options: Options) -> float:
    """Return the height of a legend below the panels [px]."""
    rows = _legend_rows(handles, layout_width(options))
    return _LEGEND_PX + _LEGEND_ROW_PX * rows if rows else 0.0


def _legend_rows(handles: Sequence[Line2D | Any], width: float) -> int:
    longest = max((width_of(str(handle.get_label())) for handle in handles), default=0.0)
    fitting = max(1, int((width - 2.0 * _MARGIN) // (_TEXT * longest + 60.0)))
    return math.ceil(len(handles) / fitting)


def _leave_room(sheet: Sheet, legend: float) -> None:
    """Keep panels between heading and footer, above a legend of a height [px]."""
    bottom = (sheet.below + legend) / sheet.height
    room = max(1.0 - bottom - sheet.above / sheet.height, 0.1)
    engine = sheet.figure.get_layout_engine()
    assert isinstance(engine, ConstrainedLayoutEngine), "the figure was made with this layout"
    engine.set(rect=(0.004, bottom, 0.992, room))


def empty(panel: Axes, text: str, palette: Palette) -> None:
    """Say in the middle of a panel why there is nothing in it."""
    panel.text(0.5, 0.5, text, transform=panel.transAxes, ha="center", va="center", color=palette.muted, wrap=True)
    panel.set_axis_off()


def _feet(heading: Heading, chosen: Sequence[str], inside: float) -> list[str]:
    sentences = [sentence for sentence in heading.footer if sentence]
    if writable(heading.title, chosen) != heading.title:
        sentences.append(_LEFT_OUT)
    return [line for sentence in sentences for line in wrapped(writable(sentence, chosen), inside / _FOOT, 3)]


def _density(options: Options) -> float:
    if options.dots_per_px is not None:
        return options.dots_per_px
    return 1.0 if options.width or options.height else SHARP_DOTS_PER_PX


def _write_down(sheet: Sheet, down: float, lines: Sequence[tuple[str, float, str, str]]) -> float:
    """Write lines below each other at the left edge, from so far down [px], and return where the next one would be."""
    for text, size, colour, weight in lines:
        sheet.figure.text(
            _MARGIN / sheet.width,
            1.0 - down / sheet.height,
            text,
            fontsize=size * PT_PER_PX,
            color=colour,
            fontweight=weight,
            va="top",
            ha="left",
        ).set_in_layout(False)
        down += _LINE * size
    return down


def limits_about(box: Box, height_over_width: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return limits of x and y about a box with a margin, in the shape of a panel, so that the axes stay equal."""
    left, right, bottom, top = box
    width, height = max(right - left, 1e-6) * 1.14, max(top - bottom, 1e-6) * 1.14
    width, height = max(width, height / height_over_width), max(height, width * height_over_width)
    x, y = 0.5 * (left + right), 0.5 * (bottom + top)
    if not math.isfinite(width + height):
        return (-1.0, 1.0), (-1.0, 1.0)
    return (x - 0.5 * width, x + 0.5 * width), (y - 0.5 * height, y + 0.5 * height)
