"""A change is better only if no figure is worse, and nothing that is unknown counts as better."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.outcome import Outcome, Stability
from engine.result import Change
from engine.spec import DetuningPendulum, Model
from engine.studies.judgement import Figures, common_models, compared, few, figures, is_worse, judged
from tests.builders import only, run, source_line

NUMBERS = st.one_of(st.sampled_from([0.0, math.inf, math.nan]), st.floats(0.01, 30.0))
FIGURES = st.builds(Figures, NUMBERS, st.none() | NUMBERS, st.none() | st.floats(0.1, 10.0))
ASKED = only(Model.HYBRID, loops=(2,), wind_speeds=(2.0, 6.0))
FITTED = replace(source_line(2), devices=(DetuningPendulum(31.0, 15.0, 0.3), DetuningPendulum(95.0, 15.0, 0.3)))


@pytest.mark.parametrize(
    ("without", "changed", "expected"),
    [
        (Figures(2.0, 1.0), Figures(2.5, 0.8), "better"),
        (Figures(2.0, 1.0), Figures(2.5, 1.0), "better"),
        (Figures(2.0, 1.03), Figures(2.2, 1.23), "no_improvement"),
        (Figures(2.0, 1.0), Figures(1.5, 1.0), "worse"),
        (Figures(2.0, 1.0), Figures(2.01, 0.995), "no_improvement"),
        (Figures(2.0, 1.0), Figures(math.nan, 0.0), "undecided"),
        (Figures(2.0, 1.0), Figures(math.inf, 0.0), "better"),
        (Figures(2.0, math.inf), Figures(2.5, 0.5), "undecided"),
        (Figures(2.0, math.inf), Figures(math.inf, 0.0), "better"),
        (Figures(2.0, 1.0), Figures(2.5, math.inf), "no_improvement"),
        (Figures(2.0, 1.0, 4.0), Figures(2.5, 0.8, 3.0), "no_improvement"),
        (Figures(2.0, None), Figures(2.5, None), "better"),
        (Figures(math.inf, 0.0), Figures(math.inf, 0.0), "no_improvement"),
    ],
)
def test_figures_are_compared(without: Figures, changed: Figures, expected: Change) -> None:
    assert compared(without, changed) == expected


@given(FIGURES, FIGURES)
def test_what_is_unknown_or_worse_is_never_better(without: Figures, changed: Figures) -> None:
    found = compared(without, changed)
    if math.isnan(changed.onset) or (
        changed.size is not None and without.size is not None and math.isnan(changed.size)
    ):
        assert found == "undecided"
    if found == "better" and (without.size is None) == (changed.size is None):
        assert compared(changed, without) != "better"
        assert changed.onset >= 0.99 * without.onset
        assert not is_worse(replace(without, distance=None), replace(changed, distance=None))


def test_figures_of_a_result_are_those_of_its_rows() -> None:
    result = run(source_line(2), ASKED)
    found = figures(result, Model.HYBRID, ASKED)
    assert found.onset == pytest.approx(2.2498, rel=1e-3)
    (row,) = [r for r in result.limit_cycles if r.stability is Stability.STABLE and r.wind_speed_m_per_s == 6.0]
    assert found.size == pytest.approx(math.hypot(row.vertical_m or 0.0, row.horizontal_m or 0.0))
    assert common_models(result, result) == [Model.HYBRID]


@pytest.mark.parametrize(
    "change", [{"stability": Stability.UNKNOWN}, {"outcome": Outcome.NO_CONVERGENCE, "vertical_m": None}]
)
def test_a_motion_that_is_not_known_decides_nothing(change: dict[str, object]) -> None:
    result, fitted = run(source_line(2), ASKED), run(FITTED, ASKED)
    assert judged(result, fitted, ASKED) == "better"
    rows = tuple(replace(r, **change) if r.kind != "equilibrium" else r for r in fitted.limit_cycles)  # type: ignore[arg-type]
    assert rows != fitted.limit_cycles
    assert judged(result, replace(fitted, limit_cycles=rows), ASKED) == "undecided"


def test_an_unstable_rest_without_a_stable_motion_is_not_known() -> None:
    fitted = run(FITTED, ASKED)
    rests = tuple(row for row in fitted.limit_cycles if row.kind == "equilibrium")
    size = figures(replace(fitted, limit_cycles=rests), Model.HYBRID, ASKED).size
    assert size is not None
    assert math.isnan(size)


def test_a_few_wind_speeds_hold_the_ends() -> None:
    assert few(()) == ()
    assert few((5.0,)) == (5.0,)
    assert few((10.0, 2.0, 4.0, 6.0, 8.0)) == (2.0, 6.0, 10.0)
