"""Draw the range of tension over the motions, over the wind speed."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from app.plots.canvas.sheet import (
    Heading,
    Sheet,
    columns,
    empty,
    layout_width,
    legend_height,
    new_sheet,
    place_legend,
)
from app.plots.canvas.themes import PALETTES, Palette
from app.plots.facts import Facts, Found, Row
from app.plots.options import Options
from app.plots.parts.rows import NAMES, WIDTHS, loops_name

_PANEL_PX = 250.0
_SUBTITLE = "Tension of a sub-conductor at the higher support: bars from the smallest to the largest in each motion."
_KN = 1e-3


def picture(found: Found, facts: Facts, options: Options) -> Sheet:
    """Draw bars from the smallest to the largest tension, a panel for each number of loops, all to one scale.

    The table is tensions.
    """
    known = [row for row in found.get("tensions", ()) if row["largest_at_support_n"] is not None]
    loops = sorted({row["loops"] for row in known}) or [1]
    beside = columns(layout_width(options), len(loops), 280.0)
    handles = _legend(known, facts, PALETTES[options.theme])
    height = _PANEL_PX * (len(loops) // beside) + 20.0 + legend_height(handles, options)
    sheet = new_sheet(Heading(facts.title, _SUBTITLE, (_slack(found), *facts.footer)), options, height)
    panels = sheet.figure.subplots(len(loops) // beside, beside, squeeze=False, sharex=True, sharey=True)
    for panel, count in zip(panels.flat, loops, strict=True):
        mine = [row for row in known if row["loops"] == count]
        if not mine:
            empty(panel, "no tensions: the analysis neglects stretching, or nothing moves", sheet.palette)
            continue
        _bars(panel, mine, sheet.palette)
        if facts.tension is not None:
            panel.axhline(_KN * facts.tension, color=sheet.palette.muted, linestyle="--", linewidth=1.0)
        panel.set_title(loops_name(count, facts.of_section))
        panel.set_xlabel("wind speed [m/s]")
        panel.set_ylabel("tension [kN]")
        panel.grid(visible=True, clip_on=False)
    place_legend(sheet, handles)
    return sheet


def _bars(panel: Axes, rows: Sequence[Row], palette: Palette) -> None:
    """Draw the bars of both models beside each other; bars of unstable motions are pale."""
    winds = sorted({row["wind_speed_m_per_s"] for row in rows})
    gap = min((later - earlier for earlier, later in pairwise(winds)), default=1.0)
    shifts = {"hybrid": -0.12 * gap, "finite_element": 0.12 * gap}
    for row in rows:
        place = row["wind_speed_m_per_s"] + shifts[row["model"]]
        low, high = _KN * row["smallest_at_support_n"], _KN * row["largest_at_support_n"]
        alpha = 1.0 if row["stability"] == "stable" else 0.35
        width = 2.0 * WIDTHS[row["model"]]
        panel.vlines(place, low, high, color=palette.models[row["model"]], linewidth=width, alpha=alpha)


def _slack(found: Found) -> str:
    unknown = sum(row["largest_at_support_n"] is None for row in found.get("tensions", ()))
    return f"Motions in which a conductor would go slack, without bars: {unknown}." if unknown else ""


def _legend(rows: Sequence[Row], facts: Facts, palette: Palette) -> list[Any]:
    entries = [
        Line2D([], [], color=palette.models[model], linewidth=2.0 * WIDTHS[model], label=NAMES[model])
        for model in NAMES
        if any(row["model"] == model for row in rows)
    ]
    if any(row["stability"] != "stable" for row in rows):
        entries.append(Line2D([], [], color=palette.text, linewidth=4.0, alpha=0.35, label="unstable or not known"))
    if facts.tension is not None:
        entries.append(Line2D([], [], color=palette.muted, linestyle="--", label="horizontal tension at rest"))
    return entries
