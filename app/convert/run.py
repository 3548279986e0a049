"""Run a validated request in the engine and return plain rows, one point of the study after another."""

import json
import logging
import math
from collections.abc import Generator, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from itertools import islice
from typing import Any

from app import schemas
from app.convert import parts, study
from app.convert.assemble import SoundParts, gather
from app.convert.fit import doubts_of
from app.convert.known import known_of
from app.convert.ranking_figures import ranking_figures
from app.convert.remedies import compared
from engine import ENGINE_VERSION, spec
from engine.outcome import InvalidSpec
from engine.progress import Progress, translated
from engine.result import TABLES, AssumptionRow, Result

Stops = tuple[type[Exception], ...]
"""Exceptions that end a whole computation, such as its time limit; any other one fails the point that met it."""
INTERNAL = "the computation stopped on an internal error; the log has the details"

_logger = logging.getLogger(__name__)
_NO_ROWS = json.dumps({name: [] for name in TABLES}, separators=(",", ":")).encode()


@dataclass(frozen=True)
class Advance:
    """The progress of a job: fraction from 0 to 1, and the current step in words."""

    fraction: float
    step: str


@dataclass(frozen=True)
class PointResult:
    """Everything found at one point of a study, as plain values; failure is the sentence why there is nothing.

    input_hash is that of a line by itself or in a batch, and reused tells whether the result was stored before. verdict
    is the row of that table, which stands beside the others so that summaries need not unpack them.
    tables_json is a JSON object that holds the rows of every table, orbits_json a JSON list: the texts are what is
    stored and sent, so that the hundreds of values of a line are turned over once.
    """

    point: int
    axes: dict[str, object]
    static: dict[str, Any]
    den_hartog: dict[str, Any]
    ranking_figures: dict[str, float | None]
    tables_json: bytes
    orbits_json: bytes
    warnings: list[str]
    engine_version: str
    failure: str | None
    input_hash: str | None = None
    reused: bool = False
    verdict: dict[str, Any] | None = None

    @property
    def failed_internally(self) -> bool:
        """Whether a defect of ours is why there is nothing."""
        return self.failure is not None and self.failure.endswith(INTERNAL)

    @cached_property
    def tables(self) -> dict[str, list[dict[str, Any]]]:
        """Rows by the name of their table."""
        found: dict[str, list[dict[str, Any]]] = json.loads(self.tables_json)
        return found

    @cached_property
    def orbits(self) -> list[dict[str, Any]]:
        """Fourier coefficients of the cycles, each with its row number among the limit cycles."""
        found: list[dict[str, Any]] = json.loads(self.orbits_json)
        return found


def run(document: Mapping[str, object], stops: Stops = ()) -> Iterator[Advance | PointResult]:
    """Run a whole job.

    Parameters
    ----------
    document : mapping
        A request as `app.convert.read` takes it.
    stops : tuple of exception types
        What ends a study as a whole; whatever else is raised fails the point of the study that raised it.

    Yields
    ------
    Advance or PointResult
        Progress, and the result of each point as it is done; a point of a study that fails has its failure.

    Raises
    ------
    pydantic.ValidationError
        If the document does not pass its schema.
    ValueError, ArithmeticError
        If the line of a job without a study is not valid (`InvalidSpec`) or its computation fails.
    """
    request = schemas.JobRequest.model_validate(document)
    total = study.count(request.study)
    follows = request.study is not None and request.study.follow
    held: list[_Solved] = []
    for number, values in enumerate(study.points(request.study)):
        prefix = f"point {number + 1} of {total}: " if request.study else ""
        for item in _point(request, number, values, stops):
            if isinstance(item, Advance):
                yield Advance((number + item.fraction) / (total + follows), prefix + item.step)
            elif isinstance(item, PointResult):
                yield item
            elif follows:
                held.append(item)
            else:
                yield item.as_result()
    if follows:
        yield Advance(total / (total + 1), "branches over the field")
        yield from _followed(request, held)
    yield Advance(1.0, "done")


@dataclass(frozen=True)
class _Solved:
    """A point of a study with the engine's result."""

    number: int
    values: dict[str, Any]
    line: spec.Line
    result: Result

    def as_result(self) -> PointResult:
        """Return the point as plain values."""
        (point,) = point_results([(self.number, self.values)], [self.line], [self.result])
        return point


def _followed(request: schemas.JobRequest, held: list[_Solved]) -> Iterator[PointResult]:
    """Follow the cycles of the points over the one field of a study; if that fails, add a warning to the points."""
    # The API and `galloping --help` need no solver.
    from engine.studies.followed import followed  # noqa: PLC0415

    def line_at(value: float) -> spec.Line:
        return specification(request, {parameter: value})[0]

    assert request.study is not None, "only a study has a field to follow"
    parameter = request.study.axes[0].parameter
    rising = sorted(held, key=lambda point: point.values[parameter])
    results = [point.result for point in rising]
    if len(rising) > 1:
        analysis = specification(request, rising[0].values)[1]
        try:
            results = followed(line_at, [point.values[parameter] for point in rising], results, analysis)
        except (ArithmeticError, ValueError) as error:
            warning = f"The cycles were not followed over {parameter}: {error}"
            results = [replace(result, warnings=(*result.warnings, warning)) for result in results]
    for point, result in zip(rising, results, strict=True):
        yield replace(point, result=result).as_result()


