"""Draw the hours of galloping to expect in a year, with their intervals."""

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from app.plots.canvas.sheet import Heading, Sheet, empty, legend_height, new_sheet, place_legend
from app.plots.canvas.themes import PALETTES, Palette
from app.plots.facts import Facts, Found, Row
from app.plots.options import Options
from app.plots.parts.rows import MARKERS, NAMES, loops_name

_SUBTITLE = "Hours of galloping to expect in a year, in the climate of the line; bars are their intervals."
_MOST_ROWS = 24


def picture(found: Found, facts: Facts, options: Options) -> Sheet:
    """Draw a row for each kind of ice and number of loops, with the probability of a year with galloping beside it.

    The table is risk.
    """
    rows = list(found.get("risk", ()))
    shown = rows[:_MOST_ROWS]
    handles = _legend(shown, PALETTES[options.theme])
    height = 30.0 * max(len(shown), 3) + 70.0 + legend_height(handles, options)
    left_out = (
        f"{len(rows) - len(shown)} further rows of the table risk are not shown." if len(rows) > len(shown) else ""
    )
    sheet = new_sheet(Heading(facts.title, _SUBTITLE, (left_out, *facts.footer)), options, height)
    panel = sheet.figure.subplots()
    if not shown:
        empty(panel, "the line has no climate", sheet.palette)
        return sheet
    for place, row in enumerate(shown):
        _row(panel, place, row, sheet.palette)
    panel.set_yticks(range(len(shown)), [_name(row, of_section=facts.of_section) for row in shown])
    panel.set_ylim(len(shown) - 0.5, -0.5)
    panel.set_xlim(left=0.0)
    panel.margins(x=0.25)
    panel.set_xlabel("galloping [h a year]")
    panel.grid(visible=True, axis="x", clip_on=False)
    place_legend(sheet, handles)
    return sheet


def _row(panel: Axes, place: int, row: Row, palette: Palette) -> None:
    colour = palette.models[row["model"]]
    panel.hlines(place, row["hours_lowest"], row["hours_highest"], color=colour, linewidth=4.0, alpha=0.4)
    panel.plot([row["hours_a_year"]], [place], MARKERS[row["model"]], color=colour, markersize=6.0)
    if row["probability_a_year"] is not None:
        low, high = row["probability_lowest"], row["probability_highest"]
        interval = f" ({low:.2f} to {high:.2f})" if low is not None and high is not None else ""
        panel.annotate(
            f"probability {row['probability_a_year']:.2f}{interval}",
            (row["hours_highest"], place),
            xytext=(6, 0),
            textcoords="offset points",
            va="center",
            fontsize="small",
            color=palette.muted,
        )


def _name(row: Row, *, of_section: bool) -> str:
    ice = "any ice" if row["ice"] is None else row["ice"].replace("_", " ")
    thickness = f" {1e3 * row['thickness_m']:g} mm" if row["thickness_m"] else ""
    loops = "any loops" if row["loops"] is None else loops_name(row["loops"], of_section)
    return f"{ice}{thickness}, {loops}"


def _legend(rows: Sequence[Row], palette: Palette) -> list[Any]:
    return [
        Line2D([], [], color=palette.models[model], marker=MARKERS[model], linewidth=4.0, alpha=0.7, label=NAMES[model])
        for model in NAMES
        if any(row["model"] == model for row in rows)
    ]
