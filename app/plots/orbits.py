"""Draw orbits at the observation point."""

import math
import textwrap
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from app.plots.drawing import NAMES, Extension, Found, Row, drawn, loops_and_models, loops_name

_ORBIT_POINTS = 361
_MOST_IN_LEGEND = 8


def orbit(title: str, found: Found, extension: Extension) -> bytes:
    """Draw vertical over horizontal motion at the observation point, a panel for each model and number of loops.

    Parameters
    ----------
    title : str
        Title of the picture.
    found : mapping
        Rows of `limit_cycles`, and `orbits` with the cycles' Fourier coefficients and row numbers.
    extension : {"svg", "png"}
        Format of the picture.
    """
    return drawn(lambda: _orbit_figure(title, found), extension)


def _orbit_figure(title: str, found: Found) -> Figure:
    loops, models = loops_and_models(found)
    figure = Figure(figsize=(1.8 + 4.2 * len(models), 0.9 + 3.6 * len(loops)), layout="constrained")
    panels = figure.subplots(len(loops), len(models), squeeze=False)
    cycles = found["limit_cycles"]
    orbits = [(cycles[item["cycle"]], item) for item in found["orbits"]]
    speeds = sorted({cycle["wind_speed_m_per_s"] for cycle, _ in orbits})
    dark = ListedColormap(mpl.colormaps["viridis_r"](np.linspace(0.15, 1.0, 256)))  # without the palest yellow
    colours = ScalarMappable(Normalize(speeds[0], speeds[-1]) if len(speeds) > 1 else Normalize(0.0, 1.0), dark)
    for count, row in zip(loops, panels, strict=True):
        for model, panel in zip(models, row, strict=True):
            mine = [(c, item) for c, item in orbits if (c["model"], c["loops"]) == (model, count)]
            _orbit_panel(panel, mine, colours)
            place = f", at {mine[0][0]['observed_at_m']:.4g} m" if mine else ""
            panel.set_title(f"{NAMES[model]}, {loops_name(count)}{place}", fontsize=9.0)
    figure.suptitle(textwrap.fill(title, 90), fontweight="bold")
    _orbit_key(figure, panels, speeds, colours)
    return figure


def _orbit_panel(panel: Axes, orbits: Sequence[tuple[Row, Row]], colours: ScalarMappable) -> None:
    for cycle, item in orbits:
        colour = _colour(colours, cycle["wind_speed_m_per_s"])
        style = "-" if cycle["stability"] == "stable" else "--"
        panel.plot(_motion(item["horizontal"]), _motion(item["vertical"]), style, color=colour, linewidth=1.5)
    if not orbits:
        panel.text(0.5, 0.5, "no cycle", transform=panel.transAxes, ha="center", va="center", color="grey")
        panel.set_axis_off()
        return
    panel.set_aspect("equal", adjustable="datalim")
    panel.margins(0.08)
    panel.locator_params(nbins=6)
    panel.grid(visible=True, alpha=0.25)
    panel.set_xlabel("horizontal, downwind [m]")
    panel.set_ylabel("vertical, upward [m]")


def _orbit_key(figure: Figure, panels: Any, speeds: Sequence[float], colours: ScalarMappable) -> None:
    styles = [
        Line2D([], [], color="black", linestyle="-", label="stable"),
        Line2D([], [], color="black", linestyle="--", label="unstable or unknown"),
    ]
    if len(speeds) > _MOST_IN_LEGEND:
        figure.colorbar(colours, ax=panels, label="wind speed [m/s]", shrink=0.8)
    else:
        styles += [Line2D([], [], color=_colour(colours, u), linewidth=2.0, label=f"{u:g} m/s") for u in speeds]
    figure.legend(handles=styles, loc="outside lower center", ncols=5, frameon=False)


def _colour(colours: ScalarMappable, speed: float) -> tuple[float, float, float]:
    red, green, blue, _ = colours.to_rgba(np.array([speed]))[0]
    return float(red), float(green), float(blue)


def _motion(coefficients: Sequence[float]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Evaluate (mean, cos 1, sin 1, cos 2, ...) over one period [m or rad]."""
    phase = np.linspace(0.0, 2.0 * math.pi, _ORBIT_POINTS)
    values = np.asarray(coefficients, dtype=np.float64)
    orders = np.arange(1, (values.size - 1) // 2 + 1)[:, None]
    motion = values[0] + values[1::2] @ np.cos(orders * phase) + values[2::2] @ np.sin(orders * phase)
    return np.asarray(motion)
