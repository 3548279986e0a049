"""Draw mode shapes of both models."""

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from app.plots.canvas.sheet import Heading, Sheet, columns, layout_width, legend_height, new_sheet, place_legend
from app.plots.canvas.themes import PALETTES, Palette
from app.plots.facts import Facts, Found, Row
from app.plots.options import Options
from app.plots.parts.rows import NAMES, WIDTHS, loops_name

_DIRECTIONS = ("vertical", "horizontal", "torsional")
_OTHERS = {"vertical": ("longitudinal", "horizontal"), "horizontal": ("longitudinal", "vertical"), "torsional": ()}
_STYLES = {"longitudinal": ":", "vertical": "--", "horizontal": "--"}
_PANEL_PX = 215.0
_SUBTITLE = (
    "Mode shapes without wind, scaled alike: displacement of the span from rest, relative to the mode's amplitude."
)


def picture(found: Found, facts: Facts, options: Options) -> Sheet:
    """Draw the shapes along the span, a panel for each number of loops and direction.

    The tables are frequencies, and shapes (`app.convert.mode_shapes`).
    """
    loops = sorted({shape["loops"] for shape in found["shapes"]}) or [1]
    beside = columns(layout_width(options), len(_DIRECTIONS), 230.0)
    rows = len(loops) * len(_DIRECTIONS) // beside
    handles = _legend(found["shapes"], PALETTES[options.theme])
    height = _PANEL_PX * rows + 20.0 + legend_height(handles, options)
    sheet = new_sheet(Heading(facts.title, _SUBTITLE, facts.footer), options, height)
    panels = sheet.figure.subplots(rows, beside, squeeze=False, sharex=True, sharey=True)
    places = [(count, direction) for count in loops for direction in _DIRECTIONS]
    for panel, (count, direction) in zip(panels.flat, places, strict=True):
        here = [s for s in found["shapes"] if (s["direction"], s["loops"]) == (direction, count)]
        _panel(panel, direction, here, sheet.palette)
        frequencies = [row for row in found.get("frequencies", ()) if row["loops"] == count]
        panel.set_title(_heading(direction, loops_name(count, facts.of_section), frequencies))
    for panel in panels[-1]:
        panel.set_xlabel("distance from the left support [m]")
    for panel in panels[:, 0]:
        panel.set_ylabel("relative displacement")
    place_legend(sheet, handles)
    return sheet


def _panel(panel: Axes, direction: str, shapes: Sequence[Row], palette: Palette) -> None:
    """Draw each model's main component, the hybrid model's broad and below, and the other components thin."""
    for shape in shapes:
        colour, width = palette.models[shape["model"]], 0.75 * WIDTHS[shape["model"]]
        alpha = 0.6 if shape["model"] == "hybrid" else 1.0
        panel.plot(shape["position_m"], shape[direction], color=colour, linewidth=width, alpha=alpha)
        for other in _OTHERS[direction]:
            panel.plot(shape["position_m"], shape[other], _STYLES[other], color=colour, linewidth=0.3 * width + 0.5)
    panel.axhline(0.0, color=palette.muted, linewidth=0.5)
    panel.grid(visible=True, clip_on=False)


def _heading(direction: str, loops: str, frequencies: Sequence[Row]) -> str:
    known = [row for row in frequencies if row[f"{direction}_hz"] is not None]
    text = ", ".join(f"{NAMES[row['model']].removesuffix(' model')} {row[f'{direction}_hz']:.4f} Hz" for row in known)
    return f"{direction}, {loops}\n{text}"


def _legend(shapes: Sequence[Row], palette: Palette) -> list[Line2D]:
    models = [name for name in NAMES if name in {shape["model"] for shape in shapes}]
    entries = [
        Line2D([], [], color=palette.models[model], linewidth=0.75 * WIDTHS[model], label=NAMES[model])
        for model in models
    ]
    entries.append(Line2D([], [], color=palette.muted, linestyle="--", label="across, in the other direction"))
    return [*entries, Line2D([], [], color=palette.muted, linestyle=":", label="along the span")]
