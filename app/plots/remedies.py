"""Draw remedies beside the line as it is: onset and amplitude with each, and how sure it is that it improves."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from app.plots.canvas.sheet import Heading, Sheet, columns, empty, layout_width, legend_height, new_sheet, place_legend
from app.plots.canvas.themes import PALETTES, Palette
from app.plots.canvas.wrapping import wrapped
from app.plots.facts import Facts, Found, Row
from app.plots.options import Options
from app.plots.parts.rows import HALF

_SUBTITLE = f"The line as it is, dashed, and with each remedy, the best on top. {HALF}"
_MOST_ROWS = 16
_BESIDE, _NARROWEST = 3, 300.0  # panels beside each other, each with this width [px] or more; else below each other
_NAME, _NAME_LINES, _LETTER = 20.0, 4, 12.0  # widest name [letters], and the size of a letter [px]
_MARKS: Mapping[str | None, tuple[str, str]] = {
    None: ("P", "the line as it is"),
    "better": ("o", "better"),
    "no_improvement": ("s", "no improvement"),
    "worse": ("X", "worse"),
    "undecided": ("D", "not decided"),
}


@dataclass(frozen=True, slots=True)
class _Quantity:
    """What a panel shows: title, label, columns of the value and of its bar, a factor, and what an absent value means.

    ends: the median alone, or both ends of a bar. about_samples: the value compares samples with the line as it is.
    """

    title: str
    label: str
    value: str
    ends: tuple[str, ...]
    factor: float = 1.0
    absent: str = "not known"
    about_samples: bool = False


_QUANTITIES = (
    _Quantity("onset", "wind speed [m/s]", "onset_m_per_s", ("onset_p50_m_per_s",), absent="no onset"),
    _Quantity(
        "largest vertical amplitude",
        "amplitude [m]",
        "vertical_peak_to_peak_m",
        ("vertical_p50_m", "vertical_p95_m"),
        0.5,
    ),
    _Quantity(
        "samples that it improves",
        "share [%]",
        "improves",
        ("improves_lowest", "improves_highest"),
        100.0,
        "no samples",
        about_samples=True,
    ),
)


def picture(found: Found, facts: Facts, options: Options) -> Sheet:
    """Draw a panel for the onset, one for the largest amplitude and one for the samples in which a remedy is better.

    The table is remedies.
    """
    rows = _ordered(found.get("remedies", ()))
    shown, width = rows[:_MOST_ROWS], layout_width(options)
    beside = _BESIDE if columns(width, _BESIDE, _NARROWEST) == _BESIDE else 1  # two would leave a hole
    names = ["\n".join(wrapped(row["what"], min(_NAME, 0.4 * width / _LETTER), _NAME_LINES)) for row in shown]
    handles = _legend(shown, PALETTES[options.theme])
    body = max(sum(16.0 * (name.count("\n") + 1) + 12.0 for name in names), 90.0) + 75.0
    height = body * (len(_QUANTITIES) // beside) + legend_height(handles, options)
    heading = Heading(facts.title, _SUBTITLE, (_told(rows), *facts.footer))
    sheet = new_sheet(heading, options, height, names)
    panels = sheet.figure.subplots(len(_QUANTITIES) // beside, beside, squeeze=False)
    for number, (panel, quantity) in enumerate(zip(panels.flat, _QUANTITIES, strict=True)):
        _panel(panel, shown, quantity, sheet.palette)
        if panel.axison:
            labels = [sheet.write(name) for name in names] if number % beside == 0 else [""] * len(names)
            panel.set_yticks(range(len(names)), labels)
    place_legend(sheet, handles)
    return sheet


def _ordered(rows: Sequence[Row]) -> list[Row]:
    """Return the line as it is, then what is better by its rank, then the others in the order of the request."""
    return sorted(rows, key=lambda row: (row["remedy"] is not None, row["rank"] is None, row["rank"] or 0))


def _panel(panel: Axes, rows: Sequence[Row], quantity: _Quantity, palette: Palette) -> None:
    panel.set_title(quantity.title)
    own = [row for row in rows if row["remedy"] is not None or not quantity.about_samples]
    if not own or (quantity.about_samples and all(row[quantity.value] is None for row in own)):
        empty(panel, "there are no samples" if quantity.about_samples else "no remedies were tried", palette)
        return
    for place, row in enumerate(rows):
        if row in own:
            _mark(panel, place, row, quantity, palette)
    as_it_is = next((row[quantity.value] for row in own if row["remedy"] is None), None)
    if as_it_is is not None:
        panel.axvline(quantity.factor * as_it_is, color=palette.muted, linewidth=1.0, linestyle="--", zorder=1)
    panel.set_ylim(len(rows) - 0.5, -0.5)
    panel.use_sticky_edges = False
    panel.margins(x=0.12)
    if quantity.about_samples:
        panel.set_xlim(-5.0, 105.0)
    panel.set_xlabel(quantity.label)
    panel.grid(visible=True, axis="x", clip_on=False)


def _mark(panel: Axes, place: int, row: Row, quantity: _Quantity, palette: Palette) -> None:
    colour, value = _colour(row, palette), row[quantity.value]
    ends = [quantity.factor * row[name] for name in quantity.ends if row[name] is not None]
    if len(ends) > 1:
        panel.hlines(place, ends[0], ends[1], color=colour, linewidth=5.0, alpha=0.35)
    elif len(quantity.ends) == 1:
        panel.plot(ends, [place] * len(ends), "|", color=colour, markersize=13.0, markeredgewidth=1.5)
    if value is not None:
        face = palette.background if row["change"] == "undecided" else colour
        mark, _ = _MARKS[row["change"]]
        panel.plot([quantity.factor * value], [place], mark, color=colour, markersize=7.0, markerfacecolor=face)
        return
    rests = row["gallops"] == "no" or quantity.about_samples
    panel.annotate(
        quantity.absent if rests else "not known",
        (0.02, place),
        xycoords=("axes fraction", "data"),
        va="center",
        fontsize="small",
        color=palette.muted,
    )


def _colour(row: Row, palette: Palette) -> str:
    named = {"better": palette.good, "worse": palette.bad, None: palette.text}
    return named.get(row["change"], palette.muted)


def _told(rows: Sequence[Row]) -> str:
    """Say what the bars are, and how many remedies are not shown."""
    samples = max((row["samples"] for row in rows), default=0)
    parts = [
        f"bars: amplitude from the median to the 95 % quantile of {samples} samples, share with its 95 % interval; "
        "short strokes: median onset of the samples"
        if samples
        else "",
        f"{len(rows) - _MOST_ROWS} further rows of the table remedies are not shown" if len(rows) > _MOST_ROWS else "",
    ]
    said = "; ".join(part for part in parts if part)
    return f"{said[0].upper()}{said[1:]}." if said else ""


def _legend(rows: Sequence[Row], palette: Palette) -> list[Any]:
    found = {row["change"]: row for row in rows}
    return [
        Line2D(
            [],
            [],
            linestyle="none",
            marker=mark,
            color=_colour(found[change], palette),
            markerfacecolor=palette.background if change == "undecided" else _colour(found[change], palette),
            markersize=7.0,
            label=label,
        )
        for change, (mark, label) in _MARKS.items()
        if change in found
    ]
