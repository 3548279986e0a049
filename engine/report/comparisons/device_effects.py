"""The table of device effects: critical wind speeds and amplitudes without and with devices."""

import math
from collections.abc import Iterator

from engine.outcome import Stability
from engine.result import DeviceEffectRow, Result
from engine.spec import Model


def device_effects(without: Result, with_devices: Result) -> tuple[DeviceEffectRow, ...]:
    """Compare the results of one line without and with devices.

    Returns
    -------
    tuple of DeviceEffectRow
        A row for each model, number of loops and wind speed; one row without wind speed if none was asked for.
    """
    return tuple(_rows(without, with_devices))


def lowest_onset(result: Result, model: Model, loops: int) -> float | None:
    """Return the lowest critical wind speed of a model and number of loops [m/s]; None if there is no onset."""
    rows = (r for r in result.critical_wind_speeds if (r.model, r.loops, r.crossing) == (model, loops, "onset"))
    return min((row.wind_speed_m_per_s for row in rows), default=None)


def largest_amplitude(result: Result, model: Model, loops: int, wind_speed: float) -> float | None:
    """Return the largest sqrt(V^2 + W^2) of the stable motions [m], 0 at rest; None where none is known."""
    key = (model, loops, wind_speed)
    here = [r for r in result.limit_cycles if (r.model, r.loops, r.wind_speed_m_per_s) == key]
    if any(row.vertical_m is None for row in here):
        return None
    stable = (r for r in here if r.stability is Stability.STABLE)
    return max((math.hypot(r.vertical_m or 0.0, r.horizontal_m or 0.0) for r in stable), default=None)


def _rows(without: Result, with_devices: Result) -> Iterator[DeviceEffectRow]:
    winds = sorted({row.wind_speed_m_per_s for row in with_devices.limit_cycles})
    for model, loops in dict.fromkeys((row.model, row.loops) for row in with_devices.frequencies):
        onsets = [lowest_onset(result, model, loops) for result in (without, with_devices)]
        if not winds:
            yield DeviceEffectRow(model, loops, None, onsets[0], onsets[1], None, None)
        for wind in winds:
            sizes = [largest_amplitude(result, model, loops, wind) for result in (without, with_devices)]
            yield DeviceEffectRow(model, loops, wind, onsets[0], onsets[1], sizes[0], sizes[1])
