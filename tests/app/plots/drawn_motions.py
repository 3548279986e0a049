"""Motions to draw."""

from typing import Any

from app.plots import Facts
from app.plots.facts import Ellipse, Phase

SPEEDS = (4.0, 5.0, 6.0)
FACTS = Facts(
    "C11 twin",
    length=126.0,
    sag=1.5,
    tension=30000.0,
    bundle=((0.0, 0.2), (0.0, -0.2)),
    footer=("2 sub-conductors, span 126 m", "wind 4 to 6 m/s, engine 0.1.0"),
)
SURROUNDED = Facts(
    "Drake",
    length=300.0,
    sag=6.0,
    bundle=((0.0, 0.2), (0.0, -0.2)),
    phases=(Phase("top", 7.0, 0.5, 1.5), Phase("\u76f8 B", -6.0, 0.0, None)),
    ellipse=Ellipse(6.0, 2.4, 1.8),
)
Tables = dict[str, list[dict[str, Any]]]


def motions(speeds: tuple[float, ...] = SPEEDS, loops: tuple[int, ...] = (1, 2)) -> Tables:
    """Return rows and orbits of both models: a rest, a stable cycle and one without numbers at each wind speed."""
    names = ("limit_cycles", "critical_wind_speeds", "orbits", "bifurcations", "amplitude_curves")
    rows: Tables = {name: [] for name in names}
    for model in ("hybrid", "finite_element"):
        for count in loops:
            place = {"model": model, "loops": count}
            rows["critical_wind_speeds"].append({**place, "wind_speed_m_per_s": 2.4, "crossing": "onset"})
            hopf = {**place, "branch": 0, "type": "hopf", "wind_speed_m_per_s": 2.4}
            rows["bifurcations"].append(hopf)
            for speed in speeds:
                _add_motions(rows, {**place, "wind_speed_m_per_s": speed})
    return rows


def _add_motions(rows: Tables, common: dict[str, Any]) -> None:
    place = {**common, "observed_at_m": 62.94}
    size = 0.05 * common["wind_speed_m_per_s"]
    place |= {"vertical_ratio": size, "horizontal_ratio": 0.5 * size, "reduced_wind_speed": size}
    rest = {"vertical_m": 0.0, "horizontal_m": 0.0, "torsional_rad": 0.0, "branch": None, "stability": "unstable"}
    rows["limit_cycles"].append({**place, **rest, "kind": "equilibrium"})
    shape = {"vertical": [0.0, size, 0.0], "horizontal": [0.1, 0.0, 0.5 * size], "torsional": [0.0, 0.01, 0.0]}
    rows["orbits"].append({"cycle": len(rows["limit_cycles"]), **shape})
    cycle = {"vertical_m": size, "horizontal_m": 0.5 * size, "torsional_rad": 0.01, "branch": 0, "stability": "stable"}
    rows["limit_cycles"].append({**place, **cycle, "kind": "periodic"})
    lost = {"vertical_m": None, "horizontal_m": None, "torsional_rad": None, "branch": 1, "stability": "unknown"}
    rows["limit_cycles"].append({**place, **lost, "kind": "periodic"})


def curve(points: list[tuple[float, float, str]], *, branch: int = 0) -> list[dict[str, Any]]:
    """Return a curve of the hybrid model's first loop: wind speed, vertical amplitude and stability of each point."""
    return [
        {
            "model": "hybrid",
            "loops": 1,
            "branch": branch,
            "curve": 0,
            "point": number,
            "wind_speed_m_per_s": wind,
            "vertical_m": size,
            "horizontal_m": 0.5 * size,
            "torsional_rad": 0.1 * size,
            "stability": stability,
        }
        for number, (wind, size, stability) in enumerate(points)
    ]


FOLDED = curve(
    [(2.4, 0.0, "unknown"), (4.0, 0.1, "stable"), (8.0, 0.3, "stable"), (6.0, 0.5, "unstable"), (5.0, 0.6, "unstable")]
)
"""A branch that turns back at 8 m/s."""
NO_MOTIONS: Tables = {"limit_cycles": [], "critical_wind_speeds": [], "orbits": []}
