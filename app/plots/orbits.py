"""Draw orbits at the observation point, equal axes and one scale, beside the design ellipse and the other phases."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.lines import Line2D

from app.plots.canvas.sheet import (
    Box,
    Heading,
    Sheet,
    empty,
    layout_width,
    legend_height,
    new_sheet,
    place_legend,
)
from app.plots.canvas.themes import PALETTES, Palette
from app.plots.facts import Facts, Found, Row
from app.plots.options import Options
from app.plots.parts.rows import NAMES, loops_and_models, loops_name, motion, orbits_of, spread
from app.plots.parts.surroundings import bounds_of, draw_surroundings, surroundings_legend

_MOST_IN_LEGEND = 8
_MOST_ORBITS = 36
_FAR = 3.0  # times larger than the orbits: what surrounds them gets panels of its own
_WIDEST_PX = 420.0

Cycle = tuple[Row, Row]  # the row of a cycle and its Fourier coefficients


@dataclass(frozen=True, slots=True)
class _Panel:
    """What one panel shows: orbits of one model and number of loops, alone or with what surrounds them."""

    model: str
    loops: int
    cycles: Sequence[Cycle]
    surrounded: bool


@dataclass(frozen=True, slots=True)
class _Winds:
    """The wind speeds that are shown, with their colours."""

    speeds: Sequence[float]
    colours: ScalarMappable

    def colour(self, speed: float) -> tuple[float, float, float]:
        red, green, blue, _ = self.colours.to_rgba(np.array([speed]))[0]
        return float(red), float(green), float(blue)


def picture(found: Found, facts: Facts, options: Options) -> Sheet:
    """Draw vertical over horizontal motion, a panel for each model and number of loops.

    The tables are limit_cycles, critical_wind_speeds and orbits. Where ellipse or phases are much larger than the
    orbits, further panels show the orbits enlarged, all to one scale.
    """
    palette = PALETTES[options.theme]
    everything = orbits_of(found)
    winds = _winds(everything, found, palette)
    cycles = [cycle for cycle in everything if cycle[0]["wind_speed_m_per_s"] in winds.speeds]
    box, around = _box(cycles), bounds_of(facts)
    panels = list(_panels(found, cycles, facts, _is_far(box, around)))
    shape = _shape(panels, box, around)
    rows, beside = grid_of(len(panels), layout_width(options))
    handles = list(_legend(facts, winds, palette))
    bar_px = 70.0 if len(winds.speeds) > _MOST_IN_LEGEND else 0.0
    panel_px = min((layout_width(options) - bar_px) / beside - 60.0, _WIDEST_PX)
    height = rows * (shape * panel_px + 62.0) + legend_height(handles, options)
    subtitle = "Orbits at the point of the largest motion: vertical over horizontal displacement, to one scale."
    names = [phase.name for phase in facts.phases]
    feet = (_left_out(found, everything, winds), *facts.footer)
    sheet = new_sheet(Heading(facts.title, subtitle, feet), options, height, names)
    grid = sheet.figure.subplots(rows, beside, squeeze=False)
    for place, panel in zip(grid.flat, [*panels, *[None] * (grid.size - len(panels))], strict=True):
        if panel is None:
            place.set_axis_off()
        else:
            _draw(place, panel, facts, sheet, winds)
            sheet.boxes[place] = _union(box, around) if panel.surrounded else box
    if len(winds.speeds) > _MOST_IN_LEGEND:
        bar = sheet.figure.colorbar(winds.colours, ax=grid, label="wind speed [m/s]", shrink=0.8)
        bar.outline.set_visible(False)
    place_legend(sheet, handles)
    return sheet


def _winds(cycles: Sequence[Cycle], found: Found, palette: Palette) -> _Winds:
    """Choose wind speeds evenly over all of them, so that orbits stay apart."""
    loops, models = loops_and_models(found)
    speeds = sorted({cycle["wind_speed_m_per_s"] for cycle, _ in cycles})
    shown = spread(speeds, max(3, _MOST_ORBITS // (len(loops) * len(models))))
    map_ = ListedColormap(mpl.colormaps[palette.colour_map](np.linspace(*palette.colour_range, 256)))
    norm = Normalize(shown[0], shown[-1]) if len(shown) > 1 else Normalize(0.0, 1.0)
    return _Winds(shown, ScalarMappable(norm, map_))


def grid_of(panels: int, width: float) -> tuple[int, int]:
    """Return the rows and columns of panels that fit into a width [px]."""
    beside = max(1, min(4, panels, int(width // 235.0)))
    rows = -(-panels // beside)
    return rows, -(-panels // rows)


def _panels(found: Found, cycles: Sequence[Cycle], facts: Facts, far: bool) -> Iterator[_Panel]:
    """Yield the panels; if what surrounds the orbits is far larger, it has one of its own with all of them."""
    loops, models = loops_and_models(found)
    surrounded = facts.ellipse is not None or bool(facts.phases)
    if far and surrounded:
        yield _Panel("", 0, cycles, surrounded=True)
    if not found["limit_cycles"]:
        yield _Panel(models[0], loops[0], (), surrounded)
    for count in loops:
        for model in models:
            mine = [(row, item) for row, item in cycles if (row["model"], row["loops"]) == (model, count)]
            if mine or any((row["model"], row["loops"]) == (model, count) for row in found["limit_cycles"]):
                yield _Panel(model, count, mine, surrounded and not far)


def _shape(panels: Sequence[_Panel], box: Box, around: Box) -> float:
    """Return the height of the panels over their width, as their contents need it."""
    ratios = []
    for panel in panels:
        left, right, bottom, top = _union(box, around) if panel.surrounded else box
        ratios.append((top - bottom) / (right - left))
    return min(max([0.45, *ratios]), 1.25)


def _draw(place: Axes, panel: _Panel, facts: Facts, sheet: Sheet, winds: _Winds) -> None:
    place.set_title(_title(panel, facts))
    if not panel.cycles and not panel.surrounded:
        empty(place, "no cycle", sheet.palette)
        return
    if panel.surrounded:
        draw_surroundings(place, facts, sheet)
    for row, item in panel.cycles:
        style = "-" if row["stability"] == "stable" else "--"
        colour = winds.colour(row["wind_speed_m_per_s"])
        place.plot(motion(item["horizontal"]), motion(item["vertical"]), style, color=colour, linewidth=1.4, zorder=5)
    if not panel.cycles:
        place.text(0.02, 0.02, "no cycle", transform=place.transAxes, color=sheet.palette.muted)
    place.grid(visible=True, clip_on=False)
    place.locator_params(nbins=6)
    place.set_xlabel("horizontal, downwind [m]")
    place.set_ylabel("vertical, upward [m]")


def _title(panel: _Panel, facts: Facts) -> str:
    if not panel.model:
        return "all orbits and what surrounds them"
    at = f" at {panel.cycles[0][0]['observed_at_m']:.4g} m" if panel.cycles else ""
    return f"{NAMES[panel.model]}\n{loops_name(panel.loops, facts.of_section)}{at}"


def _box(cycles: Sequence[Cycle]) -> Box:
    """Return the bounds of all orbits and of rest, symmetric to both sides [m]."""
    across = [abs(motion(item["horizontal"])).max() for _, item in cycles]
    up = [abs(motion(item["vertical"])).max() for _, item in cycles]
    half = max([*across, 0.02]), max([*up, 0.02])
    return -half[0], half[0], -half[1], half[1]


def _union(one: Box, other: Box) -> Box:
    return min(one[0], other[0]), max(one[1], other[1]), min(one[2], other[2]), max(one[3], other[3])


def _is_far(box: Box, around: Box) -> bool:
    return max(around[1] - around[0], around[3] - around[2]) > _FAR * max(box[1] - box[0], box[3] - box[2])


def _left_out(found: Found, everything: Sequence[Cycle], winds: _Winds) -> str:
    """Say what the picture does not show."""
    speeds = {cycle["wind_speed_m_per_s"] for cycle, _ in everything}
    tori = sum(row.get("kind") == "quasi_periodic" for row in found["limit_cycles"])
    parts = [
        f"{len(winds.speeds)} of {len(speeds)} wind speeds are shown" if len(speeds) > len(winds.speeds) else "",
        f"quasi-periodic motions ({tori}) have no closed orbit and are not shown" if tori else "",
    ]
    said = "; ".join(part for part in parts if part)
    return f"{said}." if said else ""


def _legend(facts: Facts, winds: _Winds, palette: Palette) -> Iterator[Any]:
    yield Line2D([], [], color=palette.text, linestyle="-", label="stable")
    yield Line2D([], [], color=palette.text, linestyle="--", label="unstable or not known")
    if len(winds.speeds) <= _MOST_IN_LEGEND:
        for speed in winds.speeds:
            yield Line2D([], [], color=winds.colour(speed), linewidth=2.0, label=f"{speed:g} m/s")
    yield from surroundings_legend(facts, palette)
