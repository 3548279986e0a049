"""Draw amplitudes over wind speed: whole branches from the onset on, with the winds asked for as symbols."""

import math
from collections.abc import Iterator, Mapping, Sequence, Set
from typing import Any, Literal

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from app.plots.canvas.sheet import (
    Heading,
    Sheet,
    columns,
    layout_width,
    legend_height,
    new_sheet,
    place_legend,
)
from app.plots.canvas.themes import PALETTES, Palette
from app.plots.facts import Facts, Found, Row
from app.plots.options import Options
from app.plots.parts.branches import Mark, Stretch, marks, stretches
from app.plots.parts.rows import HALF, MARKERS, NAMES, ORDER, SIZES, WIDTHS, loops_and_models, loops_name

QUANTITIES: Sequence[tuple[str, str, str, float]] = (
    ("vertical_m", "vertical", "m", 1.0),
    ("horizontal_m", "horizontal", "m", 1.0),
    ("torsional_rad", "torsional", "\u00b0", 180.0 / math.pi),
)
_Dashes = Literal["-"] | tuple[float, Sequence[float]]
_STYLES: Mapping[str, _Dashes] = {
    "stable": "-",
    "unstable": (0.0, (4.0, 2.0)),
    "unknown": (0.0, (1.0, 1.5)),
}
_MARKS = {
    "hopf": ("Hopf point", "|"),
    "fold": ("fold", "<"),
    "torus": ("torus point", "D"),
    "period_doubling": ("period doubling", "^"),
    "branch_point": ("branch point", "P"),
    "unresolved": ("stability changes, cause not found", "X"),
}
_WIND = "wind_speed_m_per_s"
_PANEL_PX = 205.0
_MANY_WINDS = 15


def picture(found: Found, facts: Facts, options: Options) -> Sheet:
    """Draw a panel for each direction and number of loops; panels of one direction have one scale.

    The tables are amplitude_curves, bifurcations, limit_cycles and critical_wind_speeds.
    """
    loops, models = loops_and_models(found)
    lines, points = list(stretches(found)), marks(found)
    beside = columns(layout_width(options), len(QUANTITIES), 230.0)
    rows = len(loops) * len(QUANTITIES) // beside
    handles = list(_legend(found, models, lines, points, options))
    height = _PANEL_PX * rows + 20.0 + legend_height(handles, options)
    sheet = new_sheet(
        Heading(facts.title, _subtitle(found), (_short(found), _beyond(found, facts.of_section), *facts.footer)),
        options,
        height,
    )
    panels = sheet.figure.subplots(rows, beside, squeeze=False, sharex=True)
    places = [(count, quantity) for count in loops for quantity in QUANTITIES]
    for panel, (count, quantity) in zip(panels.flat, places, strict=True):
        _panel(panel, sheet.palette, found, (count, models), quantity)
        for stretch in lines:
            if stretch.key[1] == count and stretch.points[0][_WIND] <= reach(found):
                _curve(panel, sheet.palette, stretch, quantity)
        for mark in points:
            if mark.row["loops"] == count and mark.row[_WIND] <= reach(found):
                _mark(panel, sheet.palette, mark, quantity)
        panel.set_title(f"{quantity[1]}, {loops_name(count, facts.of_section)}")
        panel.set_ylabel(f"amplitude [{quantity[2]}]")
        panel.grid(visible=True, clip_on=False)
    _one_scale(panels, places)
    for panel in panels[-1]:
        panel.set_xlabel("wind speed [m/s]")
    place_legend(sheet, handles)
    return sheet


def _subtitle(found: Found) -> str:
    if found.get("amplitude_curves"):
        return f"Amplitudes over wind speed: whole branches, symbols at the wind speeds asked for. {HALF}"
    return f"Amplitudes over wind speed, joined between the wind speeds asked for. {HALF}"


def _short(found: Found) -> str:
    """Say how to get what the picture lacks where the analysis asked for no branches."""
    lacks = found.get("critical_wind_speeds") and not found.get("amplitude_curves")
    return 'Whole branches from the onset on: "amplitude_curves": "reported" in the analysis.' if lacks else ""


