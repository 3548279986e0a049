"""Draw maps over two fields of the line: critical wind speed, and the largest stable amplitudes at one wind speed."""

import math
import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from app.plots.drawing import NAMES, Found, Row, loops_and_models, loops_name

_MOST_TICKS = 12
_MOST_WRITTEN = 150
_NOTHING = "#e6e6e6"

Point = tuple[Any, ...]
Values = Mapping[Point, float]


def map_figure(title: str, axes: Sequence[str], found: Found) -> Figure:
    """Draw a row of panels for each model and number of loops; grey means no result, a cross a failed point.

    Parameters
    ----------
    title : str
    axes : sequence of str
        Names of the two fields: the first on the vertical axis, the second on the horizontal axis.
    found : mapping
        The result document of a study over both fields.
    """
    loops, models = loops_and_models(found)
    wind = max((row["wind_speed_m_per_s"] for row in found["limit_cycles"]), default=None)
    quantities = list(_quantities(found, axes, wind))
    figure = Figure(figsize=(1.2 + 3.9 * len(quantities), 1.2 + 3.1 * len(loops) * len(models)), layout="constrained")
    panels = figure.subplots(len(loops) * len(models), len(quantities), squeeze=False)
    ticks = _ticks(axes, found)
    failed = [tuple(row[axis] for axis in axes) for row in found.get("failures", ())]
    places = [(model, count) for model in models for count in loops]
    for (model, count), row in zip(places, panels, strict=True):
        for panel, (name, values) in zip(row, quantities, strict=True):
            panel.set_title(f"{name}\n{NAMES[model]}, {loops_name(count)}", fontsize=9.0)
            _heat(figure, panel, ticks, values(model, count))
            _crosses(panel, ticks, failed)
            panel.set_xlabel(axes[1])
            panel.set_ylabel(axes[0])
    figure.suptitle(textwrap.fill(title, 90), fontweight="bold")
    figure.supxlabel("grey: none found; cross: the point failed", fontsize=8.0)
    return figure


def _quantities(
    found: Found, axes: Sequence[str], wind: float | None
) -> Iterator[tuple[str, Callable[[str, int], Values]]]:
    def at(row: Row) -> Point:
        return tuple(row[axis] for axis in axes)

    def critical(model: str, loops: int) -> Values:
        values: dict[Point, float] = {}
        for row in found["critical_wind_speeds"]:
            if (row["model"], row["loops"], row["crossing"]) == (model, loops, "onset"):
                values[at(row)] = min(values.get(at(row), math.inf), row["wind_speed_m_per_s"])
        return values

    def largest(column: str) -> Callable[[str, int], Values]:
        def amplitude(model: str, loops: int) -> Values:
            values: dict[Point, float] = {}
            for row in found["limit_cycles"]:
                here = (row["model"], row["loops"], row["wind_speed_m_per_s"]) == (model, loops, wind)
                if here and row["stability"] == "stable" and row[column] is not None:
                    values[at(row)] = max(values.get(at(row), 0.0), row[column])
            return values

        return amplitude

    yield "critical wind speed [m/s]", critical
    if wind is not None:
        yield f"vertical A_y / s_a at {wind:g} m/s", largest("vertical_ratio")
        yield f"horizontal A_z / s_a at {wind:g} m/s", largest("horizontal_ratio")


def _ticks(axes: Sequence[str], found: Found) -> list[list[Any]]:
    """Return the values of each axis in rising order, or in the order of appearance if they are words."""
    rows = [*found["static"], *found.get("failures", ())]
    values = [list(dict.fromkeys(row[axis] for row in rows)) for axis in axes]
    return [sorted(v) if all(isinstance(x, int | float) for x in v) else v for v in values]


def _heat(figure: Figure, panel: Axes, ticks: Sequence[Sequence[Any]], values: Values) -> None:
    grid = np.array([[values.get((y, x), np.nan) for x in ticks[1]] for y in ticks[0]]).reshape(
        len(ticks[0]), len(ticks[1])
    )
    panel.set_facecolor(_NOTHING)
    for axis, of_axis in ((panel.xaxis, ticks[1]), (panel.yaxis, ticks[0])):
        step = max(1, math.ceil(len(of_axis) / _MOST_TICKS))
        axis.set_ticks(range(0, len(of_axis), step), [_text(value) for value in of_axis[::step]])
    panel.tick_params(axis="x", rotation=45)
    panel.set_xlim(-0.5, max(len(ticks[1]), 1) - 0.5)
    panel.set_ylim(-0.5, max(len(ticks[0]), 1) - 0.5)
    if not np.isfinite(grid).any():
        return
    image = panel.pcolormesh(_edges(len(ticks[1])), _edges(len(ticks[0])), grid, cmap="viridis", vmin=0.0)
    figure.colorbar(image, ax=panel, shrink=0.85)
    if grid.size <= _MOST_WRITTEN:
        _write(panel, grid)


def _edges(count: int) -> Any:
    """Return the edges of cells centred at 0, 1, 2, ..."""
    return np.arange(count + 1) - 0.5


def _write(panel: Axes, grid: Any) -> None:
    highest = np.nanmax(grid) or 1.0
    for (y, x), value in np.ndenumerate(grid):
        if np.isfinite(value):
            colour = "black" if value > 0.6 * highest else "white"
            panel.text(x, y, f"{value:.3g}", ha="center", va="center", fontsize=6.0, color=colour)


def _crosses(panel: Axes, ticks: Sequence[Sequence[Any]], failed: Sequence[Point]) -> None:
    for y, x in failed:
        panel.plot(ticks[1].index(x), ticks[0].index(y), marker="x", color=mpl.colormaps["Reds"](0.9), linestyle="none")


def _text(value: Any) -> str:
    return f"{value:g}" if isinstance(value, int | float) else str(value)
