"""The source's studies (paper Figures 4 to 9) and a map, ready to run on any of the source's lines."""

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass, field
from typing import Any

from app.reference.source_lines import example

_DAMPING_RATIO = 0.000515
_FOUR_TO_SIX = {"start": 4.0, "stop": 6.0, "count": 21}
_TENSION = "span.horizontal_tension_n"
_LENGTH = "span.length_m"


def _damping_axis(lowest: float, highest: float) -> dict[str, Any]:
    """Vary both translational damping ratios in 15 steps between two multiples of the source's ratio."""
    shares = (lowest + (highest - lowest) * i / 14 for i in range(15))
    values = [round(_DAMPING_RATIO * share, 9) for share in shares]
    return {"parameter": "damping.vertical_ratio", "also": ["damping.horizontal_ratio"], "values": values}


@dataclass(frozen=True, slots=True)
class _Preset:
    """What a study varies: axes of the line, angle of the ice [deg], numbers of loops and wind speeds [m/s]."""

    axes: list[dict[str, Any]] = field(default_factory=list)
    static_angle_deg: int = 40
    loops: tuple[int, ...] = (1, 2)
    wind_speeds: Any = field(default_factory=lambda: [4.0])


_PRESETS: Mapping[str, _Preset] = {
    "figure-4": _Preset([_damping_axis(0.2, 1.6)]),
    "figure-5": _Preset([_damping_axis(0.05, 1.0)], static_angle_deg=270, loops=(1,)),
    "figure-6": _Preset(static_angle_deg=270, loops=(1,), wind_speeds=_FOUR_TO_SIX),
    "figure-7": _Preset(wind_speeds=_FOUR_TO_SIX),
    "figure-8": _Preset([{"parameter": _TENSION, "values": list(range(24_000, 36_001, 1_000))}]),
    "figure-9": _Preset([{"parameter": _LENGTH, "values": list(range(100, 201, 10))}]),
    "tension-and-span": _Preset(
        [
            {"parameter": _TENSION, "values": list(range(24_000, 36_001, 2_000))},
            {"parameter": _LENGTH, "values": list(range(100, 201, 20))},
        ]
    ),
}

STUDY_NAMES = tuple(_PRESETS)


def study_request(name: str, line: str) -> dict[str, Any]:
    """Return the request document of one of `STUDY_NAMES` for one of the source's lines, with the hybrid model only.

    The studies over wind speed (Figures 6 and 7) vary no field of the line; the analysis lists their wind speeds.

    Raises
    ------
    KeyError
        If there is no such study or line.
    """
    preset = _PRESETS[name]
    request: dict[str, Any] = {
        "line": example(line, preset.static_angle_deg),
        "analysis": {
            "loops": list(preset.loops),
            "models": ["hybrid"],
            "wind_speeds_m_per_s": deepcopy(preset.wind_speeds),
            "physics": "source",
        },
    }
    return request | ({"study": {"axes": deepcopy(preset.axes)}} if preset.axes else {})
