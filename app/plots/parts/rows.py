"""What pictures read from rows: the models and loops in them, their names, and the motion of an orbit."""

import math
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np

from app.plots.facts import Found, Row

Path: TypeAlias = np.ndarray[tuple[int], np.dtype[np.float64]]

NAMES = {"hybrid": "hybrid model", "finite_element": "finite element model"}
MARKERS = {"hybrid": "o", "finite_element": "s"}
WIDTHS = {"hybrid": 3.0, "finite_element": 1.4}  # thin lines are drawn over thick ones, so that both show
SIZES = {"hybrid": 6.5, "finite_element": 3.8}
ORDER = {"hybrid": 4, "finite_element": 5}
HALF = "Amplitudes are half of peak to peak."
_ORBIT_POINTS = 361


def loops_and_models(found: Found) -> tuple[list[int], list[str]]:
    """Return the numbers of loops and the models in the rows, at least one of each, so that there is a panel."""
    rows = [
        row for table in ("limit_cycles", "critical_wind_speeds", "amplitude_curves") for row in found.get(table, ())
    ]
    loops = sorted({row["loops"] for row in rows}) or [1]
    present = {row["model"] for row in rows}
    return loops, [model for model in NAMES if model in present] or ["hybrid"]


def loops_name(count: int, of_section: bool = False) -> str:
    """Return a number of loops in words; in a section of spans it is the number of a mode."""
    return f"mode {count}" if of_section else f"{count} loop{'s' if count > 1 else ''}"


def motion(coefficients: Sequence[float]) -> Path:
    """Evaluate (mean, cos 1, sin 1, cos 2, ...) over one period [m or rad]."""
    phase = np.linspace(0.0, 2.0 * math.pi, _ORBIT_POINTS)
    values = np.asarray(coefficients, dtype=np.float64)
    orders = np.arange(1, (values.size - 1) // 2 + 1)[:, None]
    found = values[0] + values[1::2] @ np.cos(orders * phase) + values[2::2] @ np.sin(orders * phase)
    return np.asarray(found)


def orbits_of(found: Found) -> list[tuple[Row, Row]]:
    """Return each cycle that has an orbit, with its Fourier coefficients."""
    cycles = found.get("limit_cycles", ())
    return [(cycles[item["cycle"]], item) for item in found.get("orbits", ())]


def spread(values: Sequence[Any], most: int) -> list[Any]:
    """Return at most so many of the values, evenly over all of them, the first and the last included."""
    if len(values) <= most:
        return list(values)
    places = np.linspace(0, len(values) - 1, max(most, 2)).round().astype(int)
    return [values[place] for place in dict.fromkeys(places.tolist())]
