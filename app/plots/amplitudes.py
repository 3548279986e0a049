"""Pictures of results: amplitude over wind speed, and orbits. The only module that knows matplotlib.

Figures are made as objects, without pyplot and its global state.
"""

import io
import math
import textwrap
import threading
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from typing import Any, Literal

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

Row = Mapping[str, Any]
Found = Mapping[str, Sequence[Row]]
Extension = Literal["svg", "png"]
MEDIA_TYPES: Mapping[Extension, str] = {"svg": "image/svg+xml", "png": "image/png"}

_DRAWING = threading.Lock()  # matplotlib's fonts and settings are shared between threads
_COLOURS = {"hybrid": "#0b5394", "finite_element": "#c55a11"}
_MARKERS = {"hybrid": "o", "finite_element": "s"}
_SIZES = {"hybrid": 7.0, "finite_element": 4.0}  # the smaller ones are drawn over the larger
_NAMES = {"hybrid": "hybrid model", "finite_element": "finite element model"}
_QUANTITIES: Sequence[tuple[str, str, float]] = (
    ("vertical_m", "vertical amplitude [m]", 1.0),
    ("horizontal_m", "horizontal amplitude [m]", 1.0),
    ("torsional_rad", "torsional amplitude [deg]", 180.0 / math.pi),
)
_ORBIT_POINTS = 361
_MOST_IN_LEGEND = 8
_DOTS_PER_INCH = 130


def amplitude(title: str, found: Found, extension: Extension) -> bytes:
    """Draw amplitudes over wind speed, a row of panels for each number of loops.

    Parameters
    ----------
    title : str
        What stands above, usually the line's name.
    found : mapping
        Rows of `limit_cycles` and `critical_wind_speeds`.
    extension : {"svg", "png"}
        Format of the picture.
    """
    return _drawn(lambda: _amplitude_figure(title, found), extension)


def orbit(title: str, found: Found, extension: Extension) -> bytes:
    """Draw vertical over horizontal motion where it is observed, a panel for each model and number of loops.

    Parameters
    ----------
    title : str
        What stands above.
    found : mapping
        Rows of `limit_cycles`, and `orbits` with Fourier coefficients of the cycles by their row number.
    extension : {"svg", "png"}
        Format of the picture.
    """
    return _drawn(lambda: _orbit_figure(title, found), extension)


def _drawn(make: Callable[[], Figure], extension: Extension) -> bytes:
    buffer = io.BytesIO()
    with _DRAWING, _style(), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")  # names may be in any script
        metadata = {"Date": None} if extension == "svg" else None
        make().savefig(buffer, format=extension, dpi=_DOTS_PER_INCH, metadata=metadata)
    return buffer.getvalue()


def _style() -> AbstractContextManager[None]:
    return mpl.rc_context(
        {
            "font.size": 9.0,
            "axes.spines.top": False,
            "axes.spines.right": False,
            "svg.hashsalt": "galloping",
            "text.parse_math": False,  # a dollar sign in a name is a dollar sign
        }
    )


def _amplitude_figure(title: str, found: Found) -> Figure:
    loops, models = _loops_and_models(found)
    figure = Figure(figsize=(10.5, 1.3 + 2.5 * len(loops)), layout="constrained")
    panels = figure.subplots(len(loops), len(_QUANTITIES), squeeze=False, sharex=True)
    for count, row in zip(loops, panels, strict=True):
        cycles = [cycle for cycle in found["limit_cycles"] if cycle["loops"] == count]
        critical = [speed for speed in found["critical_wind_speeds"] if speed["loops"] == count]
        for panel, (column, label, factor) in zip(row, _QUANTITIES, strict=True):
            _critical_lines(panel, critical, cycles)
            for model in models:
                _cycle_markers(panel, [c for c in cycles if c["model"] == model], column, factor)
            panel.set_ylabel(f"{label}\n{_loops_name(count)}" if column == "vertical_m" else label)
            panel.set_ylim(bottom=0.0)
            panel.grid(visible=True, alpha=0.25)
    for panel in panels[-1]:
        panel.set_xlabel("wind speed [m/s]")
    figure.suptitle(textwrap.fill(title, 90), fontweight="bold")
    figure.legend(handles=_amplitude_legend(models), loc="outside lower center", ncols=3, frameon=False)
    return figure


