"""Draw what the samples say over the wind speed: the probability of galloping, and amplitudes as bands."""

import math
from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from app.plots.canvas.sheet import Heading, Sheet, columns, empty, layout_width, legend_height, new_sheet, place_legend
from app.plots.canvas.themes import PALETTES, Palette
from app.plots.facts import Facts, Found, Row
from app.plots.options import Options
from app.plots.parts.rows import HALF

_PANEL_PX = 235.0
_WIND = "wind_speed_m_per_s"
_SIZES = (("vertical", "m", 1.0), ("horizontal", "m", 1.0), ("torsional", "rad", 180.0 / math.pi))
_SHOWN_UNIT = {"m": "m", "rad": "\u00b0"}


def picture(found: Found, facts: Facts, options: Options) -> Sheet:
    """Draw a panel for the probability, with the onset's quantiles, and one for each direction.

    The table is uncertainty.
    """
    rows = sorted((row for row in found.get("uncertainty", ()) if row[_WIND] is not None), key=lambda row: row[_WIND])
    whole = next((row for row in found.get("uncertainty", ()) if row[_WIND] is None), None)
    beside = columns(layout_width(options), 4, 320.0)
    handles = _legend(PALETTES[options.theme])
    height = _PANEL_PX * (4 // beside) + 20.0 + legend_height(handles, options)
    sheet = new_sheet(Heading(facts.title, _subtitle(whole), (_unknown(rows), *facts.footer)), options, height)
    panels = sheet.figure.subplots(4 // beside, beside, squeeze=False, sharex=True)
    first, *others = panels.flat
    for panel in panels.flat:
        if not rows:
            empty(panel, "no samples: nothing is assumed, or none were asked for", sheet.palette)
    if rows:
        _probability(first, rows, whole, sheet.palette)
        for panel, (direction, unit, factor) in zip(others, _SIZES, strict=True):
            _band(panel, rows, f"{direction}_{{}}_{unit}", factor, sheet.palette)
            panel.set_title(f"largest {direction} amplitude")
            panel.set_ylabel(f"amplitude [{_SHOWN_UNIT[unit]}]")
        for panel in panels[-1]:
            panel.set_xlabel("wind speed [m/s]")
    place_legend(sheet, handles)
    return sheet


def _subtitle(whole: Row | None) -> str:
    samples = f"{whole['samples']} samples" if whole else "samples"
    return f"How {samples} of the assumed values behave, hybrid model. {HALF}"


def _probability(panel: Axes, rows: Sequence[Row], whole: Row | None, palette: Palette) -> None:
    winds, colour = [row[_WIND] for row in rows], palette.models["hybrid"]
    low, high = ([row[f"probability_{end}"] for row in rows] for end in ("lowest", "highest"))
    panel.fill_between(winds, low, high, color=colour, alpha=0.2, linewidth=0.0)
    middle = [math.nan if row["probability"] is None else row["probability"] for row in rows]
    panel.plot(winds, middle, color=colour, marker="o", markersize=4.0)
    if len(rows) == 1:
        panel.vlines(winds, low, high, color=colour, linewidth=5.0, alpha=0.35)
    if whole is not None and whole["onset_p50_m_per_s"] is not None:
        panel.axvline(whole["onset_p50_m_per_s"], color=palette.accent, linestyle="--", linewidth=1.2)
        early = whole["onset_p05_m_per_s"]
        late = whole["onset_p95_m_per_s"]
        if early is not None:  # a late end that does not exist is beyond every wind speed
            end = late if late is not None else max(*winds, early)
            panel.axvspan(early, end, color=palette.accent, alpha=0.1, linewidth=0.0)
    panel.set_ylim(0.0, 1.02)
    panel.set_title("galloping")
    panel.set_ylabel("probability")
    panel.grid(visible=True, clip_on=False)


def _band(panel: Axes, rows: Sequence[Row], column: str, factor: float, palette: Palette) -> None:
    """Draw the 5, 50 and 95 % quantiles; an unknown one is larger than any number, so the band is open above."""
    winds, colour = [row[_WIND] for row in rows], palette.models["hybrid"]
    low, middle, high = (
        [math.nan if row[column.format(p)] is None else row[column.format(p)] * factor for row in rows]
        for p in ("p05", "p50", "p95")
    )
    panel.fill_between(winds, low, high, color=colour, alpha=0.2, linewidth=0.0)
    for values, style in ((low, ":"), (middle, "-"), (high, ":")):
        panel.plot(winds, values, style, color=colour, marker="o" if style == "-" else "none", markersize=4.0)
    if len(rows) == 1:
        panel.vlines(winds, low, high, color=colour, linewidth=5.0, alpha=0.35)
    panel.set_ylim(bottom=0.0)
    panel.grid(visible=True, clip_on=False)


def _unknown(rows: Sequence[Row]) -> str:
    columns_ = [f"{direction}_p95_{unit}" for direction, unit, _ in _SIZES]
    winds = [f"{row[_WIND]:g}" for row in rows if any(row[name] is None for name in columns_)]
    if not winds:
        return ""
    why = "Without an upper end, since more than 5 % of the samples gallop and how far is not known"
    return f"{why}: {', '.join(winds)} m/s."


def _legend(palette: Palette) -> list[Any]:
    colour = palette.models["hybrid"]
    return [
        Line2D([], [], color=colour, marker="o", markersize=4.0, label="share of the samples; median"),
        Patch(color=colour, alpha=0.2, label="95 % interval of the share; 5 to 95 % of the samples"),
        Line2D([], [], color=palette.accent, linestyle="--", label="median of the onset"),
        Patch(color=palette.accent, alpha=0.1, label="onset of 5 to 95 % of the samples"),
    ]
