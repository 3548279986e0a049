"""Draw amplitudes over wind speed."""

import math
import textwrap
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from app.plots.drawing import (
    COLOURS,
    MARKERS,
    NAMES,
    SIZES,
    Extension,
    Found,
    Row,
    drawn,
    face,
    loops_and_models,
    loops_name,
)

_QUANTITIES: Sequence[tuple[str, str, float]] = (
    ("vertical_m", "vertical amplitude [m]", 1.0),
    ("horizontal_m", "horizontal amplitude [m]", 1.0),
    ("torsional_rad", "torsional amplitude [deg]", 180.0 / math.pi),
)


def amplitude(title: str, found: Found, extension: Extension) -> bytes:
    """Draw amplitudes over wind speed, a row of panels for each number of loops.

    Parameters
    ----------
    title : str
        Title of the picture, usually the line's name.
    found : mapping
        Rows of `limit_cycles` and `critical_wind_speeds`.
    extension : {"svg", "png"}
        Format of the picture.
    """
    return drawn(lambda: _amplitude_figure(title, found), extension)


def _amplitude_figure(title: str, found: Found) -> Figure:
    loops, models = loops_and_models(found)
    figure = Figure(figsize=(10.5, 1.3 + 2.5 * len(loops)), layout="constrained")
    panels = figure.subplots(len(loops), len(_QUANTITIES), squeeze=False, sharex=True)
    for count, row in zip(loops, panels, strict=True):
        cycles = [cycle for cycle in found["limit_cycles"] if cycle["loops"] == count]
        critical = [speed for speed in found["critical_wind_speeds"] if speed["loops"] == count]
        for panel, (column, label, factor) in zip(row, _QUANTITIES, strict=True):
            _critical_lines(panel, critical, cycles)
            for model in models:
                _cycle_markers(panel, [c for c in cycles if c["model"] == model], column, factor)
            panel.set_ylabel(f"{label}\n{loops_name(count)}" if column == "vertical_m" else label)
            panel.set_ylim(bottom=0.0)
            panel.grid(visible=True, alpha=0.25)
    for panel in panels[-1]:
        panel.set_xlabel("wind speed [m/s]")
    figure.suptitle(textwrap.fill(title, 90), fontweight="bold")
    figure.legend(handles=_amplitude_legend(models), loc="outside lower center", ncols=3, frameon=False)
    return figure


def _cycle_markers(panel: Axes, cycles: Sequence[Row], column: str, factor: float) -> None:
    for (model, branch, stability, _), group in _groups(cycles, column).items():
        speeds = [cycle["wind_speed_m_per_s"] for cycle in group]
        joined = branch is not None and len(set(speeds)) == len(speeds)  # at a fold a joined line would zigzag
        panel.plot(
            speeds,
            [cycle[column] * factor for cycle in group],
            linestyle="-" if joined else "none",
            linewidth=0.8,
            marker=MARKERS[model],
            markersize=SIZES[model],
            color=COLOURS[model],
            markerfacecolor=face(model, stability),
            markeredgewidth=1.1,
            clip_on=False,
            zorder=4 if model == "hybrid" else 5,
        )


def _groups(cycles: Sequence[Row], column: str) -> dict[tuple[str, int | None, str, str | None], list[Row]]:
    groups: dict[tuple[str, int | None, str, str | None], list[Row]] = {}
    for cycle in sorted(cycles, key=lambda cycle: cycle["wind_speed_m_per_s"]):
        if cycle[column] is not None:
            own = (cycle["model"], cycle["branch"], cycle["stability"], cycle.get("kind"))
            groups.setdefault(own, []).append(cycle)
    return groups


def _critical_lines(panel: Axes, critical: Sequence[Row], cycles: Sequence[Row]) -> None:
    """Mark the critical speeds within the range of wind speeds shown, or all of them if there are no cycles."""
    reach = 1.15 * max((cycle["wind_speed_m_per_s"] for cycle in cycles), default=math.inf)
    for row in critical:
        if row["wind_speed_m_per_s"] <= reach:
            style = "--" if row["crossing"] == "onset" else ":"
            panel.axvline(row["wind_speed_m_per_s"], color=COLOURS[row["model"]], linestyle=style, linewidth=1.0)


def _amplitude_legend(models: Sequence[str]) -> list[Line2D]:
    def marker(model: str, stability: str) -> Line2D:
        return Line2D(
            [],
            [],
            linestyle="none",
            marker=MARKERS[model],
            markersize=SIZES[model],
            color=COLOURS[model],
            markerfacecolor=face(model, stability),
            label=f"{NAMES[model]}, {stability}",
        )

    entries = [marker(model, stability) for model in models for stability in ("stable", "unstable")]
    entries.append(
        Line2D([], [], color="grey", linestyle="--", linewidth=1.0, label="critical wind speed, dotted: stable again")
    )
    return entries
