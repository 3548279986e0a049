"""Iced hours of an hourly weather record: by its ice load, or by freezing rain that stays until it has melted."""

import math
from dataclasses import dataclass, fields

import numpy as np

from engine.arrays import FloatArray
from engine.outcome import Fault, require
from engine.spec import YEAR_HOURS, IcedRecord

_MM = 1e-3


@dataclass(frozen=True, slots=True)
class Weather:
    """A record: whole hours from any start, rising, and what was measured in each, NaN where it was not: (n,) each.

    speed [m/s] and direction, from which the wind comes, clockwise from north [rad]; temperature [degrees Celsius];
    precipitation [mm/h]; ice_load [kg/m]; freezing_rain: 1 where the precipitation was seen to be that, 0 where not.
    """

    hour: FloatArray
    speed: FloatArray
    direction: FloatArray
    temperature: FloatArray
    precipitation: FloatArray
    ice_load: FloatArray
    freezing_rain: FloatArray

    def __post_init__(self) -> None:
        """Check that the hours rise."""
        still = np.flatnonzero(np.diff(self.hour) <= 0.0)
        rule = "must rise from row to row, one row an hour"
        require(
            Fault("hour", 0, "must hold two hours or more") if self.hour.size < 2 else None,
            Fault("hour", int(still[0]) + 1, rule) if still.size else None,
        )


@dataclass(frozen=True, slots=True)
class IcingCriterion:
    """When a line is iced.

    By an ice load of least_load [kg/m], where a record has one. Else ice grows in hours with least_precipitation [mm/h]
    or more by radial_share of it, if it is freezing rain: as the record says, else from coldest to warmest [degrees
    Celsius]. It stays until the temperature has been above melts_at for melting_hours. The line is iced from
    least_thickness [m] on.

    Sources: Sanders and Barjenbruch, Weather and Forecasting 31 (2016): 1255 hours of 0.5 mm/h or more, median share of
    radial ice 0.28, quartiles 0.20 and 0.40. Finnish icing atlas: ice melts and falls after two steps of 3 h above
    0.5 degrees. Assumed: coldest (-2 to -10), least_thickness (0.5 to 3 mm), least_load (0.02 to 0.2 kg/m).
    """

    least_precipitation: float = 0.5
    radial_share: float = 0.28
    coldest: float = -5.0
    warmest: float = 0.0
    melts_at: float = 0.5
    melting_hours: int = 6
    least_thickness: float = 1e-3
    least_load: float = 0.1
    bridged_hours: int = 6


@dataclass(frozen=True, slots=True)
class IcedWeather:
    """What a record says: events of iced hours, hours observed and missing, gaps, and the thickest ice [m].

    record is None if no hour was iced; thickest is None by an ice load.
    """

    record: IcedRecord | None
    observed: int
    missing: int
    gaps: int
    iced: int
    thickest: float | None


def iced_weather(weather: Weather, azimuth: float, criterion: IcingCriterion) -> IcedWeather:
    """Return the iced hours of a record, and the wind across the line in each.

    An hour without its ice or its wind is missing: it counts neither as iced nor as observed. Over up to bridged_hours
    in a row the ice stays as it was; over more it is taken to have fallen, and a new event begins.

    Parameters
    ----------
    weather : Weather
    azimuth : float
        Direction of the line, clockwise from north [rad].
    criterion : IcingCriterion
    """
    whole = _dense(weather)
    by_load = bool(np.isfinite(weather.ice_load).any())
    iced, thickest = _by_load(whole, criterion) if by_load else _by_rain(whole, criterion)
    along = (whole.speed > 0.0) & np.isnan(whole.direction)
    across = np.where(along, np.nan, whole.speed * np.abs(np.sin(np.nan_to_num(whole.direction) - azimuth)))
    missing = np.isnan(iced) | np.isnan(across)
    observed = int((~missing).sum())
    events = _events(iced, across, criterion.bridged_hours)
    starts = missing & ~np.concatenate([[False], missing[:-1]])
    return IcedWeather(
        record=IcedRecord(observed / YEAR_HOURS, events) if events else None,
        observed=observed,
        missing=int(missing.sum()),
        gaps=int(starts.sum()),
        iced=sum(map(len, events)),
        thickest=None if by_load else thickest,
    )


def _dense(weather: Weather) -> Weather:
    """Return the record with a row for every hour from its first to its last."""
    place = (weather.hour - weather.hour[0]).astype(np.intp)
    values = {}
    for field in fields(Weather):
        values[field.name] = np.full(place[-1] + 1, np.nan)
        values[field.name][place] = getattr(weather, field.name)
    values["hour"] = np.arange(place[-1] + 1, dtype=np.float64)
    return Weather(**values)


def _by_load(weather: Weather, criterion: IcingCriterion) -> tuple[FloatArray, float]:
    load = weather.ice_load
    return np.where(np.isnan(load), np.nan, load >= criterion.least_load), math.nan


def _by_rain(weather: Weather, criterion: IcingCriterion) -> tuple[FloatArray, float]:
    """Return whether the line is iced in each hour, NaN where that is not known, and the thickest ice [m]."""
    said = bool(np.isfinite(weather.freezing_rain).any())
    between = (weather.temperature >= criterion.coldest) & (weather.temperature <= criterion.warmest)
    freezing = weather.freezing_rain == 1.0 if said else between
    needed = [weather.temperature, weather.precipitation, *([weather.freezing_rain] if said else [])]
    unknown = np.isnan(np.sum(needed, axis=0))
    grows = freezing & (weather.precipitation >= criterion.least_precipitation)
    growth = np.where(grows & ~unknown, _MM * criterion.radial_share * weather.precipitation, 0.0)
    thickness, warm, lost, thickest = 0.0, 0, 0, 0.0
    iced = np.full(unknown.size, np.nan)
    for i, temperature in enumerate(weather.temperature.tolist()):
        if unknown[i]:
            lost += 1
            thickness = thickness if lost <= criterion.bridged_hours else 0.0
            continue
        lost, warm = 0, warm + 1 if temperature > criterion.melts_at else 0
        thickness = 0.0 if warm >= criterion.melting_hours else thickness + float(growth[i])
        thickest = max(thickest, thickness)
        iced[i] = thickness >= criterion.least_thickness
    return iced, thickest


def _events(iced: FloatArray, across: FloatArray, bridged: int) -> tuple[tuple[float, ...], ...]:
    """Return the winds across the line in the observed hours of each event [m/s]."""
    events: list[list[float]] = [[]]
    lost = 0
    for state, wind in zip(iced.tolist(), across.tolist(), strict=True):
        lost = lost + 1 if math.isnan(state) else 0
        if state == 0.0 or lost > bridged:
            events += [[]] if events[-1] else []
        elif state == 1.0 and not math.isnan(wind):
            events[-1].append(wind)
    return tuple(tuple(winds) for winds in events if winds)
