"""Samples side by side, in stacks; one that fails takes no other with it."""

from collections.abc import Generator, Sequence

import numpy as np
import pytest

from engine.analysis import analyse_stack
from engine.outcome import Fault, InvalidSpec
from engine.progress import Progress, driven
from engine.result import Result
from engine.spec import Analysis, Line, Model
from engine.uncertainty import runs
from engine.uncertainty.outcomes import State
from tests.engine.uncertainty.den_hartog_line import ASKED, DENSITY, RATIO, line_of, onset


def test_samples_come_in_stacks_with_progress_before_each(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runs, "STACK", 2)
    steps: list[Progress] = []
    ratios = [0.003, 0.004, 0.006, 0.008, 0.01]
    found = driven(runs.outcomes([{RATIO: ratio} for ratio in ratios], line_of, ASKED), steps.append)
    assert [step.step for step in steps] == ["samples 1 to 2 of 5", "samples 3 to 4 of 5", "samples 5 to 5 of 5"]
    assert [step.fraction for step in steps] == [0.0, 0.4, 0.8]
    np.testing.assert_allclose([one.onset for one in found], [onset(r, 1.2929, 1.0) for r in ratios], rtol=1e-6)


def test_a_sample_of_which_no_line_follows_is_impossible() -> None:
    def refusing(values: dict[str, float]) -> Line:
        if values[DENSITY] > 1.3:
            raise InvalidSpec(Fault("span.everyday", None, "must not exceed the rated strength"))
        if values[DENSITY] < 1.1:
            raise FloatingPointError("overflow")
        return line_of(values)

    chosen = [{DENSITY: 1.2}, {DENSITY: 1.35}, {DENSITY: 1.25}, {DENSITY: 1.05}]
    found = driven(runs.outcomes(chosen, refusing, ASKED), lambda _: None)  # type: ignore[arg-type]
    assert [one.overall.state for one in found] == [
        State.GALLOPS,
        State.IMPOSSIBLE,
        State.GALLOPS,
        State.UNKNOWN,
    ]
    assert [wind.state for wind in found[1].winds] == [State.IMPOSSIBLE] * len(ASKED.wind_speeds)


def test_a_computation_that_fails_is_unknown_and_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    def failing(lines: Sequence[Line], analysis: Analysis) -> Generator[Progress, None, list[Result]]:
        if any(line.damping.vertical_ratio == 0.006 for line in lines):
            raise np.linalg.LinAlgError("singular")
        return analyse_stack(lines, analysis)

    monkeypatch.setattr(runs, "analyse_stack", failing)
    ratios = [0.003, 0.004, 0.006, 0.008]
    found = driven(runs.outcomes([{RATIO: ratio} for ratio in ratios], line_of, ASKED), lambda _: None)
    assert [one.overall.state for one in found] == [State.GALLOPS, State.GALLOPS, State.UNKNOWN, State.GALLOPS]


def test_samples_are_asked_for_nothing_but_motions_of_the_hybrid_model() -> None:
    asked = runs.sampled_analysis(Analysis(wind_speeds=(6.0, 4.0, 6.0)))
    assert asked.models == (Model.HYBRID,)
    assert asked.wind_speeds == (4.0, 6.0)
