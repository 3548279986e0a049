"""Draw studies: amplitudes over one field as in the source (paper Figures 4 to 9), or maps over two fields."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from app.plots.canvas.drawing import About, drawn
from app.plots.canvas.sheet import Heading, Sheet, columns, layout_width, legend_height, new_sheet, place_legend
from app.plots.canvas.themes import LIGHT, PALETTES, Palette
from app.plots.facts import Facts, Found, Row
from app.plots.maps import map_sheet
from app.plots.options import Abscissa, Options
from app.plots.parts.paths import label_of
from app.plots.parts.rows import HALF, MARKERS, NAMES, loops_and_models, loops_name

_TENSIONS = frozenset({"span.horizontal_tension_n", "span.catenary_parameter_m", "span.sag_m"})
_DAMPING = frozenset({"damping.vertical_ratio", "damping.horizontal_ratio", "damping.torsional_ratio"})
_LENGTH = "span.length_m"
_MOST_IN_LEGEND = 12
_PANEL_PX = 215.0
_SUBTITLE = "Motions that last, over the varied field: amplitude divided by the sag at rest."
_SIZES = (7.0, 5.5, 4.0, 2.5)  # one for each study, so that equal cycles stay visible behind each other


@dataclass(frozen=True, slots=True)
class Study:
    """A job's result in the form that pictures of studies need.

    axes: names of the fields that vary; length: length of the span [m], unless an axis varies it; found: the result
    document, whose rows begin with the values of the axes.
    """

    axes: Sequence[str]
    length: float
    found: Found


@dataclass(frozen=True, slots=True)
class Curve:
    """Cycles drawn together: their look and legend entry, the abscissa and the row of each, and their model."""

    name: str
    colour: str
    size: float
    model: str
    points: Sequence[tuple[Any, Row]]


def picture(found: Found, facts: Facts, options: Options) -> Sheet:
    """Draw the amplitude ratios over the varied field; two fields give a map.

    The tables are limit_cycles and critical_wind_speeds, with static and failures, whose rows begin with the values of
    the axes.
    """
    return several(facts, {"": Study(facts.axes, facts.length or 0.0, found)}, options)


def several(facts: Facts, studies: Mapping[str, Study], options: Options) -> Sheet:
    """Draw studies over the same axes in one picture, by their name in the legend; a map shows the first one.

    Panels of one ratio have one scale.
    """
    first, *_ = studies.values()
    if len(first.axes) > 1:
        return map_sheet(first.found, facts, options)
    found = list(curves(studies, options.abscissa, PALETTES[options.theme].series))
    loops = sorted({count for one in studies.values() for count in loops_and_models(one.found)[0]})
    beside = columns(layout_width(options), len(_RATIOS), 230.0)
    rows = len(loops) * len(_RATIOS) // beside
    handles = _legend(found, sum(len(one.found.get("failures", ())) for one in studies.values()))
    height = _PANEL_PX * rows + 20.0 + legend_height(handles, options)
    sheet = new_sheet(Heading(facts.title, f"{_SUBTITLE} {HALF}", facts.footer), options, height)
    panels = sheet.figure.subplots(rows, beside, squeeze=False, sharex=True)
    places = [(count, ratio) for count in loops for ratio in _RATIOS]
    for panel, (count, (text, symbol, ratio)) in zip(panels.flat, places, strict=True):
        for one in found:
            _draw(panel, one, [(place, ratio(r), r) for place, r in one.points if r["loops"] == count], sheet.palette)
        panel.set_title(f"{text}, {loops_name(count, facts.of_section)}")
        panel.set_ylabel(f"amplitude over sag ({symbol})")
        panel.grid(visible=True, clip_on=False)
    _one_scale(panels.flat, len(_RATIOS))
    for panel in panels[-1]:
        panel.set_xlabel(label(first.axes, options.abscissa))
    place_legend(sheet, handles)
    return sheet


def drawn_together(title: str, studies: Mapping[str, Study], options: Options) -> bytes:
    """Draw studies of several lines, as the documents show them, and return the file."""
    facts = Facts(title, axes=tuple(next(iter(studies.values())).axes))
    return drawn(lambda: several(facts, studies, options), options, About(title, f"{_SUBTITLE} {HALF}"))


def _one_scale(panels: Any, ratios: int) -> None:
    """Give the panels of each ratio one scale, which begins at zero."""
    every = list(panels)
    for number in range(ratios):
        alike = every[number::ratios]
        highest = max(panel.get_ylim()[1] for panel in alike)
        for panel in alike:
            panel.set_ylim(0.0, highest)


def _both(row: Row) -> float:
    return math.hypot(row["vertical_ratio"], row["horizontal_ratio"])


_RATIOS: Sequence[tuple[str, str, Callable[[Row], float]]] = (
    ("vertical", "A_y / s_a", lambda row: float(row["vertical_ratio"])),
    ("horizontal", "A_z / s_a", lambda row: float(row["horizontal_ratio"])),
    ("both directions", "A / s_a", _both),
)


def label(axes: Sequence[str], abscissa: Abscissa) -> str:
    """Return the label of the abscissa, in words, with the symbol or the unit."""
    if not axes:
        return "reduced wind speed U / (f L_x)" if abscissa == "reduced" else "wind speed [m/s]"
    if abscissa == "parameter":
        return label_of(axes[0])
    if axes[0] in _DAMPING:
        return "reduced critical wind speed U_c / (f L_x)"
    if axes[0] in _TENSIONS:
        return "tension over iced weight (H / w)"
    return "span over sag (L_x / s_a)" if axes[0] == _LENGTH else label_of(axes[0])


def curves(studies: Mapping[str, Study], abscissa: Abscissa, colours: Sequence[str] = LIGHT.series) -> Iterator[Curve]:
    """Yield the cycles of each study by model, and by wind speed unless the study varies it."""
    speeds = sorted({row["wind_speed_m_per_s"] for one in studies.values() for row in _lasting(one)})
    sizes = dict(zip(studies, cycle(_SIZES), strict=False))
    shown = [(name, one, speed) for name, one in studies.items() for speed in (speeds if one.axes else [None])]
    for colour, (name, one, speed) in zip(cycle(colours), shown, strict=False):
        where = _places(one, abscissa)
        parts = [name, f"{speed:g} m/s" if speed is not None and len(speeds) > 1 else ""]
        rows = [row for row in _lasting(one) if speed is None or row["wind_speed_m_per_s"] == speed]
        for model in NAMES:
            points = [(where(row), row) for row in rows if row["model"] == model and where(row) is not None]
            if points:
                yield Curve(", ".join(part for part in parts if part), colour, sizes[name], model, points)


def _lasting(study: Study) -> list[Row]:
    """Return the motions that are stable or of unknown stability."""
    return [
        row
        for row in study.found["limit_cycles"]
        if row["kind"] != "equilibrium" and row["stability"] != "unstable" and row["vertical_ratio"] is not None
    ]


def _places(study: Study, abscissa: Abscissa) -> Callable[[Row], Any]:
    """Return a function that gives the abscissa of a cycle, None if it has none."""
    if not study.axes:
        return lambda row: row["reduced_wind_speed" if abscissa == "reduced" else "wind_speed_m_per_s"]
    axis = study.axes[0]
    if abscissa == "reduced" and axis in _DAMPING:
        critical = _lowest_onsets(study)
        return lambda row: _reduced(critical.get((row[axis], row["model"], row["loops"])), row)
    if abscissa == "reduced" and (axis in _TENSIONS or axis == _LENGTH):
        ratio = _span_ratio if axis == _LENGTH else _tension_ratio
        static = {row[axis]: ratio(row, row.get(_LENGTH, study.length)) for row in study.found["static"]}
        return lambda row: static.get(row[axis])
    return lambda row: row[axis]


def _tension_ratio(static: Row, length: float) -> float:
    """Return H/w with the weight of one iced sub-conductor; the document does not hold the bare weight."""
    return float(static["catenary_parameter_m"]) / length


def _span_ratio(static: Row, length: float) -> float:
    return length / float(static["sag_m"])


def _lowest_onsets(study: Study) -> Mapping[tuple[Any, str, int], float]:
    """Return the lowest critical wind speed by value of the axis, model and number of loops [m/s]."""
    found: dict[tuple[Any, str, int], float] = {}
    for row in study.found["critical_wind_speeds"]:
        if row["crossing"] == "onset":
            key = (row[study.axes[0]], row["model"], row["loops"])
            found[key] = min(found.get(key, math.inf), row["wind_speed_m_per_s"])
    return found


def _reduced(critical: float | None, cycle: Row) -> float | None:
    """Return U_c/(f L_x), scaled like the cycle's reduced wind speed."""
    if critical is None or cycle["reduced_wind_speed"] is None:
        return None
    return float(critical * cycle["reduced_wind_speed"] / cycle["wind_speed_m_per_s"])


