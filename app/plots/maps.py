"""Draw maps over two fields of the line: critical wind speed, and the largest stable amplitudes at one wind speed."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from app.plots.canvas.sheet import Heading, Sheet, columns, layout_width, new_sheet
from app.plots.canvas.themes import Palette
from app.plots.facts import Facts, Found, Row
from app.plots.options import Options
from app.plots.parts.paths import label_of
from app.plots.parts.rows import HALF, NAMES, loops_and_models, loops_name

_MOST_TICKS = 12
_MOST_WRITTEN = 150
_PANEL_PX = 265.0
_SUBTITLE = "Grey: none found. Cross: the point failed. Panels of one quantity have one scale."

Point = tuple[Any, ...]
Values = Mapping[Point, float]


def map_sheet(found: Found, facts: Facts, options: Options) -> Sheet:
    """Draw a panel for each quantity, model and number of loops over the two fields of a study.

    The first field is on the vertical axis, the second on the horizontal axis; found is the study's result document.
    """
    axes = facts.axes
    loops, models = loops_and_models(found)
    wind = max((row["wind_speed_m_per_s"] for row in found["limit_cycles"]), default=None)
    quantities = list(_quantities(found, axes, wind))
    beside = columns(layout_width(options), len(quantities), 280.0)
    rows = len(loops) * len(models) * len(quantities) // beside
    sheet = new_sheet(Heading(facts.title, f"{_SUBTITLE} {HALF}", facts.footer), options, _PANEL_PX * rows)
    panels = sheet.figure.subplots(rows, beside, squeeze=False)
    ticks = _ticks(axes, found)
    failed = [tuple(row[axis] for axis in axes) for row in found.get("failures", ())]
    places = [(model, count, quantity) for model in models for count in loops for quantity in quantities]
    for panel, (model, count, (name, values)) in zip(panels.flat, places, strict=True):
        panel.set_title(f"{name}\n{NAMES[model]}, {loops_name(count, facts.of_section)}")
        highest = max((value for m in models for c in loops for value in values(m, c).values()), default=1.0)
        _heat(sheet.figure, panel, ticks, (values(model, count), highest), sheet.palette)
        _crosses(panel, ticks, failed, sheet.palette)
        panel.set_xlabel(label_of(axes[1]))
        panel.set_ylabel(label_of(axes[0]))
    return sheet


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
        yield f"vertical amplitude over sag (A_y / s_a), {wind:g} m/s", largest("vertical_ratio")
        yield f"horizontal amplitude over sag (A_z / s_a), {wind:g} m/s", largest("horizontal_ratio")


def _ticks(axes: Sequence[str], found: Found) -> list[list[Any]]:
    """Return the values of each axis in rising order, or in the order of appearance if they are words."""
    rows = [*found["static"], *found.get("failures", ())]
    values = [list(dict.fromkeys(row[axis] for row in rows)) for axis in axes]
    return [sorted(v) if all(isinstance(x, int | float) for x in v) else v for v in values]


def _heat(
    figure: Figure, panel: Axes, ticks: Sequence[Sequence[Any]], shown: tuple[Values, float], palette: Palette
) -> None:
    """Draw the values over both fields, coloured from zero to the highest one of all panels of their quantity."""
    values, highest = shown
    grid = np.array([[values.get((y, x), np.nan) for x in ticks[1]] for y in ticks[0]]).reshape(
        len(ticks[0]), len(ticks[1])
    )
    panel.set_facecolor(palette.grid)
    for axis, of_axis in ((panel.xaxis, ticks[1]), (panel.yaxis, ticks[0])):
        step = max(1, math.ceil(len(of_axis) / _MOST_TICKS))
        axis.set_ticks(range(0, len(of_axis), step), [_text(value) for value in of_axis[::step]])
    panel.tick_params(axis="x", rotation=45)
    panel.set_xlim(-0.5, max(len(ticks[1]), 1) - 0.5)
    panel.set_ylim(-0.5, max(len(ticks[0]), 1) - 0.5)
    if not np.isfinite(grid).any():
        return
    image = panel.pcolormesh(
        _edges(len(ticks[1])), _edges(len(ticks[0])), grid, cmap="viridis", vmin=0.0, vmax=highest or 1.0
    )
    figure.colorbar(image, ax=panel, shrink=0.85)
    if grid.size <= _MOST_WRITTEN:
        _write(panel, grid, highest or 1.0)


def _edges(count: int) -> Any:
    """Return the edges of cells centred at 0, 1, 2, ..."""
    return np.arange(count + 1) - 0.5


def _write(panel: Axes, grid: Any, highest: float) -> None:
    for (y, x), value in np.ndenumerate(grid):
        if np.isfinite(value):
            colour = "black" if value > 0.6 * highest else "white"
            panel.text(x, y, f"{value:.3g}", ha="center", va="center", fontsize=6.0, color=colour)


def _crosses(panel: Axes, ticks: Sequence[Sequence[Any]], failed: Sequence[Point], palette: Palette) -> None:
    for y, x in failed:
        panel.plot(ticks[1].index(x), ticks[0].index(y), marker="x", color=palette.bad, linestyle="none")


def _text(value: Any) -> str:
    return f"{value:g}" if isinstance(value, int | float) else str(value)
