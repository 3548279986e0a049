"""Lines whose motion stays quasi-periodic.

Three are from the search of docs/validation.md: there direct integration keeps both spectral lines over 10^4 cycles;
here it follows each torus over some of its beats. Of the others a multiple of another line is the strongest of the
spectrum: they are long quad bundles with light damping.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from benchmarks.validation.quasi_periodic import SEED, drawn
from engine.arrays import FloatArray, IntArray
from engine.cycles.bifurcations import bifurcations
from engine.cycles.search import find_cycles
from engine.cycles.starts import energy_starts
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel, take
from engine.outcome import Stability
from engine.result import Result
from engine.spec import Aerodynamics, Damping, Ice, Line, Model, Phase, Span, TorusSearch
from engine.tori import spectrum
from engine.tori.quasi_periodic import QuasiPeriodicMotions, quasi_periodic_motions
from engine.tori.spectrum import base_lines
from tests.builders import ICE_AT_40, hybrid, only, run, source_line
from tests.engine.integrated_tori import followed

# number in the generator, wind speed [m/s], both frequencies [Hz]
LINES = [(26, 15.0, (0.21635, 0.20902)), (76, 13.0, (0.1692, 0.1523)), (197, 11.0, (0.2439, 0.2298))]
BEATS = 1.5


@cache
def lines() -> list[Line]:
    generator = np.random.default_rng(SEED)
    return [drawn(generator) for _ in range(max(number for number, _, _ in LINES) + 1)]


def torus_of(line: Line, wind: float) -> tuple[ReducedModel, QuasiPeriodicMotions]:
    model, winds = take(hybrid(line), [0]), np.array([wind])
    crossings = critical_wind_speeds(model, 30.0)
    cycles = find_cycles(model, crossings, winds, energy_starts(model, winds, 5), 5)
    found = bifurcations(cycles.branch_sets, cycles.followed, model, crossings)
    return model, quasi_periodic_motions(model, cycles, found, winds, TorusSearch.LASTING)


def with_phases(line: Line, wind: float) -> Result:
    return run(replace(line, phases=(Phase("top", 30.0, 0.0),)), only(Model.HYBRID, loops=(1,), wind_speeds=(wind,)))


@pytest.mark.parametrize(("number", "wind", "frequencies"), LINES)
def test_a_line_that_stays_quasi_periodic(number: int, wind: float, frequencies: tuple[float, float]) -> None:
    result = with_phases(lines()[number], wind)
    (row,) = (row for row in result.limit_cycles if row.kind == "quasi_periodic")
    assert [one for one in result.limit_cycles if one.stability is Stability.STABLE] == [row]  # nothing else lasts
    assert (row.frequency_hz, row.second_frequency_hz) == pytest.approx(frequencies, rel=5e-4)
    assert row.vertical_m is not None
    assert row.vertical_min_m is not None
    model, found = torus_of(lines()[number], wind)
    periods = BEATS * float(found.tori.angular_frequency[0, 0] / found.tori.angular_frequency[0, 1])
    reached, expected = followed(model, found.tori, abs(periods))
    assert reached == pytest.approx(expected, abs=2e-3 * np.abs(expected).max())
    # The beat is deep: a cycle of its mean size would miss the range.
    assert row.vertical_min_m < 0.9 * row.vertical_m
    # Its range is not about the position at rest, and a copy above it may come down as far as it goes up.
    top, bottom = float(reached[:, 0].max()), float(reached[:, 0].min())
    assert row.vertical_middle_m is not None
    assert row.vertical_middle_m / row.vertical_m == pytest.approx((top + bottom) / (top - bottom), abs=0.02)
    near = [one for one in result.clearances if one.method == "computed" and one.stability is Stability.STABLE]
    size = row.vertical_m
    assert [one.distance_m for one in near] == [pytest.approx(30.0 - 2.0 * size, rel=0.03)]
    integrated = 0.5 * np.ptp(reached[:, :3], axis=0)
    balanced = 0.5 * np.ptp(expected[:, :3], axis=0)
    assert integrated == pytest.approx(balanced, rel=5e-3)


def long_quad(seed: int) -> Line:
    generator = np.random.default_rng(seed)
    length, tension, vertical, horizontal = generator.uniform(0.98, 1.02, 4) * (347.7, 37738.0, 2.968e-3, 1.22e-4)
    line = source_line(4)
    lift, drag, moment = (
        (first, *cubic[1:])
        for first, cubic in zip(
            (-1.2406, -0.8634, 1.8938), (ICE_AT_40.vertical, ICE_AT_40.horizontal, ICE_AT_40.torsional), strict=True
        )
    )
    return replace(
        line,
        span=Span(length=float(length), horizontal_tension=float(tension)),
        conductor=replace(line.conductor, torsional_rigidity=303.0),
        ice=Ice(Aerodynamics(lift, drag, moment), 9.492e-5, -1.5505e-3),
        damping=Damping(float(vertical), float(horizontal), 4.044e-3),
    )


@pytest.mark.parametrize("seed", range(2))
def test_a_strongest_line_that_is_a_multiple_of_another_is_no_base(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    multiples: list[bool] = []

    def noted(strengths: FloatArray, pairs: IntArray) -> IntArray:
        multiples.append(bool(np.gcd(*pairs[1 + strengths[1:].argmax()]) != 1))
        return base_lines(strengths, pairs)

    monkeypatch.setattr(spectrum, "base_lines", noted)
    result = run(long_quad(seed), only(Model.HYBRID, loops=(1,), wind_speeds=(13.4, 18.0)))
    assert any(multiples)
    told = (row for row in result.limit_cycles if row.stability is Stability.STABLE or row.vertical_m is None)
    assert {row.wind_speed_m_per_s for row in told} == {13.4, 18.0}