def _draw(panel: Axes, curve: Curve, points: Sequence[tuple[Any, float, Row]], palette: Palette) -> None:
    """Draw cycles; fill stable ones, and join them if each place has only one."""
    for stability in dict.fromkeys(row["stability"] for _, _, row in points):
        here = [(place, value) for place, value, row in points if row["stability"] == stability]
        places = [place for place, _ in here]
        numeric = all(isinstance(place, int | float) for place in places)
        joined = stability == "stable" and numeric and len(set(places)) == len(places)
        panel.plot(
            *zip(*(sorted(here) if numeric else here), strict=True),
            linestyle="-" if joined else "none",
            linewidth=0.8,
            marker=MARKERS[curve.model],
            markersize=curve.size,
            color=curve.colour,
            markerfacecolor=curve.colour if stability == "stable" else palette.unknown,
            clip_on=False,
        )


def _legend(shown: Sequence[Curve], failed: int) -> list[Line2D]:
    """Return a legend of limited length, with the number of failed points."""
    several_models = len({one.model for one in shown}) > 1
    handles = []
    for one in shown[:_MOST_IN_LEGEND]:
        parts = [one.name, NAMES[one.model] if several_models or not one.name else ""]
        text, marker = ", ".join(part for part in parts if part), MARKERS[one.model]
        handles.append(Line2D([], [], marker=marker, markersize=one.size, color=one.colour, linewidth=0.8, label=text))
    more = f"; {len(shown) - _MOST_IN_LEGEND} further colours" if len(shown) > _MOST_IN_LEGEND else ""
    handles.append(Line2D([], [], linestyle="none", label=f"filled: stable, grey: not decided{more}"))
    if failed:
        handles.append(Line2D([], [], linestyle="none", label=f"{failed} point{'s' * (failed > 1)} failed"))
    return handles
