"""Cycles followed over a field of the line: against the analysis of each value alone, through folds, to Hopf points."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from engine.models.critical_wind_speeds import at_wind, critical_wind_speeds, state_matrices
from engine.outcome import InvalidSpec
from engine.result import FollowedBifurcationRow, FollowedCycleRow, LimitCycleRow, Result
from engine.spec import AerodynamicLoad, AerodynamicModel, Analysis, BlowOut, Line, Model, Span, Wind
from engine.studies.followed import followed
from tests.builders import hybrid, only, run, source_line

LineAt = Callable[[float], Line]


def with_torsional_ratio(value: float) -> Line:
    return source_line(1, torsional_ratio=value)


def with_translational_ratios(value: float) -> Line:
    line = source_line(2)
    return replace(line, damping=replace(line.damping, vertical_ratio=value, horizontal_ratio=value))


def with_tension(value: float) -> Line:
    return replace(source_line(3, torsional_ratio=0.0308), span=Span(125.88, horizontal_tension=value))


def points(line_at: LineAt, values: list[float], asked: Analysis) -> list[Result]:
    return [run(line_at(value), asked) for value in values]


def without_cycles(result: Result) -> Result:
    """Leave a result without any cycle to start from."""
    return replace(result, orbits=())


def turns(results: list[Result]) -> list[FollowedBifurcationRow]:
    return [row for result in results for row in result.followed_bifurcations]


Known = tuple[int, float, float, float, float, float, str]


def cycles_of(rows: Iterable[FollowedCycleRow | LimitCycleRow]) -> list[Known]:
    """Return loops, wind speed, amplitudes, frequency and stability of cycles in rising order."""
    return sorted(
        (
            row.loops,
            row.wind_speed_m_per_s,
            row.vertical_m or 0.0,
            row.horizontal_m or 0.0,
            row.torsional_rad or 0.0,
            row.frequency_hz or 0.0,
            row.stability.value,
        )
        for row in rows
    )


def assert_equal_to_points(found: list[Result], alone: list[Result], winds: Sequence[float]) -> None:
    """Compare the followed cycles with those of each value alone."""
    for with_branches, result in zip(found, alone, strict=True):
        rows = [row for row in result.limit_cycles if row.kind == "periodic" and row.wind_speed_m_per_s in winds]
        for own, other in zip(cycles_of(with_branches.followed_cycles), cycles_of(rows), strict=True):
            assert own[:-1] == pytest.approx(other[:-1], rel=1e-5)
            assert own[-1] == other[-1]


def test_one_cycle_gives_both_sides_of_a_fold() -> None:
    # The source's single conductor folds at 5.3200 m/s with a torsional ratio of 0.01: at 5.32 m/s just below 0.01.
    values, asked = [0.0095, 0.00975, 0.0099, 0.0105], only(Model.HYBRID, loops=(1,), wind_speeds=(5.32,))
    alone = points(with_torsional_ratio, values, asked)
    found = followed(with_torsional_ratio, values, alone, asked)
    assert [len(result.followed_cycles) for result in found] == [3, 3, 3, 1]
    assert_equal_to_points(found, points(with_torsional_ratio, values, replace(asked, harmonics=9)), (5.32,))
    known = [without_cycles(result) for result in alone]
    small = min(alone[1].orbits, key=lambda orbit: alone[1].limit_cycles[orbit.cycle].vertical_m or 0.0)
    known[1] = replace(alone[1], orbits=(small,))
    found = followed(with_torsional_ratio, values, known, asked)
    stability = [sorted(row.stability.value for row in result.followed_cycles) for result in found]
    assert stability == [["stable", "unstable"]] * 3 + [[]]
    assert [row.found_by for result in found for row in result.followed_cycles].count("point") == 1
    (fold,) = turns(found)
    assert (fold.type, fold.branch) == ("fold", 0)
    assert fold.uncertainty < 1e-6
    assert len(found[2].followed_bifurcations) == 1
    # Seen over the wind with that ratio, the fold lies at 5.32 m/s.
    over_wind = run(with_torsional_ratio(fold.value), only(Model.HYBRID, loops=(1,), wind_speeds=(5.0, 5.5)))
    folds = [row.wind_speed_m_per_s for row in over_wind.bifurcations if row.type == "fold"]
    assert min(abs(speed - 5.32) for speed in folds) < 1e-5


def test_branches_end_where_the_wind_speed_is_critical() -> None:
    values, asked = [0.0004, 0.0007, 0.002], only(Model.HYBRID, loops=(1, 2), wind_speeds=(4.0,))
    found = followed(with_translational_ratios, values, points(with_translational_ratios, values, asked), asked)
    hopf = {row.loops: row for row in turns(found)}
    assert [row.type for row in hopf.values()] == ["hopf", "hopf"]
    for loops, row in hopf.items():
        first = critical_wind_speeds(hybrid(with_translational_ratios(row.value), loops), 10.0)
        assert first.wind_speed[0] == pytest.approx(4.0, abs=1e-6)
        assert first.angular_frequency[0] == pytest.approx(2.0 * np.pi * row.frequency_hz, rel=1e-6)
        growth = at_wind(state_matrices(hybrid(with_translational_ratios(0.002), loops)), np.array([4.0]))
        assert np.linalg.eigvals(growth).real.max() < 0.0


def test_branches_over_tension_agree_with_every_value_alone() -> None:
    values, asked = [28_000.0, 30_000.0, 33_000.0], only(Model.HYBRID, loops=(1, 2), wind_speeds=(6.0, 12.0))
    alone = points(with_tension, values, asked)
    found = followed(with_tension, values, alone, asked)
    assert_equal_to_points(found, points(with_tension, values, replace(asked, harmonics=9)), asked.wind_speeds)
    branches = {(row.loops, row.wind_speed_m_per_s, row.branch) for row in found[0].followed_cycles}
    assert (2, 12.0, 1) in branches  # the two cycles that coexist lie on branches of their own


def test_a_field_without_a_line_in_between_ends_the_branch() -> None:
    def line_at(value: float) -> Line:
        if 29_100.0 < value < 30_100.0:
            raise InvalidSpec
        return with_tension(value)

    values, asked = [28_000.0, 29_000.0, 31_000.0], only(Model.HYBRID, loops=(1,), wind_speeds=(6.0,))
    alone = points(line_at, values, asked)
    found = followed(line_at, values, [*alone[:1], *(without_cycles(result) for result in alone[1:])], asked)
    assert [len(result.followed_cycles) for result in found] == [1, 1, 0]


def distance(one: Known, other: Known) -> float:
    """Return the distance of the amplitudes of two cycles."""
    return math.dist(one[2:5], other[2:5])


def test_cycles_of_a_blown_out_span_are_read_back_from_vertical_and_horizontal() -> None:
    def blown(value: float) -> Line:
        return replace(source_line(1, torsional_ratio=value), wind=Wind(1.2929, blow_out=BlowOut(25.0, 1.2)))

    asked = only(Model.HYBRID, loops=(1,), wind_speeds=(4.0,))
    values = [0.2, 0.308]
    results = points(blown, values, asked)
    for result, alone in zip(followed(blown, values, results, asked), results, strict=True):
        cycles = cycles_of(row for row in alone.limit_cycles if row.kind == "periodic")
        found = cycles_of(result.followed_cycles)  # also unstable ones that only the other value has a start for
        assert 0 < len(cycles) <= len(found)
        for cycle in cycles:
            near = min(found, key=partial(distance, cycle))
            assert near[:-1] == pytest.approx(cycle[:-1], rel=5e-4)  # four harmonics more
            assert near[-1] == cycle[-1]


def test_an_unexpanded_load_is_refused() -> None:
    asked = Analysis(
        aerodynamic_model=AerodynamicModel.RELATIVE_WIND, aerodynamic_load=AerodynamicLoad.UNEXPANDED, loops=(1,)
    )
    with pytest.raises(InvalidSpec, match="aerodynamic_load must be expanded"):
        followed(with_tension, [24e3, 30e3], [], asked)
