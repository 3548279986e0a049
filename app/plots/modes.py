"""Draw mode shapes of both models."""

import textwrap
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from app.plots.drawing import COLOURS, NAMES, Extension, Found, Row, drawn, loops_name

_DIRECTIONS = ("vertical", "horizontal", "torsional")
_OTHERS = {"vertical": ("longitudinal", "horizontal"), "horizontal": ("longitudinal", "vertical"), "torsional": ()}
_STYLES = {"longitudinal": ":", "vertical": "--", "horizontal": "--"}


def modes(title: str, found: Found, extension: Extension) -> bytes:
    """Draw the shapes along the span, a row of panels for each number of loops, a column for each direction.

    Parameters
    ----------
    title : str
        Title of the picture.
    found : mapping
        Rows of `shapes` (`app.convert.mode_shapes`) and of `frequencies`.
    extension : {"svg", "png"}
        Format of the picture.
    """
    return drawn(lambda: _figure(title, found), extension)


def _figure(title: str, found: Found) -> Figure:
    loops = sorted({shape["loops"] for shape in found["shapes"]})
    figure = Figure(figsize=(10.5, 1.3 + 2.5 * len(loops)), layout="constrained")
    panels = figure.subplots(len(loops), len(_DIRECTIONS), squeeze=False, sharex=True)
    for count, row in zip(loops, panels, strict=True):
        for direction, panel in zip(_DIRECTIONS, row, strict=True):
            here = [s for s in found["shapes"] if (s["direction"], s["loops"]) == (direction, count)]
            _panel(panel, direction, here)
            panel.set_title(_heading(direction, count, found["frequencies"]), fontsize=9.0)
    for panel in panels[-1]:
        panel.set_xlabel("distance from the left support [m]")
    figure.suptitle(textwrap.fill(title, 90), fontweight="bold")
    figure.legend(handles=_legend(found["shapes"]), loc="outside lower center", ncols=4, frameon=False)
    return figure


def _panel(panel: Axes, direction: str, shapes: Sequence[Row]) -> None:
    """Draw each model's main component, the hybrid model's broad and below, and the other components thin."""
    for shape in shapes:
        width = 3.5 if shape["model"] == "hybrid" else 1.3
        colour = COLOURS[shape["model"]]
        panel.plot(shape["position_m"], shape[direction], color=colour, linewidth=width, alpha=0.8)
        for other in _OTHERS[direction]:
            style = _STYLES[other]
            panel.plot(shape["position_m"], shape[other], style, color=colour, linewidth=0.25 * width + 0.5)
    panel.axhline(0.0, color="grey", linewidth=0.5)
    panel.grid(visible=True, alpha=0.25)


def _heading(direction: str, count: int, frequencies: Sequence[Row]) -> str:
    rows = [row for row in frequencies if row["loops"] == count and row[f"{direction}_hz"] is not None]
    text = ", ".join(f"{NAMES[row['model']].removesuffix(' model')} {row[f'{direction}_hz']:.4f} Hz" for row in rows)
    return f"{direction}, {loops_name(count)}\n{text}"


def _legend(shapes: Sequence[Row]) -> list[Line2D]:
    models = [name for name in NAMES if name in {shape["model"] for shape in shapes}]
    entries = [Line2D([], [], color=COLOURS[model], linewidth=2.0, label=NAMES[model]) for model in models]
    entries.append(Line2D([], [], color="grey", linestyle="--", label="across, in the other direction"))
    return [*entries, Line2D([], [], color="grey", linestyle=":", label="along the span")]
