"""Studies to draw."""

import itertools
from typing import Any

from app.plots.studies import Study

VALUES: dict[str, list[Any]] = {
    "damping.vertical_ratio": [0.0003, 0.0005, 0.0007],
    "span.horizontal_tension_n": [24000.0, 30000.0],
    "span.length_m": [100.0, 126.0],
    "damping.model": ["constant_ratio", "constant_coefficient"],
    "ice.eccentricity_y_m": [1e-3],
}


def study(*axes: str, winds: tuple[float, ...] = (4.0,), failures: int = 0) -> Study:
    found: dict[str, list[dict[str, Any]]] = {"static": [], "limit_cycles": [], "critical_wind_speeds": []}
    for number, values in enumerate(itertools.product(*(VALUES[axis] for axis in axes))):
        point = dict(zip(axes, values, strict=True))
        found["static"].append({**point, "catenary_parameter_m": 1200.0 + number, "sag_m": 1.5 + 0.1 * number})
        place = {**point, "model": "hybrid", "loops": 1}
        for crossing, speed in (("onset", 2.5 + number), ("onset", 2.0 + number), ("restabilization", 1.0)):
            found["critical_wind_speeds"].append({**place, "crossing": crossing, "wind_speed_m_per_s": speed})
        for wind in winds:
            cycle = {**place, "wind_speed_m_per_s": wind, "reduced_wind_speed": wind / 60.0, "kind": "periodic"}
            ratios = {"vertical_ratio": 0.1 * (1 + number), "horizontal_ratio": 0.02 * wind}
            found["limit_cycles"] += [
                {**cycle, **ratios, "stability": "stable"},
                {**cycle, **ratios, "stability": "unstable"},
                {**cycle, "vertical_ratio": None, "horizontal_ratio": None, "stability": "unknown"},
                {**cycle, "vertical_ratio": 0.0, "horizontal_ratio": 0.0, "stability": "stable", "kind": "equilibrium"},
            ]
    found["failures"] = [{**dict.fromkeys(axes, 1.0), "failure": "x"}] * failures
    return Study(axes, 125.0, found)


NOTHING = Study((), 125.0, {"static": [], "limit_cycles": [], "critical_wind_speeds": []})
