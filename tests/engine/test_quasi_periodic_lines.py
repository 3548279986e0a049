"""Three lines whose motion stays quasi-periodic, from the search of docs/validation.md.

There direct integration keeps both spectral lines over 10^4 cycles; here it follows each torus over some of its beats.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from benchmarks.validation.quasi_periodic import SEED, drawn
from engine.cycles.bifurcations import bifurcations
from engine.cycles.search import find_cycles
from engine.cycles.starts import energy_starts
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel, take
from engine.outcome import Stability
from engine.result import Result
from engine.spec import Line, Model, Phase, TorusSearch
from engine.tori.quasi_periodic import QuasiPeriodicMotions, quasi_periodic_motions
from tests.builders import hybrid, only, run
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
