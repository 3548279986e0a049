"""A result for a person at a terminal: the verdict first, then the few tables that explain it."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import typer

from app.cli.console import print_table
from app.pages.measures import SI, Units

Row = Mapping[str, Any]
MOST_WEIGHTS = 6  # assumptions that are printed
LEAST_WEIGHT = 0.01  # at the lower end of the interval of their share
_SPACES = {ord(space): " " for space in "\N{NO-BREAK SPACE}\N{NARROW NO-BREAK SPACE}"}
_MODELS = {"hybrid": "hybrid", "finite_element": "elements"}


def print_report(result: Mapping[str, Any], units: Units = SI) -> None:
    """Print the verdicts of a result document, its onsets, its stable motions and its warnings."""
    axes = _axes(result)
    for row in result["verdict"]:
        typer.echo(_place(row, axes) + told(row["sentence"], units) + f" [{row['trust'].replace('_', ' ')}]")
    onsets = [row for row in result["critical_wind_speeds"] if row["crossing"] == "onset"]
    _print("The span at rest loses stability", axes, onsets, partial(_onset, units))
    moving = [row for row in result["limit_cycles"] if row["stability"] == "stable" and row["kind"] != "equilibrium"]
    _print(f"Stable motions, peak to peak [{units.unit('m').name}, rad]", axes, moving, partial(_motion, units))
    _print_distances(result, units)
    _print(
        "What the assumed values weigh: share of the scatter of the onset, onset at both ends",
        axes,
        _heaviest(result),
        partial(_weight, units),
    )
    for text in _notes(result, units):
        typer.echo(text)


def print_distances(result: Mapping[str, Any], units: Units = SI) -> None:
    """Print the verdicts of a result document, its smallest distances between phases and its warnings."""
    for row in result["verdict"]:
        typer.echo(_place(row, _axes(result)) + told(row["sentence"], units))
    _print_distances(result, units)
    for text in _notes(result, units):
        typer.echo(text)


def told(text: str, units: Units) -> str:
    """Return a sentence in the units of the reader, with the spaces that every terminal has."""
    return units.sentence(text).translate(_SPACES)


def _print_distances(result: Mapping[str, Any], units: Units) -> None:
    title = f"Smallest distance between phases [{units.unit('m').name}], by the motions and by design ellipses"
    _print(title, _axes(result), _nearest(result), partial(_gap, units))


def _axes(result: Mapping[str, Any]) -> list[str]:
    return [axis["parameter"] for axis in (result["input"].get("study") or {}).get("axes", [])]


def _print(title: str, axes: Sequence[str], rows: Sequence[Row], shown: Callable[[Row], Row]) -> None:
    """Print rows under a title, with the columns of a study's axes first; nothing without rows."""
    cells = [{**{axis: row[axis] for axis in axes}, **shown(row)} for row in rows]
    if cells:
        typer.echo(f"\n{title}")
        print_table(list(cells[0]), cells)


def _place(row: Row, axes: Sequence[str]) -> str:
    """Return the point of a study that a row belongs to."""
    values = ", ".join(f"{axis} {row[axis]}" for axis in axes)
    return f"{values}: " if values else ""


def _onset(units: Units, row: Row) -> dict[str, str]:
    return {
        "model": _MODELS[row["model"]],
        "loops": str(row["loops"]),
        f"from {units.unit('m/s').name}": _two(units, row["wind_speed_m_per_s"], "m/s"),
        "direction": row["direction"],
        "Hz": f"{row['frequency_hz']:.3f}",
    }


def _motion(units: Units, row: Row) -> dict[str, str]:
    twice = {name: 2.0 * row[name] for name in ("vertical_m", "horizontal_m", "torsional_rad")}
    return {
        "model": _MODELS[row["model"]],
        "loops": str(row["loops"]),
        f"wind {units.unit('m/s').name}": f"{units.value(row['wind_speed_m_per_s'], 'm/s'):g}",
        "vertical": _two(units, twice["vertical_m"], "m"),
        "horizontal": _two(units, twice["horizontal_m"], "m"),
        "torsion": f"{twice['torsional_rad']:.3f}",
        "Hz": f"{row['frequency_hz']:.3f}",
        "note": "" if row["outcome"] == "converged" else row["outcome"].replace("_", " "),
    }


def _nearest(result: Mapping[str, Any]) -> list[Row]:
    """Return the smallest distance of each pair of phases and method, in every point of a study."""
    axes = _axes(result)
    nearest: dict[tuple[Any, ...], Row] = {}
    for row in result["clearances"]:
        if row["distance_m"] is None or row["stability"] not in {None, "stable"}:
            continue
        key = (*(row[axis] for axis in axes), row["phase"], row["other_phase"], row["method"])
        if key not in nearest or row["distance_m"] < nearest[key]["distance_m"]:
            nearest[key] = row
    return list(nearest.values())


def _gap(units: Units, row: Row) -> dict[str, str]:
    return {
        "from": row["phase"],
        "to": row["other_phase"],
        "by": row["method"],
        "distance": _two(units, row["distance_m"], "m"),
        "required": "" if row["required_m"] is None else _two(units, row["required_m"], "m"),
        "kept": "" if row["ok"] is None else ("yes" if row["ok"] else "no"),
    }


def _heaviest(result: Mapping[str, Any]) -> list[Row]:
    """Return the assumptions whose weight is more than chance, heaviest first."""
    known = [row for row in result["sensitivities"] if (row["onset_total_lowest"] or 0.0) >= LEAST_WEIGHT]
    return sorted(known, key=lambda row: -row["onset_total"])[:MOST_WEIGHTS]


def _weight(units: Units, row: Row) -> dict[str, str]:
    ends = [row["onset_at_lowest_m_per_s"], row["onset_at_highest_m_per_s"]]
    low, high = ("none" if end is None else _two(units, end, "m/s") for end in ends)
    return {
        "assumed": row["path"],
        "share": f"{row['onset_total']:.2f}",
        "95 %": f"{row['onset_total_lowest']:.2f} to {row['onset_total_highest']:.2f}",
        f"onset {units.unit('m/s').name}": f"{low} to {high}",
    }


def _two(units: Units, value: float, si: str) -> str:
    """Return a number of an SI unit in the units of the reader, with two decimals."""
    return f"{units.value(value, si):.2f}"


def _notes(result: Mapping[str, Any], units: Units) -> Iterator[str]:
    for text in result["warnings"]:
        yield f"\nWarning: {told(text, units)}"
    for failure in result["failures"]:
        yield f"\nFailed: {failure['failure']}"
