"""Wind ranges read off results: between onsets, restabilizations and folds, and what is not known of them."""

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import pytest

from engine.analysis import analyse
from engine.outcome import Outcome, Stability
from engine.progress import finished
from engine.result import BifurcationRow, CriticalWindSpeedRow, LimitCycleRow, Result
from engine.risk.winds import WindRanges, united, wind_ranges
from engine.spec import Analysis, Model
from tests.builders import source_line

ASKED = Analysis(loops=(1,), models=(Model.HYBRID,), wind_speeds=(2.0, 4.0, 6.0), critical_wind_limit=20.0)
BEYOND = (20.0, math.inf)


@cache
def analysed() -> Result:
    return finished(analyse(source_line(2), ASKED))


def crossing(wind: float, kind: str = "onset", loops: int = 1, type_: str = "oscillation") -> CriticalWindSpeedRow:
    first = analysed().critical_wind_speeds[0]
    return replace(first, wind_speed_m_per_s=wind, crossing=kind, loops=loops, type=type_)  # type: ignore[arg-type]


def at(wind: float, *, moves: bool = False, rest: Stability = Stability.STABLE) -> list[LimitCycleRow]:
    still = next(row for row in analysed().limit_cycles if row.kind == "equilibrium")
    cycle = next(row for row in analysed().limit_cycles if row.stability is Stability.STABLE and row.kind == "periodic")
    rows = [replace(still, wind_speed_m_per_s=wind, stability=rest)]
    return [*rows, replace(cycle, wind_speed_m_per_s=wind)] if moves else rows


def fold(wind: float) -> BifurcationRow:
    return BifurcationRow(Model.HYBRID, 1, 0, "fold", wind, 0.5, None, 0.01)


def ranges(
    crossings: Sequence[CriticalWindSpeedRow],
    rows: Sequence[list[LimitCycleRow]] = (),
    folds: Sequence[BifurcationRow] = (),
) -> WindRanges:
    cycles = tuple(row for part in rows for row in part)
    result = replace(analysed(), critical_wind_speeds=tuple(crossings), limit_cycles=cycles, bifurcations=tuple(folds))
    return wind_ranges(result, ASKED, Model.HYBRID, 1)


CALM, MOVES = at(2.0), at(4.0, moves=True)
TO_THE_END = [CALM, at(19.999)]


def test_a_span_gallops_from_its_onset_to_its_restabilization() -> None:
    found = ranges([crossing(3.0), crossing(9.0, "restabilization"), crossing(12.0)], [CALM, at(10.0)])
    assert found == WindRanges(((3.0, 9.0), (12.0, 20.0)), (BEYOND,))


def test_overlapping_modes_are_counted() -> None:
    found = ranges(
        [crossing(3.0), crossing(5.0), crossing(6.0, "restabilization"), crossing(9.0, "restabilization")],
        [CALM, at(12.0), at(19.0)],
    )
    assert found == WindRanges(((3.0, 9.0),), ((19.0, math.inf),))


def test_a_divergence_and_other_loops_are_not_its_galloping() -> None:
    found = ranges([crossing(3.0, type_="divergence"), crossing(4.0, loops=2)], TO_THE_END)
    assert found == WindRanges((), ((19.999, math.inf),))


def test_rest_that_other_loops_make_unstable_is_no_motion_of_these() -> None:
    shaken = at(6.0, rest=Stability.UNSTABLE)
    assert ranges([crossing(4.0, loops=2)], [CALM, shaken]) == WindRanges((), ((6.0, math.inf),))
    assert ranges([], [CALM, shaken]) == WindRanges((), ((2.0, math.inf),))


def test_without_wind_speeds_stable_rest_tells_nothing() -> None:
    assert ranges([crossing(3.0)]) == WindRanges(((3.0, 20.0),), ((0.0, 3.0), BEYOND))


def test_a_motion_below_the_onset_reaches_down_to_its_fold() -> None:
    onset = crossing(5.0)
    assert ranges([onset], [CALM, MOVES], [fold(3.0)]) == WindRanges(((3.0, 20.0),), (BEYOND,))
    assert ranges([onset], [CALM], [fold(3.0)]) == WindRanges(((3.0, 20.0),), (BEYOND,))
    assert ranges([onset], [CALM, MOVES]) == WindRanges(((4.0, 20.0),), ((2.0, 4.0), BEYOND))
    assert ranges([onset], [CALM, MOVES], [fold(2.5), fold(3.5)]) == WindRanges(((3.5, 20.0),), ((2.5, 3.5), BEYOND))


def test_an_isolated_motion_lies_between_its_folds() -> None:
    rows = [CALM, MOVES, at(6.0)]
    found = ranges([], rows, [fold(3.0), fold(5.0)])
    assert found == WindRanges(((3.0, 5.0),), ((6.0, math.inf),))


def test_a_fold_between_calm_winds_leaves_them_unknown() -> None:
    assert ranges([], [CALM, at(6.0)], [fold(3.0)]) == WindRanges((), ((2.0, math.inf),))
    assert ranges([], [CALM, at(6.0)], [fold(3.0), fold(4.0)]).unknown == ((3.0, 4.0), (6.0, math.inf))


def test_a_missing_number_is_never_calm() -> None:
    lost = [replace(row, vertical_m=None, outcome=Outcome.NO_CONVERGENCE) for row in at(4.0)]
    assert ranges([], [CALM, lost, at(6.0)]) == WindRanges((), ((2.0, math.inf),))
    unbounded = [replace(row, vertical_m=None, outcome=Outcome.NO_BOUNDED_MOTION) for row in at(4.0)]
    assert ranges([crossing(4.5)], [CALM, unbounded]).moving == ((4.0, 20.0),)


def test_a_statically_unstable_span_is_unknown_at_every_wind() -> None:
    broken = [replace(row, vertical_m=None, outcome=Outcome.STATICALLY_UNSTABLE) for row in CALM]
    assert ranges([], [broken]) == WindRanges((), ((0.0, math.inf),))


def test_the_source_line_gallops_from_its_onset_on() -> None:
    onset = analysed().critical_wind_speeds[0].wind_speed_m_per_s
    assert wind_ranges(analysed(), ASKED, Model.HYBRID, 1) == WindRanges(((onset, 20.0),), (BEYOND,))


def test_any_motion_is_the_union_and_what_moves_is_not_unknown() -> None:
    one, two = WindRanges(((3.0, 6.0),), ((8.0, 9.0),)), WindRanges(((5.0, 8.5),), ((0.0, 4.0),))
    assert united([one, two]) == WindRanges(((3.0, 8.5),), ((0.0, 3.0), (8.5, 9.0)))


@pytest.mark.parametrize("factor", [0.5, 1.0])
def test_speeds_scale(factor: float) -> None:
    assert WindRanges(((2.0, 4.0),), (BEYOND,)).scaled(factor) == WindRanges(
        ((2.0 * factor, 4.0 * factor),), ((20.0 * factor, math.inf),)
    )
