"""The catalogue of bare conductors: published figures as printed, each row with its source (app/data)."""

import csv
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any

# Published unit -> SI.
_NUMBERS: Mapping[str, tuple[str, float]] = {
    "area_m2": ("area_mm2", 1e-6),
    "diameter_m": ("diameter_mm", 1e-3),
    "mass_kg_per_m": ("mass_kg_per_km", 1e-3),
    "rated_strength_n": ("rated_strength_kn", 1e3),
    "youngs_modulus_pa": ("modulus_gpa", 1e9),
}
_TEXTS = ("name", "designation", "type", "stranding")


def search(text: str) -> list[dict[str, Any]]:
    """Return the conductors whose name, designation, type or stranding contain every word of a text, ignoring case."""
    words = text.casefold().split()
    return [row for row in _rows() if all(word in _searched(row) for word in words)]


def _searched(row: Mapping[str, Any]) -> str:
    return "\n".join(str(row[name]) for name in _TEXTS).casefold()


@cache
def _rows() -> tuple[dict[str, Any], ...]:
    text = (files("app") / "data" / "conductors.csv").read_text(encoding="utf-8")
    return tuple(_row(printed) for printed in csv.DictReader(text.splitlines()))


def _row(printed: Mapping[str, str]) -> dict[str, Any]:
    numbers = {
        name: float(printed[column]) * factor if printed[column] else None
        for name, (column, factor) in _NUMBERS.items()
    }
    return {
        "name": printed["name"],
        "designation": printed["designation"],
        "type": printed["type"],
        "stranding": f"{printed['aluminium_wires']}/{printed['steel_wires']}",
        **{name: None if value is None else float(f"{value:.6g}") for name, value in numbers.items()},
        "source": printed["source"],
    }
