"""Critical wind speeds in the static state of their own wind speed, and the join of results wind by wind."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from engine.analysis import analyse_stack
from engine.arrays import eigenvalues
from engine.each_wind import critical_in_own_state, joined
from engine.models.critical_wind_speeds import at_wind, state_matrices, unstable_pairs
from engine.outcome import Fault, InvalidSpec
from engine.progress import finished
from engine.result import BifurcationRow, CriticalWindSpeedRow, DenHartog, Result, StaticState
from engine.spec import Analysis, BlowOut, Line, Model, Span, Support, Supports, Wind
from engine.studies.followed import followed
from tests.builders import hybrid, run, source_line

STILL = Result(
    static=StaticState(30e3, 1285.0, 1.5, None, None),
    den_hartog=DenHartog(-0.1, True),
    orbits=(),
    warnings=(),
    engine_version="0",
)
ONSET = CriticalWindSpeedRow(Model.HYBRID, 1, 5.0, "onset", "oscillation", "vertical", 0.4, 1)


def swinging(wind_speed: float | None) -> Line:
    """Return a slack single span that wind swings far out, damped so that it gallops only in strong wind."""
    line = source_line(1)
    dead_ends = Supports(left=Support(dead_end=True), right=Support(dead_end=True))
    return replace(
        line,
        span=Span(100.0, horizontal_tension=12_000.0),
        supports=dead_ends,
        damping=replace(line.damping, vertical_ratio=0.002, horizontal_ratio=0.002),
        wind=Wind(1.2929, blow_out=BlowOut(wind_speed, 1.0)),
    )


def test_critical_wind_speeds_are_fixed_points_of_their_static_states() -> None:
    def rows_at(wind_speeds: Sequence[float]) -> list[tuple[CriticalWindSpeedRow, ...]]:
        # In the state of U an onset at 5 + 0.3 U and a restabilization at 24 - U^2/40, which vanishes beyond 20 m/s.
        found = []
        for u in wind_speeds:
            rows = [replace(ONSET, wind_speed_m_per_s=5.0 + 0.3 * u)]
            if u < 20.0:
                rows.append(replace(ONSET, wind_speed_m_per_s=24.0 - u**2 / 40.0, crossing="restabilization"))
            found.append(tuple(rows))
        return found

    rows, unsettled = critical_in_own_state(rows_at, 30.0)
    assert unsettled == 0
    assert [row.crossing for row in rows] == ["onset", "restabilization"]
    again = 20.0 * (math.sqrt(1.0 + 24.0 / 10.0) - 1.0)  # 24 - U^2/40 = U
    assert [row.wind_speed_m_per_s for row in rows] == pytest.approx([5.0 / 0.7, again], rel=1e-8)


def test_states_that_lead_nowhere_are_counted() -> None:
    def rows_at(wind_speeds: Sequence[float]) -> list[tuple[CriticalWindSpeedRow, ...]]:
        # The critical wind speed jumps past that of its state.
        return [(replace(ONSET, wind_speed_m_per_s=8.0 if u >= 9.0 else 10.0),) for u in wind_speeds]

    rows, unsettled = critical_in_own_state(rows_at, 30.0)
    assert rows == ()
    assert unsettled > 0


@pytest.fixture(scope="module")
def analysed() -> tuple[Result, Analysis]:
    asked = Analysis(loops=(1, 2), models=(Model.HYBRID,), wind_speeds=(6.0, 14.0), critical_wind_limit=20.0)
    return run(swinging(None), asked), asked


def test_rows_at_each_wind_are_those_of_its_own_blow_out(analysed: tuple[Result, Analysis]) -> None:
    result, asked = analysed
    first = 0
    for wind in asked.wind_speeds:
        alone = run(swinging(wind), replace(asked, wind_speeds=(wind,)))
        last = first + len(alone.limit_cycles)
        assert result.limit_cycles[first:last] == alone.limit_cycles
        own = [replace(orbit, cycle=orbit.cycle - first) for orbit in result.orbits if first <= orbit.cycle < last]
        assert tuple(own) == alone.orbits
        first = last
    assert first == len(result.limit_cycles)
    assert result.frequencies == run(swinging(0.0), replace(asked, wind_speeds=())).frequencies


def test_the_span_loses_its_stability_at_the_critical_wind_speeds(analysed: tuple[Result, Analysis]) -> None:
    result, asked = analysed
    rows = {loops: [row for row in result.critical_wind_speeds if row.loops == loops] for loops in asked.loops}
    assert [len(own) for own in rows.values()] == [1, 0]
    for loops, own in rows.items():
        speeds = [0.5 * i for i in range(1, 41)] + [row.wind_speed_m_per_s * f for row in own for f in (0.9999, 1.0001)]
        for speed in speeds:
            matrices = at_wind(state_matrices(hybrid(swinging(speed), loops)), np.array([[speed]]))
            unstable = int(unstable_pairs(eigenvalues(matrices))[0, 0])
            assert unstable == sum(row.wind_speed_m_per_s < speed for row in own)
    still = run(swinging(0.0), replace(asked, wind_speeds=())).critical_wind_speeds
    assert [row.loops for row in still] == [2]  # in the state of still air it would be the other number of loops


def test_lines_that_follow_the_wind_keep_their_place_in_a_stack() -> None:
    asked = Analysis(loops=(1,), models=(Model.HYBRID,), wind_speeds=(), critical_wind_limit=20.0)
    lines = [swinging(15.0), swinging(None), swinging(0.0)]
    together = finished(analyse_stack(lines, asked))
    alone = [run(line, asked) for line in lines]
    tensions = [result.static.horizontal_tension_n for result in together]
    assert tensions == pytest.approx([result.static.horizontal_tension_n for result in alone], rel=1e-12)
    assert tensions[0] > 1.01 * tensions[2]
    found = [[row.wind_speed_m_per_s for row in result.critical_wind_speeds] for result in together]
    for own, expected in zip(found, alone, strict=True):
        assert own == pytest.approx([row.wind_speed_m_per_s for row in expected.critical_wind_speeds], rel=1e-7)


def test_bifurcations_know_how_far_their_static_state_is() -> None:
    def at(wind: float, fold: float) -> tuple[float, Result]:
        rows = (
            BifurcationRow(Model.HYBRID, 1, 0, "hopf", wind - 1.0, 0.3, None, 1e-9),
            BifurcationRow(Model.HYBRID, 1, 0, "fold", fold, 0.4, None, 0.01),
        )
        return wind, replace(STILL, bifurcations=rows)

    own = replace(ONSET, wind_speed_m_per_s=4.5, frequency_hz=0.42)
    states = (at(5.0, 6.2), at(10.0, 7.2))
    rows = joined(STILL, states, ((own,), 0)).bifurcations
    assert [(row.type, row.wind_speed_m_per_s) for row in rows] == [("hopf", 4.5), ("fold", 6.2)]
    assert rows[0].frequency_hz == 0.42
    # 1 m/s a step of 5 m/s between the states, and 1.2 m/s from its own state.
    assert rows[1].uncertainty_m_per_s == pytest.approx(0.01 + 0.2 * 1.2, rel=1e-12)
    alone = joined(STILL, states[:1], ((own,), 2))
    assert alone.bifurcations[1].uncertainty_m_per_s == pytest.approx(0.01 + 1.2, rel=1e-12)
    assert "2 critical wind speeds" in alone.warnings[-1]


def test_cycles_are_not_followed_over_a_field_where_the_wind_moves_the_state() -> None:
    asked = Analysis(loops=(1,), models=(Model.HYBRID,), wind_speeds=(6.0,))
    with pytest.raises(InvalidSpec) as refused:
        followed(lambda _: swinging(None), [1.0, 2.0], [], asked)
    assert refused.value.faults[0] == Fault(
        "wind.blow_out.wind_speed", None, "must be given where cycles are followed over a field"
    )
