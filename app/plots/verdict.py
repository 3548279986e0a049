"""Draw the verdict: the sentence, the span with its worst motion, and the cross-section with what it may touch."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from app.plots.canvas.sheet import (
    PT_PER_PX,
    Heading,
    Sheet,
    columns,
    layout_width,
    legend_height,
    new_sheet,
    place_legend,
)
from app.plots.canvas.themes import PALETTES, Palette
from app.plots.canvas.wrapping import wrapped
from app.plots.facts import Facts, Found, Row
from app.plots.options import Options
from app.plots.parts.rows import Path, loops_name, motion, orbits_of
from app.plots.parts.surroundings import bounds_of, draw_surroundings, surroundings_legend

_WORDS: Mapping[str, str] = {"yes": "Gallops", "no": "Does not gallop", "undecided": "Not decided"}
_TRUST: Mapping[str, str] = {
    "checked": "held against direct integration",
    "plausible": "plausible",
    "beyond_data": "beyond what the input can vouch for",
}
_MAGNIFIED = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
_PANEL_PX = 300.0
_SENTENCE_PX = 17.0
_POINTS = 121
_MOST_LINES = 12  # more than a sentence takes in the narrowest picture


def picture(found: Found, facts: Facts, options: Options) -> Sheet:
    """Draw the worst motion of the verdict: from the side over the whole span, and in the cross-section to scale.

    The tables are verdict, limit_cycles and clearances, and orbits.
    """
    row = next(iter(found.get("verdict", ())), None)
    worst = _worst(found, row)
    palette = PALETTES[options.theme]
    beside = columns(layout_width(options), 2, 330.0)
    handles = list(_legend(facts, worst, palette))
    sentence = wrapped(_sentence(row), (layout_width(options) - 60.0) / _SENTENCE_PX, _MOST_LINES)
    spoken = 1.4 * _SENTENCE_PX * len(sentence) + 22.0
    height = spoken + _PANEL_PX * (2 // beside) + legend_height(handles, options)
    names = [phase.name for phase in facts.phases]
    sheet = new_sheet(Heading(facts.title, _subtitle(row), facts.footer), options, height, names)
    _say(sheet, sentence, row)
    sheet = replace(sheet, above=sheet.above + spoken)
    grid = sheet.figure.add_gridspec(2 // beside, beside, width_ratios=[1.7, 1.0] if beside == 2 else None)
    _side(sheet.figure.add_subplot(grid[0, 0]), worst, facts, sheet)
    _section(sheet.figure.add_subplot(grid[-1, -1]), worst, found, facts, sheet)
    place_legend(sheet, handles)
    return sheet


def _sentence(row: Row | None) -> str:
    return str(row["sentence"]) if row else "There is no verdict: nothing was computed."


def _subtitle(row: Row | None) -> str:
    if row is None:
        return "Verdict"
    chance = row["probability_gallops"]
    parts = [
        _WORDS[row["gallops"]],
        f"probability {chance:.2f} over the samples of what is assumed" if chance is not None else "",
        f"trust: {_TRUST[row['trust']]}",
    ]
    return f"Verdict: {'; '.join(part for part in parts if part)}. The cross-section is to scale."


def _say(sheet: Sheet, sentence: Sequence[str], row: Row | None) -> None:
    """Write the sentence below the heading, with a bar of the colour of the answer at its left."""
    gallops = row["gallops"] if row else "undecided"
    colours = {"yes": sheet.palette.bad, "no": sheet.palette.good}
    line = 1.4 * _SENTENCE_PX
    for number, text in enumerate(sentence):
        down = sheet.above + 6.0 + line * number
        sheet.figure.text(
            26.0 / sheet.width, 1.0 - down / sheet.height, text, va="top", fontsize=_SENTENCE_PX * PT_PER_PX
        ).set_in_layout(False)
    top, bottom = sheet.above + 4.0, sheet.above + 4.0 + line * len(sentence)
    bar = Rectangle(
        (12.0 / sheet.width, 1.0 - bottom / sheet.height),
        5.0 / sheet.width,
        (bottom - top) / sheet.height,
        transform=sheet.figure.transFigure,
        color=colours.get(gallops, sheet.palette.muted),
        linewidth=0.0,
    )
    bar.set_in_layout(False)
    sheet.figure.add_artist(bar)


def _worst(found: Found, row: Row | None) -> tuple[Row, Row | None] | None:
    """Return the worst motion of the verdict with its orbit, None if nothing moves or how far is not known."""
    if row is None or row["vertical_peak_to_peak_m"] is None:
        return None
    orbits = {id(cycle): item for cycle, item in orbits_of(found)}
    alike = [
        cycle
        for cycle in found.get("limit_cycles", ())
        if cycle["stability"] == "stable"
        and cycle["vertical_m"]
        and cycle["loops"] == row["worst_loops"]
        and cycle["wind_speed_m_per_s"] == row["worst_wind_m_per_s"]
    ]
    if not alike:
        return None
    cycle = max(alike, key=lambda cycle: float(cycle["vertical_m"]))
    return cycle, orbits.get(id(cycle))


def _side(panel: Axes, worst: tuple[Row, Row | None] | None, facts: Facts, sheet: Sheet) -> None:
    """Draw the span from the side; heights are magnified, alike for sag, motion and phases, and the title says how."""
    palette = sheet.palette
    length = facts.length or 1.0
    x = np.linspace(0.0, length, _POINTS)
    rest = _rest(x, facts)
    panel.plot(x, rest, color=palette.text, linewidth=1.6)
    for phase in facts.phases:
        panel.plot(x, rest + phase.up, color=palette.bad, linewidth=1.0)
    if worst is not None and not facts.of_section:
        cycle = worst[0]
        reach = cycle["vertical_m"] * np.abs(np.sin(cycle["loops"] * math.pi * x / length))
        colour = palette.models[cycle["model"]]
        panel.fill_between(x, rest - reach, rest + reach, color=colour, alpha=0.3, linewidth=0.0)
    for place, height in ((0.0, rest[0]), (length, rest[-1])):
        panel.plot([place], [height], marker="^", color=palette.muted, markersize=7.0, clip_on=False)
    panel.set_xlim(0.0, length)
    magnified = _magnify(panel, length, sheet)
    panel.set_title("span from the side" + (f", heights {magnified:g} times larger" if magnified > 1.0 else ""))
    panel.set_xlabel("distance from the left support [m]")
    panel.set_ylabel("height [m]")
    panel.grid(visible=True, clip_on=False)
    if worst is None:
        note = "no lasting motion of known size"
        panel.text(0.5, 0.92, note, transform=panel.transAxes, ha="center", color=palette.muted)


def _rest(x: Path, facts: Facts) -> Path:
    """Return the height of the wire at rest over the left support: a parabola below the chord [m]."""
    length, sag = facts.length or 1.0, facts.sag or 0.0
    share = x / length
    return np.asarray(facts.level_difference * share - 4.0 * sag * share * (1.0 - share))


def _magnify(panel: Axes, length: float, sheet: Sheet) -> float:
    """Set limits of the height so that it is shown a round number of times larger, and return that."""
    low, high = panel.get_ylim()
    shape = _PANEL_PX * 0.72 / (0.52 * sheet.width)  # of the panel, about
    wanted = length * shape / max(high - low, 1e-6)
    magnified = max(m for m in _MAGNIFIED if m <= max(wanted, 1.0))
    half = max(0.5 * length * shape / magnified, 0.5 * (high - low))
    middle = 0.5 * (low + high)
    sheet.magnified[panel] = (0.0, length, middle, magnified)
    panel.set_ylim(middle - half, middle + half)
    return magnified


def _section(panel: Axes, worst: tuple[Row, Row | None] | None, found: Found, facts: Facts, sheet: Sheet) -> None:
    """Draw the paths of the sub-conductors in the worst motion between ellipse and phases, equal axes."""
    palette = sheet.palette
    draw_surroundings(panel, facts, sheet)
    left, right, bottom, top = bounds_of(facts)
    if worst is not None:
        cycle, orbit = worst
        for across, up in _paths(cycle, orbit, facts):
            panel.plot(across, up, color=palette.models[cycle["model"]], linewidth=1.4, zorder=5)
            left, right = min(left, across.min()), max(right, across.max())
            bottom, top = min(bottom, up.min()), max(top, up.max())
        place = f", at {cycle['observed_at_m']:.4g} m" if cycle["observed_at_m"] is not None else ""
        panel.set_title(
            f"cross-section{place}: {loops_name(cycle['loops'], facts.of_section)}, {cycle['wind_speed_m_per_s']:g} m/s"
        )
    else:
        panel.set_title("cross-section at rest")
    radius = max([math.hypot(*place) for place in facts.bundle] or [0.0])
    sheet.boxes[panel] = (min(left, -radius), max(right, radius), min(bottom, -radius - 0.05), max(top, radius + 0.05))
    panel.set_xlabel("horizontal, downwind [m]" + _nearest(found))
    panel.set_ylabel("vertical, upward [m]")
    panel.locator_params(nbins=6)
    panel.grid(visible=True, clip_on=False)


def _paths(cycle: Row, orbit: Row | None, facts: Facts) -> Iterator[tuple[Path, Path]]:
    """Yield z and y of each sub-conductor over one period, by eq. (3); without an orbit the box of its amplitudes."""
    if orbit is None:
        half, up = cycle["horizontal_m"] or 0.0, cycle["vertical_m"]
        yield np.array([-half, half, half, -half, -half]), np.array([-up, -up, up, up, -up])
        return
    v, w, theta = (motion(orbit[name]) for name in ("vertical", "horizontal", "torsional"))
    for y, z in facts.bundle or ((0.0, 0.0),):
        yield np.asarray(z + w + y * theta), np.asarray(y + v - z * theta)


def _nearest(found: Found) -> str:
    """Say the smallest distance to another phase in a stable motion."""
    rows = [
        row
        for row in found.get("clearances", ())
        if row["distance_m"] is not None and row["method"] == "computed" and row["stability"] == "stable"
    ]
    if not rows:
        return ""
    row = min(rows, key=lambda row: float(row["distance_m"]))
    required = f", required {row['required_m']:.2f} m" if row["required_m"] is not None else ""
    return f"\nsmallest distance {row['distance_m']:.2f} m{required}"


def _legend(facts: Facts, worst: tuple[Row, Row | None] | None, palette: Palette) -> Iterator[Any]:
    yield Line2D([], [], color=palette.text, linewidth=1.6, label="span at rest")
    if worst is not None:
        colour = palette.models[worst[0]["model"]]
        yield Patch(color=colour, alpha=0.3, label="reach of the worst motion")
        words = "paths of the sub-conductors" if len(facts.bundle) > 1 else "path of the conductor"
        yield Line2D([], [], color=colour, label=words if worst[1] is not None else "box of its amplitudes")
    yield from surroundings_legend(facts, palette)
