"""Iced hours of weather records by hand."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from engine.outcome import InvalidSpec
from engine.risk.weather import IcedWeather, IcingCriterion, Weather, iced_weather

CRITERION = IcingCriterion()
NORTH_SOUTH = 0.0


def weather(hours: int, **columns: Any) -> Weather:
    """Return a record of dry frost with 5 m/s from the west, with other columns."""
    plain = {
        "hour": np.arange(hours, dtype=np.float64),
        "speed": np.full(hours, 5.0),
        "direction": np.full(hours, math.radians(270.0)),
        "temperature": np.full(hours, -2.0),
        "precipitation": np.zeros(hours),
        "ice_load": np.full(hours, np.nan),
        "freezing_rain": np.full(hours, np.nan),
    }
    return Weather(**(plain | {name: np.array(column, dtype=np.float64) for name, column in columns.items()}))


def found(record: Weather, criterion: IcingCriterion = CRITERION) -> IcedWeather:
    return iced_weather(record, NORTH_SOUTH, criterion)


def events(record: Weather) -> list[int]:
    kept = found(record).record
    return [] if kept is None else [len(winds) for winds in kept.events]


def test_freezing_rain_ices_until_six_hours_of_thaw() -> None:
    rain = np.zeros(30)
    rain[2:4] = 4.0  # 1.12 mm of radial ice an hour
    temperature = np.full(30, -1.0)
    temperature[10:] = 2.0
    iced = found(weather(30, precipitation=rain, temperature=temperature))
    assert iced.record is not None
    assert [len(winds) for winds in iced.record.events] == [13]  # from hour 2; the sixth warm hour is 15
    assert iced.record.events[0][0] == pytest.approx(5.0)
    assert (iced.observed, iced.missing, iced.iced) == (30, 0, 13)
    assert iced.thickest == pytest.approx(2 * 0.28 * 4.0e-3)
    assert iced.record.years == pytest.approx(30.0 / 8766.0)


def test_drizzle_frost_and_thaw_do_not_ice() -> None:
    assert events(weather(9, precipitation=np.full(9, 0.4))) == []
    assert events(weather(9, precipitation=np.full(9, 4.0), temperature=np.full(9, 0.1))) == []
    assert events(weather(9, precipitation=np.full(9, 4.0), temperature=np.full(9, -8.0))) == []
    assert found(weather(9)).record is None


def test_the_record_may_say_what_is_freezing_rain() -> None:
    wet = {"precipitation": np.full(9, 4.0), "temperature": np.full(9, -8.0)}
    assert events(weather(9, **wet, freezing_rain=np.ones(9))) == [9]
    assert events(weather(9, precipitation=np.full(9, 4.0), freezing_rain=np.zeros(9))) == []


def test_an_ice_load_decides_alone() -> None:
    load = [0.0, 0.5, 0.5, 0.05, 0.0, 0.2]
    assert events(weather(6, ice_load=load, precipitation=np.full(6, np.nan))) == [2, 1]
    assert found(weather(6, ice_load=load)).thickest is None


def test_only_the_wind_across_the_line_counts() -> None:
    direction = np.radians([270.0, 90.0, 0.0, 300.0])
    kept = found(weather(4, ice_load=np.ones(4), direction=direction)).record
    assert kept is not None
    assert kept.events[0] == pytest.approx((5.0, 5.0, 0.0, 5.0 * math.cos(math.radians(30.0))), abs=1e-12)
    calm = found(weather(2, ice_load=np.ones(2), speed=[0.0, 5.0], direction=np.full(2, np.nan)))
    assert (calm.missing, calm.record and calm.record.events) == (1, ((0.0,),))


def test_a_short_gap_keeps_the_ice_and_a_long_one_ends_it() -> None:
    rain = np.zeros(40)
    rain[0] = 8.0
    for length, expected in ((6, [34]), (7, [10])):
        hidden = rain.copy()
        hidden[10 : 10 + length] = np.nan
        record = weather(40, precipitation=hidden)
        assert events(record) == expected
        assert (found(record).missing, found(record).gaps, found(record).observed) == (length, 1, 40 - length)


def test_rows_that_are_left_out_are_a_gap() -> None:
    whole = weather(40, ice_load=np.ones(40))
    kept = np.r_[0:10, 30:40]
    names = ("hour", "speed", "direction", "temperature", "precipitation", "ice_load", "freezing_rain")
    some = replace(whole, **{name: getattr(whole, name)[kept] for name in names})
    assert events(some) == [10, 10]
    assert (found(some).missing, found(some).gaps) == (20, 1)


def test_hours_must_rise() -> None:
    with pytest.raises(InvalidSpec, match="must rise from row to row"):
        weather(3, hour=[0.0, 2.0, 2.0])
