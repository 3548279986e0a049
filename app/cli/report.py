"""A result for a person at a terminal: the verdict first, then the few tables that explain it."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import typer

from app.cli.console import print_table

Row = Mapping[str, Any]
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


def _notes(result: Mapping[str, Any]) -> Iterator[str]:
    for text in result["warnings"]:
        yield f"\nWarning: {text}"
    for failure in result["failures"]:
        yield f"\nFailed: {failure['failure']}"
