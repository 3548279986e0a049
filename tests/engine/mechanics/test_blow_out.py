"""Tension and plane of a blown-out span: theory section 15."""

from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.mechanics.blow_out import StillSpans, plane_axes, plane_extent, tension_in_wind
from engine.mechanics.catenary import unstressed_length
from engine.mechanics.static_profile import static_profile
from engine.spec import BlowOut, Span, Support, Supports, Wind
from tests.builders import AXIAL_RIGIDITY, source_line

WEIGHT = 2.379 * 9.81
DEAD_ENDS = Supports(left=Support(dead_end=True), right=Support(dead_end=True))


def tensions(length: float, tension: float, supports: Supports) -> FloatArray:
    """Return H of the C11 conductor at 10, 20 and 30 m/s with a drag coefficient of 1 [N]."""
    lines = [
        replace(
            source_line(1),
            span=Span(length, horizontal_tension=tension),
            supports=supports,
            wind=Wind(1.2929, blow_out=BlowOut(speed, 1.0)),
        )
        for speed in (10.0, 20.0, 30.0)
    ]
    return static_profile(lines).horizontal_tension


@pytest.mark.parametrize(
    ("length", "tension", "supports", "expected"),
    [
        (350.0, 60e3, DEAD_ENDS, [60.08, 61.24, 65.67]),
        (350.0, 60e3, Supports(), [60.03, 60.42, 62.01]),
        (125.88, 30e3, DEAD_ENDS, [30.04, 30.63, 32.89]),
        (125.88, 30e3, Supports(), [30.01, 30.21, 31.03]),
    ],
    ids=["350 m, dead ends", "350 m, springs", "126 m, dead ends", "126 m, springs"],
)
def test_tension_in_wind_is_that_of_the_theory_page(
    length: float, tension: float, supports: Supports, expected: list[float]
) -> None:
    assert tensions(length, tension, supports) == pytest.approx(1e3 * np.array(expected), rel=2e-4)


def still(count: int, **changes: float) -> StillSpans:
    """Return equal spans of the C11 conductor between dead ends, with some values changed."""
    values = {"length": 350.0, "rise": 0.0, "weight": WEIGHT, "rigidity": AXIAL_RIGIDITY, "tension": 60e3, "give": 0.0}
    return StillSpans(**{name: np.full(count, value) for name, value in (values | changes).items()})


@pytest.mark.parametrize(
    "changes",
    [{}, {"rise": 120.0}, {"rise": -200.0}, {"give": 2e-5}, {"tension": 3e3}, {"tension": 1e3}, {"weight": 4.0}],
    ids=str,
)
def test_unstressed_length_is_kept_from_still_air_to_storms(changes: dict[str, float]) -> None:
    spans = still(6, **changes)
    tilt = np.radians([0.0, 1e-3, 5.0, 45.0, 75.0, 86.0])
    tension = tension_in_wind(spans, tilt)
    assert tension[0] == spans.tension[0]
    assert (np.diff(tension) > 0.0).all()
    between = spans.length - (tension - spans.tension) * spans.give
    extent, rise = plane_extent(between, spans.rise, tilt)
    length = unstressed_length(tension * extent / between, spans.weight / np.cos(tilt), spans.rigidity, extent, rise)
    before = unstressed_length(spans.tension, spans.weight, spans.rigidity, spans.length, spans.rise)
    assert length == pytest.approx(before, rel=1e-13)


def test_axes_of_the_plane_are_orthonormal_and_hold_chord_and_load() -> None:
    length, rise, tilt = np.full(3, 300.0), np.array([0.0, 60.0, -120.0]), np.radians([30.0, 0.0, 50.0])
    axes = plane_axes(length, rise, tilt)
    assert axes @ axes.swapaxes(-1, -2) == pytest.approx(np.broadcast_to(np.eye(3), axes.shape), abs=1e-15)
    assert np.linalg.det(axes) == pytest.approx(1.0, rel=1e-14)
    chord = np.stack([length, rise, np.zeros(3)], axis=-1)
    load = np.stack([np.zeros(3), -np.cos(tilt), np.sin(tilt)], axis=-1)
    extent, height = plane_extent(length, rise, tilt)
    assert (axes @ chord[..., None])[..., 0] == pytest.approx(np.stack([extent, height, np.zeros(3)], -1), abs=1e-12)
    assert (axes @ load[..., None])[..., 0] == pytest.approx(np.broadcast_to([0.0, -1.0, 0.0], (3, 3)), abs=1e-15)
