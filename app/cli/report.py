"""A result for a person at a terminal: the verdict first, then the few tables that explain it."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import typer

from app.cli.console import print_table

Row = Mapping[str, Any]
MOST_WEIGHTS = 6  # assumptions that are printed
LEAST_WEIGHT = 0.01  # at the lower end of the interval of their share
DISTANCES = "Smallest distance between phases [m], by the motions and by design ellipses"
_MODELS = {"hybrid": "hybrid", "finite_element": "elements"}


def print_report(result: Mapping[str, Any]) -> None:
    """Print the verdicts of a result document, its onsets, its stable motions and its warnings."""
    axes = [axis["parameter"] for axis in (result["input"].get("study") or {}).get("axes", [])]
    for row in result["verdict"]:
        typer.echo(_place(row, axes) + row["sentence"] + f" [{row['trust'].replace('_', ' ')}]")
    onsets = [row for row in result["critical_wind_speeds"] if row["crossing"] == "onset"]
    _print("The span at rest loses stability", axes, onsets, _onset)
    moving = [row for row in result["limit_cycles"] if row["stability"] == "stable" and row["kind"] != "equilibrium"]
    _print("Stable motions, peak to peak [m, rad]", axes, moving, _motion)
    _print(DISTANCES, axes, _nearest(result), _gap)
    _print(
        "What the assumed values weigh: share of the scatter of the onset, onset at both ends",
        axes,
        _heaviest(result),
        _weight,
    )
    for text in _notes(result):
        typer.echo(text)


def print_distances(result: Mapping[str, Any]) -> None:
    """Print the verdicts of a result document, its smallest distances between phases and its warnings."""
    axes = [axis["parameter"] for axis in (result["input"].get("study") or {}).get("axes", [])]
    for row in result["verdict"]:
        typer.echo(_place(row, axes) + row["sentence"])
    _print(DISTANCES, axes, _nearest(result), _gap)
    for text in _notes(result):
        typer.echo(text)


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


def _onset(row: Row) -> dict[str, str]:
    return {
        "model": _MODELS[row["model"]],
        "loops": str(row["loops"]),
        "from m/s": f"{row['wind_speed_m_per_s']:.2f}",
        "direction": row["direction"],
        "Hz": f"{row['frequency_hz']:.3f}",
    }


def _motion(row: Row) -> dict[str, str]:
    twice = {name: 2.0 * row[name] for name in ("vertical_m", "horizontal_m", "torsional_rad")}
    return {
        "model": _MODELS[row["model"]],
        "loops": str(row["loops"]),
        "wind m/s": f"{row['wind_speed_m_per_s']:g}",
        "vertical": f"{twice['vertical_m']:.2f}",
        "horizontal": f"{twice['horizontal_m']:.2f}",
        "torsion": f"{twice['torsional_rad']:.3f}",
        "Hz": f"{row['frequency_hz']:.3f}",
        "note": "" if row["outcome"] == "converged" else row["outcome"].replace("_", " "),
    }


def _nearest(result: Mapping[str, Any]) -> list[Row]:
    """Return the smallest distance of each pair of phases and method, in every point of a study."""
    axes = [axis["parameter"] for axis in (result["input"].get("study") or {}).get("axes", [])]
    nearest: dict[tuple[Any, ...], Row] = {}
    for row in result["clearances"]:
        if row["distance_m"] is None or row["stability"] not in {None, "stable"}:
            continue
        key = (*(row[axis] for axis in axes), row["phase"], row["other_phase"], row["method"])
        if key not in nearest or row["distance_m"] < nearest[key]["distance_m"]:
            nearest[key] = row
    return list(nearest.values())


def _gap(row: Row) -> dict[str, str]:
    return {
        "from": row["phase"],
        "to": row["other_phase"],
        "by": row["method"],
        "distance": f"{row['distance_m']:.2f}",
        "required": "" if row["required_m"] is None else f"{row['required_m']:.2f}",
        "kept": "" if row["ok"] is None else ("yes" if row["ok"] else "no"),
    }


def _heaviest(result: Mapping[str, Any]) -> list[Row]:
    """Return the assumptions whose weight is more than chance, heaviest first."""
    known = [row for row in result["sensitivities"] if (row["onset_total_lowest"] or 0.0) >= LEAST_WEIGHT]
    return sorted(known, key=lambda row: -row["onset_total"])[:MOST_WEIGHTS]


def _weight(row: Row) -> dict[str, str]:
    return {
        "assumed": row["path"],
        "share": f"{row['onset_total']:.2f}",
        "95 %": f"{row['onset_total_lowest']:.2f} to {row['onset_total_highest']:.2f}",
        "onset m/s": f"{_speed(row['onset_at_lowest_m_per_s'])} to {_speed(row['onset_at_highest_m_per_s'])}",
    }


def _speed(value: float | None) -> str:
    return "none" if value is None else f"{value:.2f}"


def _notes(result: Mapping[str, Any]) -> Iterator[str]:
    for text in result["warnings"]:
        yield f"\nWarning: {text}"
    for failure in result["failures"]:
        yield f"\nFailed: {failure['failure']}"
