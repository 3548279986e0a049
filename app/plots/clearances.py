"""Draw the smallest distances between phases, by the motions and by the ellipses of design practice."""

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from app.plots.canvas.sheet import Heading, Sheet, empty, legend_height, new_sheet, place_legend
from app.plots.canvas.themes import PALETTES, Palette
from app.plots.canvas.wrapping import shortened
from app.plots.facts import Facts, Found, Row
from app.plots.options import Options

_METHODS: Mapping[str, tuple[str, str]] = {
    "computed": ("computed motions", "o"),
    "davison": ("ellipse for a single loop (Davison)", "^"),
    "toye": ("ellipse for a double loop (Toye)", "v"),
    "cigre": ("ellipse of CIGRE TB 322", "s"),
    "aeso": ("ellipse of AESO", "D"),
}
_MOST_PAIRS = 14
_SUBTITLE = "Smallest distance of each pair of phases while the line gallops; negative where envelopes overlap."
_WIDEST_NAME = 16.0

Pair = tuple[str, str]


def picture(found: Found, facts: Facts, options: Options) -> Sheet:
    """Draw a row of symbols for each pair of phases, the nearest pair on top, with the required distance.

    The table is clearances, of which stable motions count.
    """
    rows = [row for row in found.get("clearances", ()) if row["distance_m"] is not None and _counts(row)]
    nearest = _nearest(rows)
    pairs = sorted(nearest, key=lambda pair: min(row["distance_m"] for row in nearest[pair].values()))
    shown = pairs[:_MOST_PAIRS]
    handles = _legend(rows, PALETTES[options.theme])
    height = 44.0 * max(len(shown), 2) + 70.0 + legend_height(handles, options)
    names = [name for pair in shown for name in pair]
    sheet = new_sheet(Heading(facts.title, _SUBTITLE, (_left_out(found, pairs), *facts.footer)), options, height, names)
    panel = sheet.figure.subplots()
    if not shown:
        empty(panel, "no other phase is given", sheet.palette)
        return sheet
    for place, pair in enumerate(shown):
        _pair(panel, place, nearest[pair], sheet.palette)
    labels = [
        "\n".join(shortened(sheet.write("this line" if name == "this" else name), _WIDEST_NAME) for name in pair)
        for pair in shown
    ]
    panel.set_yticks(range(len(shown)), labels)
    panel.set_ylim(len(shown) - 0.5, -0.5)
    panel.set_xlabel("smallest distance [m]")
    panel.axvline(0.0, color=sheet.palette.muted, linewidth=0.8)
    panel.grid(visible=True, axis="x", clip_on=False)
    place_legend(sheet, handles)
    return sheet


def _counts(row: Row) -> bool:
    return row["stability"] in {None, "stable"}


def _nearest(rows: Sequence[Row]) -> dict[Pair, dict[str, Row]]:
    """Return the row of the smallest distance by pair of phases and method."""
    found: dict[Pair, dict[str, Row]] = {}
    for row in rows:
        methods = found.setdefault((row["phase"], row["other_phase"]), {})
        if row["method"] not in methods or row["distance_m"] < methods[row["method"]]["distance_m"]:
            methods[row["method"]] = row
    return found


def _pair(panel: Axes, place: int, methods: Mapping[str, Row], palette: Palette) -> None:
    required = next((row["required_m"] for row in methods.values() if row["required_m"] is not None), None)
    if required is not None:
        panel.vlines(required, place - 0.36, place + 0.36, color=palette.text, linewidth=2.0)
    for method, row in methods.items():
        colour = palette.muted if row["ok"] is None else palette.good if row["ok"] else palette.bad
        fill = colour if method == "computed" else "none"
        size = 8.0 if method == "computed" else 6.0
        panel.plot(
            [row["distance_m"]], [place], _METHODS[method][1], color=colour, markerfacecolor=fill, markersize=size
        )


def _left_out(found: Found, pairs: Sequence[Pair]) -> str:
    unknown = sum(row["distance_m"] is None for row in found.get("clearances", ()))
    parts = [
        f"{len(pairs) - _MOST_PAIRS} further pairs are farther apart" if len(pairs) > _MOST_PAIRS else "",
        f"{unknown} distances are not known, such as those of an ellipse that does not exist" if unknown else "",
    ]
    said = "; ".join(part for part in parts if part)
    return f"{said[0].upper()}{said[1:]}." if said else ""


def _legend(rows: Sequence[Row], palette: Palette) -> list[Any]:
    present = {row["method"] for row in rows}
    entries = [
        Line2D([], [], linestyle="none", marker=mark, color=palette.muted, label=label)
        if method == "computed"
        else Line2D([], [], linestyle="none", marker=mark, color=palette.muted, markerfacecolor="none", label=label)
        for method, (label, mark) in _METHODS.items()
        if method in present
    ]
    if any(row["required_m"] is not None for row in rows):
        entries.append(
            Line2D([], [], linestyle="none", marker="|", markersize=12.0, color=palette.text, label="required")
        )
        entries.append(Line2D([], [], linewidth=5.0, color=palette.good, label="far enough"))
        entries.append(Line2D([], [], linewidth=5.0, color=palette.bad, label="too near"))
    return entries
