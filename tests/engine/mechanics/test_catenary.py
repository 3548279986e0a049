"""The catenary against its own differential equation, its measures against one another, and elastic solutions."""

import math

import numpy as np
import pytest

from engine.mechanics.catenary import arc_length, catenary_of_sag, chord_sag, low_point, unstressed_length


@pytest.mark.parametrize("rise", [-150.0, -20.0, 0.0, 60.0, 300.0])
@pytest.mark.parametrize("catenary", [90.0, 400.0, 2500.0])
def test_the_curve_passes_through_both_supports(catenary: float, rise: float) -> None:
    c, span, h = (np.array([value]) for value in (catenary, 300.0, rise))
    low = low_point(c, span, h)
    x = np.linspace(0.0, 300.0, 20001)
    y = c * (np.cosh((x - low) / c) - np.cosh(low / c))
    assert y[-1] == pytest.approx(rise, rel=1e-11, abs=1e-9)
    length = np.hypot(np.diff(x), np.diff(y)).sum()
    assert arc_length(c, span, h)[0] == pytest.approx(length, rel=1e-6)
    assert chord_sag(c, span, h)[0] == pytest.approx(0.5 * rise - np.interp(150.0, x, y), rel=1e-9)


@pytest.mark.parametrize("rise", [0.0, 1e-6, -30.0, 80.0])
@pytest.mark.parametrize("ratio", [1e-5, 0.02, 0.3, 2.0])
def test_sag_is_met_from_taut_wires_to_deep_chains(ratio: float, rise: float) -> None:
    c = np.array(catenary_of_sag(80.0 * ratio, 80.0, rise))
    assert float(chord_sag(c, np.array(80.0), np.array(rise))) == pytest.approx(80.0 * ratio, rel=1e-12)


@pytest.mark.parametrize(("tension", "rigidity"), [(30e3, 28.4e6), (8e3, 1e6)])
def test_unstressed_length_is_that_of_the_elastic_catenary(tension: float, rigidity: float) -> None:
    # L = H L_0/EA + 2 H/w asinh(w L_0/(2 H)), theory section 15, has the weight per unstressed length.
    weight, span = 23.3, 300.0
    found = float(unstressed_length(*(np.array([value]) for value in (tension, weight, rigidity, span, 0.0)))[0])
    unstressed_weight = weight * (1.0 + tension / rigidity)
    back = tension * found / rigidity
    back += 2.0 * tension / unstressed_weight * math.asinh(unstressed_weight * found / (2.0 * tension))
    assert back == pytest.approx(span, abs=1e-3 * abs(found - span))


def test_unstressed_length_of_a_slope_is_summed_along_the_curve() -> None:
    tension, weight, rigidity, span, rise = (np.array([value]) for value in (20e3, 23.3, 5e6, 300.0, 120.0))
    c, low = tension / weight, low_point(tension / weight, span, rise)
    x = 300.0 * (np.arange(20000) + 0.5) / 20000
    steepness = np.cosh((x - low) / c)
    expected = (steepness / (1.0 + tension * steepness / rigidity)).sum() * 300.0 / 20000
    assert unstressed_length(tension, weight, rigidity, span, rise)[0] == pytest.approx(expected, rel=1e-9)
