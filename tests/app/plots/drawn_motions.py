"""Motions to draw."""

from typing import Any

SPEEDS = (4.0, 5.0, 6.0)


def motions(speeds: tuple[float, ...] = SPEEDS, loops: tuple[int, ...] = (1, 2)) -> dict[str, list[dict[str, Any]]]:
    """Return rows and orbits of both models: a rest, a stable cycle and one without numbers at each wind speed."""
    rows: dict[str, list[dict[str, Any]]] = {"limit_cycles": [], "critical_wind_speeds": [], "orbits": []}
    for model in ("hybrid", "finite_element"):
        for count in loops:
            critical = {"model": model, "loops": count, "wind_speed_m_per_s": 2.4, "crossing": "onset"}
            rows["critical_wind_speeds"].append(critical)
            for speed in speeds:
                _add_motions(rows, {"model": model, "loops": count, "wind_speed_m_per_s": speed})
    return rows


def _add_motions(rows: dict[str, list[dict[str, Any]]], common: dict[str, Any]) -> None:
    place = {**common, "observed_at_m": 62.94}
    size = 0.05 * common["wind_speed_m_per_s"]
    rest = {"vertical_m": 0.0, "horizontal_m": 0.0, "torsional_rad": 0.0, "branch": None, "stability": "unstable"}
    rows["limit_cycles"].append({**place, **rest})
    shape = {"vertical": [0.0, size, 0.0], "horizontal": [0.1, 0.0, 0.5 * size], "torsional": [0.0, 0.01, 0.0]}
    rows["orbits"].append({"cycle": len(rows["limit_cycles"]), **shape})
    cycle = {"vertical_m": size, "horizontal_m": 0.5 * size, "torsional_rad": 0.01, "branch": 0, "stability": "stable"}
    rows["limit_cycles"].append({**place, **cycle})
    lost = {"vertical_m": None, "horizontal_m": None, "torsional_rad": None, "branch": 1, "stability": "unknown"}
    rows["limit_cycles"].append({**place, **lost})


NO_MOTIONS: dict[str, list[dict[str, Any]]] = {"limit_cycles": [], "critical_wind_speeds": [], "orbits": []}
