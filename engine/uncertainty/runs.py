"""Analyse samples side by side, in stacks of limited size, so that memory stays bounded and the caller can stop."""

from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import replace

from engine.analysis import analyse_stack
from engine.arrays import placed
from engine.outcome import InvalidSpec
from engine.progress import Progress, finished
from engine.result import Result
from engine.risk.expectation import ranges_across
from engine.spec import (
    AmplitudeCurves,
    Analysis,
    Check,
    DeviceEffect,
    Line,
    LoopCompetition,
    Model,
    TorusSearch,
)
from engine.uncertainty.outcomes import SampleOutcome, State, sample_outcome, without_answer

STACK = 64

LineOf = Callable[[Mapping[str, float]], Line]


def sampled_analysis(analysis: Analysis) -> Analysis:
    """Return what is asked of every sample: the hybrid model's motions, and nothing that only adds to a report.

    Whether anything bounds a motion is not asked: the integrations that tell take up to a hundred times as long as all
    else, and what is left without them, a galloping span of unknown size, weighs as much.
    """
    return replace(
        analysis,
        models=(Model.HYBRID,),
        wind_speeds=tuple(sorted(set(analysis.wind_speeds))),
        loop_competition=LoopCompetition.NEGLECTED,
        device_effect=DeviceEffect.NEGLECTED,
        amplitude_curves=AmplitudeCurves.NEGLECTED,
        check=Check.NONE,
        quasi_periodic=TorusSearch.LASTING,
        settle=False,
    )


def outcomes(
    chosen: Sequence[Mapping[str, float]], line_of: LineOf, analysis: Analysis
) -> Generator[Progress, None, list[SampleOutcome]]:
    """Return what becomes of a line with other values.

    Parameters
    ----------
    chosen : sequence of mappings
        Values by path, one mapping for each sample.
    line_of : callable
        Gives the line of chosen values; its `InvalidSpec` is an outcome of the sample.
    analysis : Analysis

    Yields
    ------
    Progress
        Before every stack.
    """
    asked = sampled_analysis(analysis)
    found: list[SampleOutcome] = []
    for first in range(0, len(chosen), STACK):
        last = min(first + STACK, len(chosen))
        yield Progress(first / len(chosen), f"samples {first + 1} to {last} of {len(chosen)}")
        found += _outcomes(chosen[first:last], line_of, asked)
    return found


def _outcomes(chosen: Sequence[Mapping[str, float]], line_of: LineOf, asked: Analysis) -> list[SampleOutcome]:
    lines = [_line(values, line_of) for values in chosen]
    results = analysed([line for line in lines if isinstance(line, Line)], asked)
    answers: list[SampleOutcome] = []
    for line, result in zip(lines, placed(results, [isinstance(line, Line) for line in lines]), strict=True):
        answer = line if result is None else result
        if isinstance(line, Line) and isinstance(answer, Result):
            ranges = ranges_across(answer, line, asked) if asked.risk else None
            answers.append(replace(sample_outcome(answer, asked.wind_speeds), ranges=ranges))
        elif isinstance(answer, State):
            answers.append(without_answer(answer, len(asked.wind_speeds)))
    return answers


def _line(values: Mapping[str, float], line_of: LineOf) -> Line | State:
    try:
        return line_of(values)
    except InvalidSpec:
        return State.IMPOSSIBLE
    except ArithmeticError:
        return State.UNKNOWN


def analysed(lines: Sequence[Line], asked: Analysis) -> list[Result | State]:
    """Analyse a stack; if it fails, its halves, so that only the sample that fails has no answer."""
    if not lines:
        return []
    try:
        return list(finished(analyse_stack(lines, asked)))
    except (ArithmeticError, ValueError) as error:  # ValueError covers numpy's LinAlgError and InvalidSpec
        if len(lines) == 1:
            return [State.IMPOSSIBLE if isinstance(error, InvalidSpec) else State.UNKNOWN]
    middle = len(lines) // 2
    return [*analysed(lines[:middle], asked), *analysed(lines[middle:], asked)]
