"""The request of a job with sliders moved: to look at, which takes the least, and as a job, which takes it whole."""

from collections.abc import Mapping, Sequence
from typing import Any

from app.pages.what_if.documents import Line, copy_of, number_at, pendulum, places_along, put
from app.pages.what_if.sliders import Slider, moves

_MOST_LOOPS = 2
_PENDULUM = ("pendulum_mass", "pendulum_place", "pendulum_arm")


def to_look(
    request: Mapping[str, Any], explicit: Line, found: Mapping[str, Slider], fields: Mapping[str, str]
) -> dict[str, Any]:
    """Return what is computed while a slider moves: the hybrid model, few loops, whole curves."""
    line, analysis = moved_line(request["line"], explicit, found, fields), request.get("analysis") or {}
    wind, top = _wind(found, fields), max(speeds_of(analysis), default=0.0)
    kept = {name: value for name, value in analysis.items() if name not in {"uncertainty", "check", "risk"}}
    asked = {
        "loops": loops_looked_at(request),
        "models": ["hybrid"],
        "wind_speeds_m_per_s": sorted({wind, max(top, wind)}),
        "amplitude_curves": "reported",
        "loop_competition": "neglected",
        "device_effect": "neglected",
    }
    return {"line": {**line, "design_wind_m_per_s": wind}, "analysis": {**kept, **asked}}


def loops_looked_at(request: Mapping[str, Any]) -> list[int]:
    """Return the numbers of loops that are computed while a slider moves: the first ones of the request."""
    return list((request.get("analysis") or {}).get("loops") or [1, 2])[:_MOST_LOOPS]


def as_job(
    request: Mapping[str, Any], explicit: Line, found: Mapping[str, Slider], fields: Mapping[str, str]
) -> dict[str, Any]:
    """Return the whole request with the moved line; a wind speed that was moved joins those that it asks for."""
    made = {name: value for name, value in request.items() if name not in {"study", "placement", "known"}}
    made["line"] = moved_line(request["line"], explicit, found, fields)
    if "wind" in moves(found, fields):
        wind, analysis = _wind(found, fields), dict(request.get("analysis") or {})
        made["line"]["design_wind_m_per_s"] = wind
        made["analysis"] = {**analysis, "wind_speeds_m_per_s": sorted({*speeds_of(analysis), wind})}
    return made


def moved_line(line: Line, explicit: Line, found: Mapping[str, Slider], fields: Mapping[str, str]) -> dict[str, Any]:
    """Return the line as it was said, with the values of the sliders that were moved."""
    made, said = copy_of(line), moves(found, fields)
    if "span" in said:
        _stretch(made, line, said["span"])
    for name, value in said.items():
        place = found[name].place
        if place is not None:
            put(made, place, value)
    if "damping_vertical_ratio" in said:
        put(made, ("damping", "horizontal_ratio"), _horizontal_damping(line, explicit, said["damping_vertical_ratio"]))
    if not said.keys().isdisjoint(_PENDULUM):
        _hang(made, found, said)
    return made


def speeds_of(analysis: Mapping[str, Any]) -> Sequence[float]:
    """Return the wind speeds that an analysis names [m/s]."""
    said = analysis.get("wind_speeds_m_per_s")
    if isinstance(said, Mapping):
        first, last, count = said["start"], said["stop"], said["count"]
        step = (last - first) / (count - 1)
        return [*(first + step * number for number in range(count - 1)), last]
    return list(said or ())


def _wind(found: Mapping[str, Slider], fields: Mapping[str, str]) -> float:
    slider = found["wind"]
    return moves(found, fields).get("wind", slider.value / slider.factor)


def _stretch(made: dict[str, Any], line: Line, length: float) -> None:
    """Move everything that is mounted along the span in proportion to its length."""
    before = number_at(line, ("span", "length_m"), "m") or length
    for place in places_along(line):
        position = number_at(line, place, "m")
        if position is not None:
            put(made, place, min(position * length / before, length))


def _horizontal_damping(line: Line, explicit: Line, vertical: float) -> float:
    """Return the horizontal damping ratio that keeps its ratio to the vertical one."""

    def ratio(direction: str) -> float:
        place = ("damping", f"{direction}_ratio")
        said = number_at(line, place, "1")
        return (number_at(explicit, place, "1") if said is None else said) or 0.0

    before = ratio("vertical")
    return float(f"{vertical * ratio('horizontal') / before:.5g}") if before else vertical


def _hang(made: dict[str, Any], found: Mapping[str, Slider], said: Mapping[str, float]) -> None:
    """Set mass, place and arm of the first pendulum; a mass of zero takes it away, any other may add one."""
    mass, share, arm = (said.get(name, found[name].value / found[name].factor) for name in _PENDULUM)
    devices = list(made.get("devices") or ())
    number = pendulum(made)
    length = number_at(made, ("span", "length_m"), "m") or 0.0
    before = {"type": "detuning_pendulum"} if number is None else devices.pop(number)
    if mass > 0.0:
        moved = {**before, "position_m": float(f"{share * length:.6g}"), "mass_kg": mass, "arm_m": arm}
        devices.insert(len(devices) if number is None else number, moved)
    made["devices"] = devices
