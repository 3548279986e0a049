"""Run many lines under one analysis, in stacks of the engine, with one point for each line."""

from collections.abc import Generator, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from pydantic import ValidationError

from app import schemas
from app.convert import parts
from app.convert.assemble import SoundParts, gather
from app.convert.check import request_faults, with_further_faults
from app.convert.known import known_of_document
from app.convert.run import Advance, PointResult, Stops, failed_point, for_owner, point_results
from app.schemas.faults import BadInput, Fault, faults_of
from engine import spec
from engine.outcome import InvalidSpec
from engine.progress import Progress, finished, translated
from engine.result import Result

STACK = 128  # lines computed together: fewer share too little work, twice as many gain 6 % and take 90 MB more
_LINE, _ANALYSIS = "/line", "/analysis"
_NO_PARTS = SoundParts(None, None, None, None, None, None, None, ())


@dataclass(frozen=True, slots=True)
class NumberedLine:
    """A line document, as `read_line` accepts it, and its number in the batch.

    known: what was said of it in an engineer's form, as `explicit_line` gives it; None for an explicit one.
    """

    number: int
    document: Mapping[str, object]
    known: Mapping[str, Any] | None = None


def read_analysis(document: object) -> schemas.Analysis:
    """Return an analysis that is valid by itself.

    Raises
    ------
    BadInput
        With every fault, with JSON pointers below `/analysis`.
    """
    try:
        analysis = schemas.Analysis.model_validate(document)
    except ValidationError as error:
        raise BadInput(faults_of(error.errors(include_url=False), root=_ANALYSIS)) from error
    _, _, wrong = gather(_NO_PARTS, analysis)
    if wrong:
        raise BadInput([Fault(_ANALYSIS, "inconsistent", str(fault)) for fault in wrong])
    return analysis


def kept_analysis(analysis: schemas.Analysis) -> dict[str, Any]:
    """Return an analysis with all defaults but wind speeds, to which each line of a batch may add its design wind."""
    unnamed = {"wind_speeds"} - analysis.model_fields_set
    return analysis.model_dump(mode="json", by_alias=True, exclude=unnamed)


def read_line(document: object, analysis: schemas.Analysis) -> schemas.Line:
    """Return a line that passes its schema and allows this analysis.

    Raises
    ------
    BadInput
        With every fault, with JSON pointers from the root of the line.
    """
    try:
        line = schemas.Line.model_validate(document)
    except ValidationError as error:
        rooted = faults_of(error.errors(include_url=False), root=_LINE)
        options = analysis.model_dump(mode="json", by_alias=True)
        raise BadInput(_unrooted(with_further_faults({"line": document, "analysis": options}, rooted))) from error
    faults = request_faults(schemas.JobRequest(line=line, analysis=analysis))
    if faults:
        raise BadInput(_unrooted(faults))
    return line


def run_stack(
    analysis: Mapping[str, object], lines: Sequence[NumberedLine], stops: Stops = ()
) -> Iterator[Advance | PointResult]:
    """Run many lines, those with equal numbers of elements and equal physics together.

    Parameters
    ----------
    analysis : mapping
        An analysis document that `read_analysis` accepts.
    lines : sequence of NumberedLine
    stops : tuple of exception types
        As `run` takes them.

    Yields
    ------
    Advance or PointResult
        Progress, and one result for each line, whose point is the line's number; a failed line has its failure,
        whatever it failed of.

    Raises
    ------
    pydantic.ValidationError
        If the analysis does not pass its schema.
    """
    options = schemas.Analysis.model_validate(analysis)
    said = {line.number: line.known for line in lines if line.known is not None}
    done = 0
    made: list[_Made] = []
    for line in lines:
        try:
            made.append((line.number, *_specification(line, options)))
        except (ArithmeticError, ValueError) as error:
            yield failed_point(error, line.number, _axes(line.number))
            done += 1
    for stack in _stacks(made):
        place = f"lines {done + 1} to {done + len(stack)} of {len(lines)}"
        yield Advance(done / len(lines), place)
        told = _told(stack, _solved(stack, stops), _Said(said, options, stops))
        solved = yield from translated(told, partial(_within, place, done / len(lines), len(stack) / len(lines)))
        yield from _as_points(stack, solved, stops)
        done += len(stack)
    yield Advance(1.0, "done")


def _within(place: str, before: float, share: float, step: Progress) -> Advance:
    return Advance(before + share * step.fraction, f"{place}: {step.step}")