def _point(
    request: schemas.JobRequest, number: int, values: dict[str, Any], stops: Stops
) -> Iterator[Advance | _Solved | PointResult]:
    try:
        line, analysis = specification(request, values)
        steps = _steps(request, line, analysis)
        result = yield from translated(steps, lambda step: Advance(step.fraction, step.step))
        result = replace(result, assumptions=_assumptions(request))
        yield _Solved(number, values, line, result)
    except stops:
        raise
    except Exception as error:
        if request.study is None:
            raise
        yield failed_point(for_owner(error), number, values)


def for_owner(error: Exception) -> Exception:
    """Return a numerical error or a refusal unchanged, and hide the details of an internal error, which is logged."""
    if isinstance(error, ArithmeticError | ValueError):  # both also cover numpy's, and what a specification raises
        return error
    _logger.error("a line failed on an internal error", exc_info=error)
    return RuntimeError(INTERNAL)


def _assumptions(request: schemas.JobRequest) -> tuple[AssumptionRow, ...]:
    """Return where the values of the line came from; nothing for a line that was given explicitly."""
    known = known_of(request)
    if known is None:
        return ()
    from app.convert.known.to_document import assumption_rows  # noqa: PLC0415 - explicit lines need no estimates

    return assumption_rows(known)


def _steps(request: schemas.JobRequest, line: spec.Line, analysis: spec.Analysis) -> Generator[Progress, None, Result]:
    """Return the computation of one point, not yet started; samples belong to a line by itself."""
    # The API and `galloping --help` need no solver, and an analysis needs no optimizer.
    if request.remedies is not None:
        return compared(request, line, analysis, known_of(request))
    asked = parts.uncertainty(request.analysis.uncertainty)
    known = None if request.study or request.placement or asked.samples == 0 else known_of(request)
    if known is not None:
        from app.convert.known.samples import analyse_known  # noqa: PLC0415

        return analyse_known(known, line, analysis, asked)
    if request.placement is None:
        from engine.analysis import analyse  # noqa: PLC0415

        return analyse(line, analysis)
    from engine.studies.placement import place  # noqa: PLC0415

    return place(line, analysis, parts.placement(request.placement))


def specification(request: schemas.JobRequest, values: dict[str, Any]) -> tuple[spec.Line, spec.Analysis]:
    """Return the engine's line and analysis at one point of a request.

    Raises
    ------
    pydantic.ValidationError, InvalidSpec
        If the line is not valid at this point.
    """
    line, analysis, faults = gather(
        SoundParts.of(study.varied(request.line, study.settings(request.study, values))), request.analysis
    )
    if line is None or faults:
        raise InvalidSpec(*faults)
    return line, analysis


def specification_of_point(document: Mapping[str, object], point: int) -> tuple[spec.Line, spec.Analysis]:
    """Return the engine's line and analysis at a point of a request document, by its number.

    Raises
    ------
    pydantic.ValidationError, InvalidSpec
        If the line is not valid at this point.
    LookupError
        If there is no such point.
    """
    request = schemas.JobRequest.model_validate(document)
    for values in islice(study.points(request.study), point, None):
        return specification(request, values)
    raise LookupError(point)


def point_results(
    points: Iterable[tuple[int, dict[str, Any]]], lines: Sequence[spec.Line], results: Sequence[Result]
) -> Iterator[PointResult]:
    """Yield the engine's results of points as plain values; a value that is not finite becomes null."""
    figures_of_lines = ranking_figures(lines, results)
    for (number, values), line, result, figures in zip(points, lines, results, figures_of_lines, strict=True):
        yield PointResult(
            point=number,
            axes=values,
            static=_finite(asdict(result.static)),
            den_hartog=_finite(asdict(result.den_hartog)),
            ranking_figures=figures,
            tables_json=_json({name: getattr(result, name) for name in TABLES}),
            orbits_json=_json(result.orbits),
            warnings=[*(f"The line: {doubt}." for doubt in doubts_of(line.ice.aerodynamics)), *result.warnings],
            engine_version=result.engine_version,
            failure=None,
            verdict=next(iter(json.loads(_json(result.verdict))), None),
        )


def failed_point(error: Exception, number: int, values: dict[str, Any]) -> PointResult:
    """Return a point that contains only its failure."""
    return PointResult(
        point=number,
        axes=values,
        static={},
        den_hartog={},
        ranking_figures={},
        tables_json=_NO_ROWS,
        orbits_json=b"[]",
        warnings=[],
        engine_version=ENGINE_VERSION,
        failure=f"{type(error).__name__}: {error}",
    )


def _json(found: object) -> bytes:
    """Return dataclasses, enums and numpy scalars as JSON."""
    import orjson  # noqa: PLC0415 - clients of the service need not have it

    return orjson.dumps(found, option=orjson.OPT_SERIALIZE_NUMPY)


def _finite(values: dict[str, Any]) -> dict[str, Any]:
    return {
        name: None if isinstance(value, float) and not math.isfinite(value) else value for name, value in values.items()
    }
