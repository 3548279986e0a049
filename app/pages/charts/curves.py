"""Amplitudes over the wind speed, in the form in which the script of the pages draws them.

A branch of cycles turns back at its folds, so it is cut into pieces along which the wind speed rises, and where its
stability changes. Neighbouring pieces share a point.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from math import pi
from typing import Any

from app.pages.findings import Findings, Row
from app.pages.measures import Units
from app.pages.wording import word_for, words

QUANTITIES = {"vertical": ("vertical_m", "m", 1.0), "horizontal": ("horizontal_m", "m", 1.0)}
TORSION = ("torsional_rad", "deg", 180.0 / pi)
_COLUMNS = {**QUANTITIES, "torsional": TORSION}


def curves(found: Findings, units: Units) -> dict[str, Any]:
    """Return all that a chart of amplitudes shows, in the units of the reader."""
    said = words().curves
    quantities = [
        {"name": name, "label": getattr(said, name), "unit": units.unit(si).name or si}
        for name, (_, si, _) in _COLUMNS.items()
    ]
    return {
        "wind_unit": units.unit("m/s").name,
        "quantities": quantities,
        "pieces": [_drawn(rows, units) for rows in pieces(found.rows("amplitude_curves"))],
        "motions": [_drawn([row], units) for row in found.rows("limit_cycles") if _is_cycle(row)],
        "tori": [_band(row, units) for row in found.rows("limit_cycles") if row["kind"] == "quasi_periodic"],
        "marks": list(_marks(found, units)),
        "spread": _spread(found.rows("uncertainty"), units),
        "onset": _wind((found.verdict or {}).get("onset_m_per_s"), units),
    }


def pieces(rows: Iterable[Row]) -> Iterator[list[Row]]:
    """Yield the points of curves in pieces of one stability along which the wind speed only rises, or only falls."""
    for _, curve in groupby(rows, key=lambda row: (row["model"], row["loops"], row["branch"], row["curve"])):
        piece: list[Row] = []
        for row in curve:
            if len(piece) > 1 and (_turns(piece, row) or row["stability"] != piece[-1]["stability"]):
                yield piece
                piece = [piece[-1]]
            piece.append(row)
        if piece:
            yield piece


def _turns(piece: Sequence[Row], row: Row) -> bool:
    before, last = (point["wind_speed_m_per_s"] for point in piece[-2:])
    return bool((last - before) * (row["wind_speed_m_per_s"] - last) < 0.0)


def _drawn(rows: Sequence[Row], units: Units) -> dict[str, Any]:
    """Return a piece with the stability of its last point: its first one belongs to the piece before it, too."""
    last = rows[-1]
    return {
        **{name: last[name] for name in ("model", "loops", "branch", "stability")},
        "name": label(last),
        "wind": [_wind(row["wind_speed_m_per_s"], units) for row in rows],
        **{name: [_amplitude(row, name, units) for row in rows] for name in _COLUMNS},
    }


def label(row: Row) -> str:
    """Return which motion a row is about: model, loops and stability, in words."""
    said = words()
    loops = said.loops.one if row["loops"] == 1 else said.loops.several.format(count=row["loops"])
    parts = (word_for(said.models, row["model"]), loops, word_for(said.stability, row["stability"]))
    return ", ".join(parts)


def _amplitude(row: Row, name: str, units: Units, suffix: str = "") -> float | None:
    column, si, factor = _COLUMNS[name]
    if suffix:
        stem, _, unit = column.rpartition("_")
        column = f"{stem}_{suffix}_{unit}"
    value = row.get(column)
    return None if value is None else units.value(value * factor, si)


def _band(row: Row, units: Units) -> dict[str, Any]:
    """Return a quasi-periodic motion, whose amplitude varies between two values."""
    ends = {name: [_amplitude(row, name, units, "min"), _amplitude(row, name, units)] for name in _COLUMNS}
    return {
        **{name: row[name] for name in ("model", "loops", "branch", "stability")},
        "name": f"{label(row)}, {words().curves.torus}",
        "wind": _wind(row["wind_speed_m_per_s"], units),
        **ends,
    }


def _marks(found: Findings, units: Units) -> Iterator[dict[str, Any]]:
    """Yield the bifurcations at the amplitude of the nearest point of their branch."""
    said = words()
    for row in found.rows("bifurcations"):
        near = _nearest(found.rows("amplitude_curves"), row)
        if near is not None:
            yield {
                "type": row["type"],
                "name": f"{word_for(said.bifurcations, row['type'])}, {label({**row, 'stability': near['stability']})}",
                **{name: row[name] for name in ("model", "loops", "branch")},
                "wind": _wind(row["wind_speed_m_per_s"], units),
                **{name: 0.0 if row["type"] == "hopf" else _amplitude(near, name, units) for name in _COLUMNS},
            }


def _nearest(points: Iterable[Row], row: Row) -> Row | None:
    own = [p for p in points if all(p[name] == row[name] for name in ("model", "loops", "branch"))]
    return min(own, key=lambda p: abs(p["wind_speed_m_per_s"] - row["wind_speed_m_per_s"]), default=None)


def _spread(rows: Sequence[Row], units: Units) -> dict[str, Any] | None:
    """Return the quantiles of the amplitudes over the samples, at the wind speeds asked for."""
    at_winds = [row for row in rows if row["wind_speed_m_per_s"] is not None]
    if not at_winds:
        return None
    ends = {
        name: [[_amplitude(row, name, units, end) for row in at_winds] for end in ("p05", "p50", "p95")]
        for name in _COLUMNS
    }
    return {"wind": [_wind(row["wind_speed_m_per_s"], units) for row in at_winds], **ends}


def _wind(speed: float | None, units: Units) -> float | None:
    return None if speed is None else units.value(speed, "m/s")


def _is_cycle(row: Row) -> bool:
    return row["kind"] == "periodic" and row["vertical_m"] is not None