def _cycle_markers(panel: Axes, cycles: Sequence[Row], column: str, factor: float) -> None:
    for (model, branch, stability), group in _groups(cycles, column).items():
        speeds = [cycle["wind_speed_m_per_s"] for cycle in group]
        joined = branch is not None and len(set(speeds)) == len(speeds)  # else a fold: joining would zigzag
        panel.plot(
            speeds,
            [cycle[column] * factor for cycle in group],
            linestyle="-" if joined else "none",
            linewidth=0.8,
            marker=_MARKERS[model],
            markersize=_SIZES[model],
            color=_COLOURS[model],
            markerfacecolor=_face(model, stability),
            markeredgewidth=1.1,
            clip_on=False,
            zorder=4 if model == "hybrid" else 5,
        )


def _groups(cycles: Sequence[Row], column: str) -> dict[tuple[str, int | None, str], list[Row]]:
    groups: dict[tuple[str, int | None, str], list[Row]] = {}
    for cycle in sorted(cycles, key=lambda cycle: cycle["wind_speed_m_per_s"]):
        if cycle[column] is not None:
            groups.setdefault((cycle["model"], cycle["branch"], cycle["stability"]), []).append(cycle)
    return groups


def _face(model: str, stability: str) -> str:
    return {"stable": _COLOURS[model], "unstable": "white"}.get(stability, "lightgrey")


def _critical_lines(panel: Axes, critical: Sequence[Row], cycles: Sequence[Row]) -> None:
    """Mark critical speeds as far as the wind speeds shown reach, or the first ones if none were asked for."""
    reach = 1.15 * max((cycle["wind_speed_m_per_s"] for cycle in cycles), default=math.inf)
    for row in critical:
        if row["wind_speed_m_per_s"] <= reach:
            style = "--" if row["crossing"] == "onset" else ":"
            panel.axvline(row["wind_speed_m_per_s"], color=_COLOURS[row["model"]], linestyle=style, linewidth=1.0)


def _amplitude_legend(models: Sequence[str]) -> list[Line2D]:
    def marker(model: str, stability: str) -> Line2D:
        return Line2D(
            [],
            [],
            linestyle="none",
            marker=_MARKERS[model],
            markersize=_SIZES[model],
            color=_COLOURS[model],
            markerfacecolor=_face(model, stability),
            label=f"{_NAMES[model]}, {stability}",
        )

    entries = [marker(model, stability) for model in models for stability in ("stable", "unstable")]
    entries.append(
        Line2D([], [], color="grey", linestyle="--", linewidth=1.0, label="critical wind speed, dotted: stable again")
    )
    return entries


def _orbit_figure(title: str, found: Found) -> Figure:
    loops, models = _loops_and_models(found)
    figure = Figure(figsize=(1.8 + 4.2 * len(models), 0.9 + 3.6 * len(loops)), layout="constrained")
    panels = figure.subplots(len(loops), len(models), squeeze=False)
    cycles = found["limit_cycles"]
    orbits = [(cycles[item["cycle"]], item) for item in found["orbits"]]
    speeds = sorted({cycle["wind_speed_m_per_s"] for cycle, _ in orbits})
    dark = ListedColormap(mpl.colormaps["viridis_r"](np.linspace(0.15, 1.0, 256)))  # its first yellow is too pale
    colours = ScalarMappable(Normalize(speeds[0], speeds[-1]) if len(speeds) > 1 else Normalize(0.0, 1.0), dark)
    for count, row in zip(loops, panels, strict=True):
        for model, panel in zip(models, row, strict=True):
            mine = [(c, item) for c, item in orbits if (c["model"], c["loops"]) == (model, count)]
            _orbit_panel(panel, mine, colours)
            place = f", at {mine[0][0]['observed_at_m']:.4g} m" if mine else ""
            panel.set_title(f"{_NAMES[model]}, {_loops_name(count)}{place}", fontsize=9.0)
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


def _loops_and_models(found: Found) -> tuple[list[int], list[str]]:
    """Return what the rows hold, at least one of each so that there is a panel."""
    rows = [*found["limit_cycles"], *found["critical_wind_speeds"]]
    loops = sorted({row["loops"] for row in rows}) or [1]
    present = {row["model"] for row in rows}
    return loops, [model for model in _NAMES if model in present] or ["hybrid"]


def _loops_name(count: int) -> str:
    return f"{count} loop{'s' if count > 1 else ''} a span"