_Made = tuple[int, spec.Line, spec.Analysis]


def _stacks(made: Iterable[_Made]) -> Iterator[list[_Made]]:
    """Yield lines with equal numbers of elements and equal physics in stacks of limited size."""
    groups: dict[tuple[int, spec.Analysis], list[_Made]] = {}
    for item in made:
        groups.setdefault((item[1].span.elements, item[2]), []).append(item)
    for equal in groups.values():
        for first in range(0, len(equal), STACK):
            yield equal[first : first + STACK]


def _specification(line: NumberedLine, options: schemas.Analysis) -> tuple[spec.Line, spec.Analysis]:
    document = schemas.Line.model_validate(line.document)
    made, analysis, faults = gather(SoundParts.of(document), options.with_design_wind(document.design_wind))
    if made is None or faults:
        raise InvalidSpec(*faults)
    return made, analysis


def _solved(stack: Sequence[_Made], stops: Stops) -> list[Result | Exception]:
    """Run a stack; if it fails of anything, run its halves, so that only the wrong line fails, by itself."""
    from engine.analysis import analyse_stack  # noqa: PLC0415 - the API and `galloping --help` need no solver

    try:
        return list(finished(analyse_stack([line for _, line, _ in stack], stack[0][2])))
    except stops:
        raise
    except Exception as error:
        if len(stack) == 1:
            return [for_owner(error)]
    middle = len(stack) // 2
    return [*_solved(stack[:middle], stops), *_solved(stack[middle:], stops)]


@dataclass(frozen=True, slots=True)
class _Said:
    """What was said of lines in an engineer's form, by their numbers, the options, and what stops all lines."""

    of_line: Mapping[int, Mapping[str, Any]]
    options: schemas.Analysis
    stops: Stops


def _told(
    stack: Sequence[_Made], solved: Sequence[Result | Exception], said: _Said
) -> Generator[Progress, None, list[Result | Exception]]:
    """Return results with what is assumed of lines in engineers' forms, and with samples of it if these are asked."""
    told = list(solved)
    places = [i for i, (number, _, _) in enumerate(stack) if number in said.of_line and isinstance(solved[i], Result)]
    if not places:
        return told
    # Explicit lines need no estimates.
    from app.convert.known.samples import Analysed, with_what_is_known  # noqa: PLC0415
    from engine.known.resolve import end_stiffnesses  # noqa: PLC0415

    uncertainty = said.options.uncertainty
    asked = None if uncertainty is None else parts.uncertainty(uncertainty)
    ends = end_stiffnesses([stack[i][1] for i in places])
    for i, own_ends in zip(places, ends, strict=True):
        number, line, analysis = stack[i]
        result, known = told[i], known_of_document(said.of_line[number])
        assert isinstance(result, Result), "only lines with a result are told more of"
        steps = with_what_is_known(result, Analysed(line, analysis, own_ends), known, asked)
        into = partial(_share_of_stack, i, len(stack))
        try:
            told[i] = yield from translated(steps, into)
        except said.stops:
            raise
        except Exception as error:
            told[i] = for_owner(error)
    return told


def _share_of_stack(place: int, lines: int, step: Progress) -> Progress:
    return Progress((place + step.fraction) / lines, step.step)


def _as_points(stack: Sequence[_Made], solved: Sequence[Result | Exception], stops: Stops) -> Iterator[PointResult]:
    good: list[tuple[_Made, Result]] = []
    for made, result in zip(stack, solved, strict=True):
        if isinstance(result, Exception):
            yield failed_point(result, made[0], _axes(made[0]))
        else:
            good.append((made, result))
    yield from _packed(good, stops)


def _packed(good: Sequence[tuple[_Made, Result]], stops: Stops) -> list[PointResult]:
    """Return lines with their results as points; if that fails, each line by itself."""
    if not good:
        return []
    points = [(number, _axes(number)) for (number, _, _), _ in good]
    try:
        return list(point_results(points, [line for (_, line, _), _ in good], [result for _, result in good]))
    except stops:
        raise
    except Exception as error:
        if len(good) > 1:
            return [point for single in good for point in _packed([single], stops)]
        return [failed_point(for_owner(error), *points[0])]


def _axes(number: int) -> dict[str, Any]:
    return {"number": number}


def _unrooted(faults: Sequence[Fault]) -> list[Fault]:
    return [Fault(fault.pointer.removeprefix(_LINE), fault.code, fault.detail) for fault in faults]
