"""Draw what the assumed values mean, as tornadoes: onset and amplitude at both ends of each value's range."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from app.plots.canvas.sheet import Heading, Sheet, columns, empty, layout_width, legend_height, new_sheet, place_legend
from app.plots.canvas.themes import PALETTES, Palette
from app.plots.canvas.wrapping import shortened
from app.plots.facts import Facts, Found, Row
from app.plots.options import Options
from app.plots.parts.paths import words_of

_MOST_BARS = 10
_WIDEST_NAME = 24.0
_SUBTITLE = "What decides: the result at the lowest and the highest value of each assumption, all others as assumed."


@dataclass(frozen=True, slots=True)
class _Quantity:
    """A result that assumptions move: title, axis label, and the columns of both ends and of the share."""

    title: str
    label: str
    lowest: str
    highest: str
    share: str


_QUANTITIES = (
    _Quantity("onset", "wind speed [m/s]", "onset_at_lowest_m_per_s", "onset_at_highest_m_per_s", "onset_total"),
    _Quantity(
        "largest vertical amplitude",
        "amplitude, half of peak to peak [m]",
        "vertical_at_lowest_m",
        "vertical_at_highest_m",
        "amplitude_total",
    ),
)


def picture(found: Found, facts: Facts, options: Options) -> Sheet:
    """Draw a tornado for the onset and one for the largest vertical amplitude, the longest bars on top.

    The table is sensitivities.
    """
    rows = found.get("sensitivities", ())
    ordered = {quantity: _ordered(rows, quantity) for quantity in _QUANTITIES}
    bars = max([len(some[:_MOST_BARS]) for some in ordered.values()] or [1])
    beside = columns(layout_width(options), len(_QUANTITIES), 420.0)
    handles = _legend(PALETTES[options.theme])
    height = (26.0 * max(bars, 3) + 95.0) * (len(_QUANTITIES) // beside) + legend_height(handles, options)
    sheet = new_sheet(Heading(facts.title, _SUBTITLE, (_left_out(rows, ordered), *facts.footer)), options, height)
    panels = sheet.figure.subplots(len(_QUANTITIES) // beside, beside, squeeze=False)
    for panel, quantity in zip(panels.flat, _QUANTITIES, strict=True):
        if ordered[quantity]:
            _tornado(panel, ordered[quantity][:_MOST_BARS], quantity, sheet.palette)
        else:
            empty(panel, "nothing is assumed, or no sample tells what it means", sheet.palette)
        panel.set_title(quantity.title)
    place_legend(sheet, handles)
    return sheet


def _ordered(rows: Sequence[Row], quantity: _Quantity) -> list[Row]:
    """Return the rows that move a quantity, the largest change first."""
    known = [row for row in rows if row[quantity.lowest] is not None and row[quantity.highest] is not None]
    moving = [row for row in known if row[quantity.lowest] != row[quantity.highest]]
    return sorted(moving, key=lambda row: -abs(row[quantity.highest] - row[quantity.lowest]))


def _tornado(panel: Axes, rows: Sequence[Row], quantity: _Quantity, palette: Palette) -> None:
    """Draw a bar between the results at both ends of each value, with a symbol at either."""
    for place, row in enumerate(rows):
        low, high = row[quantity.lowest], row[quantity.highest]
        panel.barh(place, high - low, left=low, height=0.5, color=palette.grid)
        panel.plot([low], [place], "o", color=palette.series[0], markersize=7.0)
        panel.plot([high], [place], "D", color=palette.series[1], markersize=6.0)
        if row[quantity.share] is not None:
            panel.annotate(
                f"{100.0 * row[quantity.share]:.0f} %",
                (max(low, high), place),
                xytext=(8, 0),
                textcoords="offset points",
                va="center",
                fontsize="small",
                color=palette.muted,
            )
    panel.set_yticks(range(len(rows)), [shortened(words_of(row["path"]), _WIDEST_NAME) for row in rows])
    panel.set_ylim(len(rows) - 0.4, -0.6)
    panel.use_sticky_edges = False
    panel.margins(x=0.12)
    panel.set_xlabel(quantity.label)
    panel.grid(visible=True, axis="x", clip_on=False)


def _left_out(rows: Sequence[Row], ordered: Mapping[_Quantity, Sequence[Row]]) -> str:
    """Say what the percentages are, how many values are not shown, and of how many one end is not known."""
    unknown = sum(any(row[q.lowest] is None or row[q.highest] is None for q in _QUANTITIES) for row in rows)
    most = max([len(some) for some in ordered.values()] or [0])
    parts = [
        "percentages: share in the scatter of the samples, alone and together with other values (total Sobol index)"
        if any(row[quantity.share] is not None for quantity, some in ordered.items() for row in some)
        else "",
        f"the {most - _MOST_BARS} values that change least are not shown" if most > _MOST_BARS else "",
        f"values with an end at which onset or amplitude is not known, or does not exist: {unknown}" if unknown else "",
    ]
    said = "; ".join(part for part in parts if part)
    return f"{said[0].upper()}{said[1:]}." if said else ""


def _legend(palette: Palette) -> list[Any]:
    return [
        Line2D([], [], linestyle="none", marker=mark, color=palette.series[number], markersize=7.0, label=label)
        for number, (mark, label) in enumerate(
            (
                ("o", "at the lowest value (of a choice: the lowest result)"),
                ("D", "at the highest value (of a choice: the highest result)"),
            )
        )
    ]
