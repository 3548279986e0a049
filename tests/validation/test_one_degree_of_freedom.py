"""The quasi-steady theory of vertical galloping, theory section 11, through the whole chain from a line to its rows.

The line is so taut that its vertical modes are sines (lam2 = 3e-4), and only C_y acts, so the closed formula with the
half-sine's 3/4 on a3 holds for each number of loops.
"""

import math
from dataclasses import replace
from functools import lru_cache

import pytest

from engine.result import Result
from engine.spec import Aerodynamics, Analysis, Ice, Line, Model, Wind
from tests.builders import run, stable_cycles, tight_line

A1, A3, RATIO = 0.3, 3.0, 0.002
LOOPS = (1, 2, 3)
WIND_SPEEDS = (3.0, 6.0)
FACTOR = 0.7


def line_of_pure_lift(factor: float = 1.0) -> Line:
    """Return a taut line on which a1 y'/U - a3 (y'/U)^3 acts upwards; alpha = -y'/U turns the sign of the odd terms."""
    line = tight_line(sag_ratio=2e-4, rigidity_ratio=100.0, elements=12)
    none = (0.0, 0.0, 0.0)
    return replace(
        line,
        ice=Ice(Aerodynamics((-A1, 0.0, A3), none, none)),
        wind=Wind(1.25, profile=((0.0, factor), (line.span.length, factor))),
        damping=replace(line.damping, vertical_ratio=RATIO),
    )


@lru_cache
def result(model: Model, factor: float = 1.0) -> Result:
    """Analyse the line."""
    return run(line_of_pure_lift(factor), Analysis(loops=LOOPS, models=(model,), wind_speeds=WIND_SPEEDS))


def one_loop_rate() -> float:
    """Return the angular frequency of a taut string with one loop."""
    line = line_of_pure_lift()
    assert line.span.horizontal_tension is not None
    return math.pi / line.span.length * math.sqrt(line.span.horizontal_tension / line.conductor.mass)


def damping_gain(wind_speed: float) -> float:
    """Return 4 zeta w m/(rho U D): the coefficient per length is that of one loop whatever the loops."""
    line = line_of_pure_lift()
    return 4.0 * RATIO * one_loop_rate() * line.conductor.mass / (1.25 * wind_speed * line.conductor.diameter)


@pytest.mark.parametrize("model", list(Model))
@pytest.mark.parametrize("loops", LOOPS)
@pytest.mark.parametrize("factor", [1.0, FACTOR])
def test_section_11_critical_speed_of_a_line(model: Model, loops: int, factor: float) -> None:
    (row,) = [r for r in result(model, factor).critical_wind_speeds if r.loops == loops]
    # The arc is 1e-7 longer than the chord and lam2 stiffens the odd loops by 4 lam2/pi^4 = 1e-5.
    assert row.wind_speed_m_per_s == pytest.approx(damping_gain(1.0) / A1 / factor, rel=1e-3)
    assert (row.direction, row.crossing, row.type) == ("vertical", "onset", "oscillation")
    assert row.frequency_hz == pytest.approx(loops * one_loop_rate() / (2.0 * math.pi), rel=1e-3)


@pytest.mark.parametrize("loops", LOOPS)
@pytest.mark.parametrize("wind_speed", WIND_SPEEDS)
@pytest.mark.parametrize("factor", [1.0, FACTOR])
def test_section_11_amplitude_of_a_line(loops: int, wind_speed: float, factor: float) -> None:
    (row,) = stable_cycles(result(Model.HYBRID, factor), loops=loops, wind_speed=wind_speed)
    speed = factor * wind_speed
    expected = speed / (loops * one_loop_rate()) * math.sqrt(4.0 / (3.0 * 0.75 * A3) * (A1 - damping_gain(speed)))
    # The formula leaves out higher harmonics, of the order of the aerodynamic damping ratio squared (1e-5).
    assert row.vertical_m == pytest.approx(expected, rel=1e-3)
    assert row.horizontal_m == pytest.approx(0.0, abs=1e-9)
    assert row.torsional_rad == pytest.approx(0.0, abs=1e-9)
    assert row.observed_at_m == pytest.approx(line_of_pure_lift().span.length / (2 * loops), rel=1e-6)


@pytest.mark.parametrize("wind_speed", WIND_SPEEDS)
def test_section_11_finite_element_model_of_one_loop_gallops_alike(wind_speed: float) -> None:
    # With more loops the cubic load drives the mode of three loops at resonance, since the frequencies are 1 : 2 : 3.
    asked = Analysis(loops=(1,), models=(Model.FINITE_ELEMENT,), wind_speeds=WIND_SPEEDS, finite_element_loops=(1,))
    found = run(line_of_pure_lift(), asked)
    (row,) = stable_cycles(found, loops=1, wind_speed=wind_speed, model=Model.FINITE_ELEMENT)
    expected = wind_speed / one_loop_rate() * math.sqrt(4.0 / (2.25 * A3) * (A1 - damping_gain(wind_speed)))
    assert row.vertical_m == pytest.approx(expected, rel=1e-3)
