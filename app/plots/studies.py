"""Draw studies: amplitudes over one field as in the source (paper Figures 4 to 9), or maps over two fields."""

import math
import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import Any, Literal

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from app.plots.drawing import MARKERS, NAMES, Extension, Found, Row, drawn, loops_and_models, loops_name
from app.plots.maps import map_figure

Abscissa = Literal["reduced", "parameter"]

_PALETTE = ("#0b5394", "#c55a11", "#38761d", "#741b47", "#bf9000", "#45818e", "#990000", "#674ea7")
_TENSIONS = frozenset({"span.horizontal_tension_n", "span.catenary_parameter_m", "span.sag_m"})
_DAMPING = frozenset({"damping.vertical_ratio", "damping.horizontal_ratio", "damping.torsional_ratio"})
_LENGTH = "span.length_m"
_MOST_IN_LEGEND = 12
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


def study(title: str, studies: Mapping[str, Study], extension: Extension, abscissa: Abscissa = "reduced") -> bytes:
    """Draw the amplitude ratios over the varied field, a row of panels for each number of loops; two axes give a map.

    Parameters
    ----------
    title : str
        Title of the picture.
    studies : mapping
        Studies over the same axes, by their name in the legend. A map shows the first one.
    extension : {"svg", "png"}
        Format of the picture.
    abscissa : {"reduced", "parameter"}
        Whether damping, tension, length and wind speed are shown as the source's ratios or in their own units.
    """
    first, *_ = studies.values()
    if len(first.axes) > 1:
        return drawn(lambda: map_figure(title, first.axes, first.found), extension)
    return drawn(lambda: _study_figure(title, studies, abscissa), extension)


def _study_figure(title: str, studies: Mapping[str, Study], abscissa: Abscissa) -> Figure:
    first, *_ = studies.values()
    found = list(curves(studies, abscissa))
    loops = sorted({count for one in studies.values() for count in loops_and_models(one.found)[0]})
    figure = Figure(figsize=(10.5, 1.5 + 2.5 * len(loops)), layout="constrained")
    panels = figure.subplots(len(loops), len(_RATIOS), squeeze=False, sharex=True)
    for count, row in zip(loops, panels, strict=True):
        for panel, (text, ratio) in zip(row, _RATIOS, strict=True):
            for one in found:
                _draw(panel, one, [(place, ratio(r), r) for place, r in one.points if r["loops"] == count])
            panel.set_ylabel(f"{text}\n{loops_name(count)}" if panel is row[0] else text)
            panel.set_ylim(bottom=0.0)
            panel.grid(visible=True, alpha=0.25)
    for panel in panels[-1]:
        panel.set_xlabel(_label(first.axes, abscissa))
    figure.suptitle(textwrap.fill(title, 90), fontweight="bold")
    _legend(figure, found, sum(len(one.found.get("failures", ())) for one in studies.values()))
    return figure


def _both(row: Row) -> float:
    return math.hypot(row["vertical_ratio"], row["horizontal_ratio"])


_RATIOS: Sequence[tuple[str, Callable[[Row], float]]] = (
    ("vertical A_y / s_a", lambda row: float(row["vertical_ratio"])),
    ("horizontal A_z / s_a", lambda row: float(row["horizontal_ratio"])),
    ("both A / s_a", _both),
)


def _label(axes: Sequence[str], abscissa: Abscissa) -> str:
    """Return the label of the abscissa."""
    if not axes:
        return "reduced wind speed U / (f L_x)" if abscissa == "reduced" else "wind speed [m/s]"
    if abscissa == "parameter":
        return axes[0]
    if axes[0] in _DAMPING:
        return "reduced critical wind speed U_c / (f L_x)"
    if axes[0] in _TENSIONS:
        return "tension ratio H / w, iced"
    return "span ratio L_x / s_a" if axes[0] == _LENGTH else axes[0]


def curves(studies: Mapping[str, Study], abscissa: Abscissa) -> Iterator[Curve]:
    """Yield the cycles of each study by model, and by wind speed unless the study varies it."""
    speeds = sorted({row["wind_speed_m_per_s"] for one in studies.values() for row in _lasting(one)})
    sizes = dict(zip(studies, cycle(_SIZES), strict=False))
    shown = [(name, one, speed) for name, one in studies.items() for speed in (speeds if one.axes else [None])]
    for colour, (name, one, speed) in zip(cycle(_PALETTE), shown, strict=False):
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


def _draw(panel: Axes, curve: Curve, points: Sequence[tuple[Any, float, Row]]) -> None:
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
            markerfacecolor=curve.colour if stability == "stable" else "lightgrey",
            clip_on=False,
        )


def _legend(figure: Figure, shown: Sequence[Curve], failed: int) -> None:
    """Draw a legend of limited length, with the number of failed points."""
    several = len({one.model for one in shown}) > 1
    handles = []
    for one in shown[:_MOST_IN_LEGEND]:
        parts = [one.name, NAMES[one.model] if several or not one.name else ""]
        label, marker = ", ".join(part for part in parts if part), MARKERS[one.model]
        handles.append(Line2D([], [], marker=marker, markersize=one.size, color=one.colour, linewidth=0.8, label=label))
    handles.append(Line2D([], [], linestyle="none", label="filled: stable, grey: not decided"))
    if failed:
        handles.append(Line2D([], [], linestyle="none", label=f"{failed} point{'s' * (failed > 1)} failed"))
    figure.legend(handles=handles, loc="outside lower center", ncols=5, frameon=False)