def reach(found: Found) -> float:
    """Return the highest wind speed that the picture shows [m/s]; without motions all critical ones are shown.

    It is a tenth beyond the winds asked for and the branches that have a motion at one of them.
    """
    motions = [row for row in found.get("limit_cycles", ()) if row.get("kind") != "equilibrium" and row["vertical_m"]]
    branches = {(row["model"], row["loops"], row["branch"]) for row in motions}
    curves = [
        row
        for row in found.get("amplitude_curves", ())
        if row["vertical_m"] and (not branches or (row["model"], row["loops"], row["branch"]) in branches)
    ]
    if not motions and not curves:
        return math.inf
    return 1.1 * max(float(row[_WIND]) for row in (*found.get("limit_cycles", ()), *curves))


def _beyond(found: Found, of_section: bool) -> str:
    """Say which critical wind speeds are beyond the picture."""
    farther = [row for row in found.get("critical_wind_speeds", ()) if row[_WIND] > reach(found)]
    words = {"onset": "onset", "restabilization": "stable again"}
    named = [
        f"{words[row['crossing']]} at {row[_WIND]:.3g} m/s ({NAMES[row['model']]}, "
        f"{loops_name(row['loops'], of_section)})"
        for row in farther
    ]
    return f"Beyond the picture: {'; '.join(named)}." if named else ""


def _panel(
    panel: Axes, palette: Palette, found: Found, shown: tuple[int, Sequence[str]], quantity: tuple[str, str, str, float]
) -> None:
    """Draw the critical wind speeds, the motions at the winds asked for, and the bands of quasi-periodic ones."""
    count, models = shown
    cycles = [row for row in found.get("limit_cycles", ()) if row["loops"] == count]
    for row in found.get("critical_wind_speeds", ()):
        if row["loops"] == count and row[_WIND] <= reach(found):
            style = "--" if row["crossing"] == "onset" else ":"
            colour = palette.models[row["model"]]
            panel.axvline(row[_WIND], color=colour, linestyle=style, linewidth=0.9, alpha=0.8)
    small = 0.55 if len({row[_WIND] for row in cycles}) > _MANY_WINDS else 1.0
    for model in models:
        mine = [row for row in cycles if row["model"] == model and row[quantity[0]] is not None]
        _symbols(panel, palette, mine, quantity, small)
        _bands(panel, palette.models[model], [row for row in mine if row.get("kind") == "quasi_periodic"], quantity)


def _symbols(
    panel: Axes, palette: Palette, cycles: Sequence[Row], quantity: tuple[str, str, str, float], small: float
) -> None:
    column, _, _, factor = quantity
    for stability in ("unstable", "unknown", "stable"):
        here = [row for row in cycles if row["stability"] == stability]
        for model in dict.fromkeys(row["model"] for row in here):
            panel.plot(
                [row[_WIND] for row in here],
                [row[column] * factor for row in here],
                linestyle="none",
                marker=MARKERS[model],
                markersize=SIZES[model] * small,
                color=palette.models[model],
                markerfacecolor=face(palette, model, stability),
                markeredgewidth=1.0,
                clip_on=False,
                zorder=ORDER[model] + 4,
            )


def face(palette: Palette, model: str, stability: str) -> str:
    """Return a symbol's fill: coloured if stable, hollow if unstable, grey if unknown."""
    return {"stable": palette.models[model], "unstable": palette.background}.get(stability, palette.unknown)


def _bands(panel: Axes, colour: str, tori: Sequence[Row], quantity: tuple[str, str, str, float]) -> None:
    """Draw quasi-periodic motions as bars between their smallest and largest amplitude, joined to bands by branch."""
    column, direction, _, factor = quantity
    lower = f"{direction}_min_{column.rpartition('_')[2]}"
    branches: dict[Any, list[Row]] = {}
    for row in sorted(tori, key=lambda row: float(row[_WIND])):
        if row.get(lower) is not None:
            branches.setdefault((row["branch"], row["stability"]), []).append(row)
    for rows in branches.values():
        winds = [row[_WIND] for row in rows]
        low, high = ([row[name] * factor for row in rows] for name in (lower, column))
        panel.vlines(winds, low, high, color=colour, linewidth=3.5, alpha=0.45, zorder=3)
        if len(set(winds)) == len(winds):
            panel.fill_between(winds, low, high, color=colour, alpha=0.18, linewidth=0.0, zorder=2)


