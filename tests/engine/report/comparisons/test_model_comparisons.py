"""The hybrid model's cycles beside the finite element model's, from rows written by hand and from the source's line."""

from dataclasses import replace
from typing import Any

import pytest

from engine.outcome import Outcome, Stability
from engine.report.comparisons.model_comparisons import model_comparisons
from engine.result import LimitCycleRow, columns_of
from engine.spec import Analysis, Model
from tests.builders import only, run, source_line

_SAID: dict[str, Any] = {
    "model": Model.HYBRID,
    "loops": 1,
    "wind_speed_m_per_s": 4.0,
    "branch": 0,
    "kind": "periodic",
    "stability": Stability.STABLE,
    "vertical_m": 0.3,
    "horizontal_m": 0.4,
    "torsional_rad": 0.1,
    "outcome": Outcome.CONVERGED,
}
HYBRID = LimitCycleRow(**{**dict.fromkeys(columns_of(LimitCycleRow)), **_SAID})
OTHER = replace(HYBRID, model=Model.FINITE_ELEMENT, branch=3, vertical_m=0.6, horizontal_m=0.8)


def test_the_nearest_cycle_of_as_many_loops_is_taken() -> None:
    far = replace(OTHER, branch=4, vertical_m=2.0)
    unlike = [replace(OTHER, loops=2, vertical_m=0.3), replace(OTHER, wind_speed_m_per_s=5.0, vertical_m=0.3)]
    (row,) = model_comparisons([HYBRID, far, *unlike, replace(OTHER, stability=Stability.UNSTABLE)])
    assert (row.branch, row.finite_element_branch) == (0, 3)
    assert (row.hybrid_vertical_m, row.finite_element_vertical_m) == (0.3, 0.6)
    assert row.finite_element_stability is Stability.UNSTABLE
    assert row.amplitude_difference == pytest.approx(1.0)


def test_what_the_other_model_lacks_is_none() -> None:
    (row,) = model_comparisons([HYBRID, replace(OTHER, loops=2)])
    assert (row.finite_element_branch, row.finite_element_stability, row.amplitude_difference) == (None, None, None)


def test_only_stable_cycles_of_the_hybrid_model_are_compared_and_only_with_both_models() -> None:
    unstable = replace(HYBRID, stability=Stability.UNSTABLE)
    rest = replace(HYBRID, kind="equilibrium", branch=None, vertical_m=0.0)
    assert model_comparisons([unstable, rest, OTHER]) == ()
    assert model_comparisons([HYBRID]) == ()


def test_at_one_loop_the_models_agree_on_the_twin_bundle() -> None:
    rows = run(source_line(2), Analysis(wind_speeds=(4.0,))).model_comparisons
    difference = {row.loops: row.amplitude_difference for row in rows}
    assert difference[1] == pytest.approx(0.0, abs=1e-3)
    assert difference[2] == pytest.approx(-0.16, abs=0.02)  # docs/validation.md: 0.1 % of detuning
    assert run(source_line(2), only(Model.HYBRID, wind_speeds=(4.0,))).model_comparisons == ()
