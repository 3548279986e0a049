from dataclasses import replace
from functools import cache

import pytest

from engine.outcome import Stability
from engine.report.comparisons.device_effects import device_effects, largest_amplitude, lowest_onset
from engine.result import DeviceEffectRow, Result
from engine.spec import Model
from tests.builders import only, run, source_line


@cache
def result() -> Result:
    """Return the twin bundle's result at 4 m/s, one loop of the hybrid model: a rest and a stable cycle."""
    return run(source_line(2), only(Model.HYBRID, loops=(1,), wind_speeds=(4.0,), finite_element_loops=()))


def test_the_lowest_onset_is_that_of_the_model_and_its_loops() -> None:
    (row, *_) = result().critical_wind_speeds
    others = [
        replace(row, wind_speed_m_per_s=1.0, loops=2),
        replace(row, wind_speed_m_per_s=1.0, model=Model.FINITE_ELEMENT),
        replace(row, wind_speed_m_per_s=1.0, crossing="restabilization"),
        replace(row, wind_speed_m_per_s=3.5),
    ]
    found = replace(result(), critical_wind_speeds=(*others, replace(row, wind_speed_m_per_s=2.0)))
    assert lowest_onset(found, Model.HYBRID, 1) == 2.0
    assert lowest_onset(found, Model.HYBRID, 3) is None


def test_the_largest_amplitude_is_that_of_what_lasts() -> None:
    rest, cycle = result().limit_cycles
    small = replace(cycle, vertical_m=0.3, horizontal_m=0.4)
    large = replace(cycle, vertical_m=3.0, horizontal_m=4.0, stability=Stability.UNSTABLE)
    found = replace(result(), limit_cycles=(rest, small, large))
    assert largest_amplitude(found, Model.HYBRID, 1, 4.0) == pytest.approx(0.5)
    assert largest_amplitude(found, Model.HYBRID, 1, 5.0) is None
    unknown = replace(cycle, vertical_m=None, horizontal_m=None, stability=Stability.UNKNOWN)
    assert largest_amplitude(replace(found, limit_cycles=(small, unknown)), Model.HYBRID, 1, 4.0) is None
    quiet = replace(rest, stability=Stability.STABLE)
    assert largest_amplitude(replace(found, limit_cycles=(quiet,)), Model.HYBRID, 1, 4.0) == 0.0


def test_the_results_without_and_with_devices_stand_beside_each_other() -> None:
    rest, _ = result().limit_cycles
    calm = replace(result(), critical_wind_speeds=(), limit_cycles=(replace(rest, stability=Stability.STABLE),))
    onset = result().critical_wind_speeds[0].wind_speed_m_per_s
    size = largest_amplitude(result(), Model.HYBRID, 1, 4.0)
    assert size == pytest.approx(0.157, abs=2e-3)  # theory section 10
    rows = [row for row in device_effects(result(), calm) if row.model is Model.HYBRID]
    assert rows == [DeviceEffectRow(Model.HYBRID, 1, 4.0, onset, None, size, 0.0)]
    windless = [row for row in device_effects(result(), replace(calm, limit_cycles=())) if row.model is Model.HYBRID]
    assert windless == [DeviceEffectRow(Model.HYBRID, 1, None, onset, None, None, None)]