def _curve(panel: Axes, palette: Palette, stretch: Stretch, quantity: tuple[str, str, str, float]) -> None:
    model = stretch.key[0]
    panel.plot(
        [row[_WIND] for row in stretch.points],
        [row[quantity[0]] * quantity[3] for row in stretch.points],
        linestyle=_STYLES.get(stretch.stability, _STYLES["unknown"]),
        linewidth=(WIDTHS[model] if stretch.whole else 0.5 * WIDTHS[model]) * 0.75,
        color=palette.models[model],
        alpha=0.6 if model == "hybrid" else 1.0,
        zorder=ORDER[model],
    )


def _mark(panel: Axes, palette: Palette, mark: Mark, quantity: tuple[str, str, str, float]) -> None:
    """Mark a bifurcation on its branch; at the upper edge where its amplitude is not known."""
    symbol = _MARKS[mark.row["type"]][1]
    known = mark.point is not None
    panel.plot(
        [mark.row[_WIND]],
        [mark.point[quantity[0]] * quantity[3] if mark.point is not None else 1.0],
        linestyle="none",
        marker=symbol,
        markersize=9.0 if symbol == "|" else 6.0,
        color=palette.models[mark.row["model"]],
        markerfacecolor=palette.background,
        markeredgewidth=1.4,
        clip_on=False,
        zorder=12,
        transform=panel.transData if known else panel.get_xaxis_transform(),
    )


def _one_scale(panels: Any, places: Sequence[tuple[int, tuple[str, str, str, float]]]) -> None:
    """Give all panels of one direction the same scale, which begins at zero."""
    highest: dict[str, float] = {}
    for panel, (_, quantity) in zip(panels.flat, places, strict=True):
        highest[quantity[0]] = max(highest.get(quantity[0], 0.0), panel.get_ylim()[1])
    for panel, (_, quantity) in zip(panels.flat, places, strict=True):
        panel.set_ylim(0.0, highest[quantity[0]])


def _legend(
    found: Found, models: Sequence[str], lines: Sequence[Stretch], points: Sequence[Mark], options: Options
) -> Iterator[Line2D | Patch]:
    palette = PALETTES[options.theme]
    for model in models:
        yield Line2D(
            [],
            [],
            linewidth=0.75 * WIDTHS[model],
            marker=MARKERS[model],
            markersize=SIZES[model],
            color=palette.models[model],
            label=NAMES[model],
        )
    rows = found.get("limit_cycles", ())
    yield from _stabilities({row["stability"] for row in rows} | {stretch.stability for stretch in lines}, options)
    crossings = {row["crossing"] for row in found.get("critical_wind_speeds", ())}
    if "onset" in crossings:
        yield Line2D([], [], color=palette.muted, linestyle="--", linewidth=1.0, label="onset")
    if "restabilization" in crossings:
        yield Line2D([], [], color=palette.muted, linestyle=":", linewidth=1.0, label="at rest stable again")
    shown = {mark.row["type"] for mark in points if mark.row[_WIND] <= reach(found)}
    for kind in [kind for kind in _MARKS if kind in shown]:
        label, symbol = _MARKS[kind]
        yield Line2D(
            [], [], linestyle="none", marker=symbol, color=palette.text, markerfacecolor=palette.background, label=label
        )
    if any(row.get("kind") == "quasi_periodic" for row in rows):
        yield Patch(color=palette.text, alpha=0.3, label="quasi-periodic, smallest to largest amplitude")


def _stabilities(present: Set[str], options: Options) -> Iterator[Line2D]:
    palette = PALETTES[options.theme]
    words = {"stable": "stable (filled)", "unstable": "unstable (hollow)", "unknown": "stability not known (grey)"}
    for stability, label in words.items():
        if stability in present:
            fill = {"stable": palette.text, "unstable": palette.background}.get(stability, palette.unknown)
            yield Line2D(
                [],
                [],
                color=palette.text,
                linestyle=_STYLES[stability],
                marker="o",
                markersize=5.0,
                markerfacecolor=fill,
                label=label,
            )
