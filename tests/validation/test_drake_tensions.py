"""Published tensions of Drake on a 700 ft span (NESC heavy, final) hold its row of the catalogue: 5,429 lb at 60 F,
bare, 9,224 lb at 32 F with half an inch of ice, 11,318 lb at 0 F with ice and 4 lb/ft2, to which NESC adds 0.3 lb/ft.

The change of state is that of an elastic catenary, written out here without the engine.
"""

import math

import pytest
from scipy.optimize import brentq

from app.reference.conductors import named

(DRAKE,) = named("795 kcmil 26/7")
POUND, FOOT, INCH = 4.4482216, 0.3048, 0.0254
LENGTH = 700.0 * FOOT
ICE = 57.0 * 16.01846 * 9.80665 * math.pi * 0.5 * INCH * (1.108 + 0.5) * INCH  # 57 lb/ft3 [N/m]
BARE = 1.094 * POUND / FOOT
ICED = BARE + ICE
WINDY = math.hypot(ICED, 4.0 * POUND / FOOT**2 * 2.108 * INCH) + 0.3 * POUND / FOOT


def supported(horizontal: float, weight: float) -> float:
    """Return the tension at the ends of a level span [N]."""
    return horizontal * math.cosh(0.5 * weight * LENGTH / horizontal)


def unstretched(horizontal: float, weight: float, warmer: float, modulus: float) -> float:
    """Return the length without tension at 60 F [m], with the strain of the horizontal tension."""
    assert DRAKE.area_m2 is not None
    assert DRAKE.thermal_expansion_per_k is not None
    arc = 2.0 * horizontal / weight * math.sinh(0.5 * weight * LENGTH / horizontal)
    return arc / (1.0 + horizontal / (modulus * DRAKE.area_m2) + DRAKE.thermal_expansion_per_k * warmer)


def tension(weight: float, fahrenheit: float, modulus: float) -> float:
    """Return the tension at the ends [lb]."""
    everyday = brentq(lambda h: supported(h, BARE) - 5429.0 * POUND, 1e4, 5e4)
    length = unstretched(everyday, BARE, 0.0, modulus)
    warmer = (fahrenheit - 60.0) / 1.8
    horizontal = brentq(lambda h: unstretched(h, weight, warmer, modulus) - length, 1e4, 2e5)
    return supported(horizontal, weight) / POUND


def test_the_row_gives_the_published_tensions_within_two_thousandths() -> None:
    assert DRAKE.youngs_modulus_pa is not None
    assert tension(ICED, 32.0, DRAKE.youngs_modulus_pa) == pytest.approx(9224.0, rel=2e-3)
    assert tension(WINDY, 0.0, DRAKE.youngs_modulus_pa) == pytest.approx(11318.0, rel=2e-3)


def test_the_documented_figures_are_these() -> None:
    found = [tension(ICED, 32.0, m) for m in (69.64e9, 74e9)] + [tension(WINDY, 0.0, m) for m in (69.64e9, 74e9)]
    assert [round(pounds) for pounds in found] == [9233, 9318, 11329, 11484]
